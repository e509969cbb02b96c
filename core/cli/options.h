// Options: what commands share on the command line.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/option_value.h"
#include "base/unit.h"
#include "load/options.h"
#include "load/run_words.h"

// The library's header is of options.cpp and of those who parse: it takes longer to compile than a command.
namespace CLI {
class App;
}  // namespace CLI

namespace freeplay {

/// Options of every command.
struct CommonOptions : LoadWords {
  bool quiet = false, verbose = false, json = false, no_color = false;
  int max_errors = 20;  ///< 0: no limit
  std::string command;  ///< the command line as typed
};

/// A command that was added to the program, and what to do when it was chosen. Returns the exit code.
struct Command {
  CLI::App* app;
  std::function<int()> execute;
};

CLI::App* add_command(CLI::App& program, const std::string& name, const std::string& help);
/// A command of a command, whose unknown words are left as well.
CLI::App* add_nested_command(CLI::App& command, const std::string& name, const std::string& help);
/// Whether it stands on the command line.
bool is_chosen(const CLI::App& command);
void add_common_options(CLI::App& app, CommonOptions& options);
void add_model_options(CLI::App& app, ModelOptions& options);
/// The same for a command that refuses --ideal.
void add_model_options_without_ideal(CLI::App& app, ModelOptions& options);

/// An option ("--end") or an argument ("MODEL"); `value_name` stands for its value in the help.
void add_option(CLI::App& app, const std::string& name, std::string& value, const std::string& help,
                const std::string& value_name = "");
/// Where an empty text is not the same as none.
void add_option(CLI::App& app, const std::string& name, std::optional<std::string>& value, const std::string& help,
                const std::string& value_name);
void add_option(CLI::App& app, const std::string& name, std::uint64_t& value, const std::string& help,
                const std::string& value_name);
/// A file or directory to write, which has a name.
void add_file_option(CLI::App& app, const std::string& name, std::string& value, const std::string& help,
                     const std::string& value_name);
/// An option that may be given several times, one value each.
void add_repeatable(CLI::App& app, const std::string& name, std::vector<std::string>& values, const std::string& help,
                    const std::string& value_name);
/// An argument that takes all words.
void add_arguments(CLI::App& app, const std::string& name, std::vector<std::string>& values, const std::string& help);
/// A flag of a later release, which is refused and which the help does not show.
void add_later_flag(CLI::App& app, const std::string& name, bool& value);
void add_flag(CLI::App& app, const std::string& name, bool& value, const std::string& help);

[[noreturn]] void not_in_this_release(const std::string& what);

}  // namespace freeplay
