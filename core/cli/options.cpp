#include "cli/options.h"

#include <algorithm>
#include <cmath>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/error.h"
#include "base/expression.h"
#include "base/suggestion.h"

namespace freeplay {
namespace {

constexpr const char* common_group = "Options of every command";
constexpr const char* hidden_group = "";
constexpr const char* model_group = "Options of every command that reads a model";

// One value for each mention; by default the parser would also take the words that follow.
CLI::Option* repeatable(CLI::App& app, const std::string& name, std::vector<std::string>& values,
                        const std::string& help) {
  return app.add_option(name, values, help)->allow_extra_args(false);
}

}  // namespace

CLI::App* add_command(CLI::App& program, const std::string& name, const std::string& help) {
  return program.add_subcommand(name, help);
}

CLI::App* add_nested_command(CLI::App& command, const std::string& name, const std::string& help) {
  return command.add_subcommand(name, help)->allow_extras();
}

bool is_chosen(const CLI::App& command) { return command.parsed(); }

void add_option(CLI::App& app, const std::string& name, std::string& value, const std::string& help,
                const std::string& value_name) {
  app.add_option(name, value, help)->type_name(value_name);
}

void add_option(CLI::App& app, const std::string& name, std::optional<std::string>& value, const std::string& help,
                const std::string& value_name) {
  app.add_option_function<std::string>(
         name, [&value](const std::string& text) { value = text; }, help)
      ->type_name(value_name);
}

void add_option(CLI::App& app, const std::string& name, std::uint64_t& value, const std::string& help,
                const std::string& value_name) {
  app.add_option(name, value, help)->type_name(value_name);
}

void add_file_option(CLI::App& app, const std::string& name, std::string& value, const std::string& help,
                     const std::string& value_name) {
  app.add_option(name, value, help)->type_name(value_name)->check([](const std::string& text) {
    return text.empty() ? std::string("it must not be empty") : std::string();
  });
}

void add_repeatable(CLI::App& app, const std::string& name, std::vector<std::string>& values, const std::string& help,
                    const std::string& value_name) {
  repeatable(app, name, values, help)->type_name(value_name);
}

void add_arguments(CLI::App& app, const std::string& name, std::vector<std::string>& values, const std::string& help) {
  app.add_option(name, values, help)->type_name("");
}

void add_flag(CLI::App& app, const std::string& name, bool& value, const std::string& help) {
  app.add_flag(name, value, help);
}

void add_later_flag(CLI::App& app, const std::string& name, bool& value) {
  app.add_flag(name, value)->group(hidden_group);
}

void add_common_options(CLI::App& app, CommonOptions& options) {
  app.add_flag("-q,--quiet", options.quiet, "No progress, no text but the data asked for")->group(common_group);
  app.add_flag("-v,--verbose", options.verbose, "More on stderr")->group(common_group);
  app.add_flag("--json", options.json, "Machine-readable stdout: one JSON document")->group(common_group);
  app.add_flag("--no-color", options.no_color, "No colour")->group(common_group);
  app.add_option("--max-errors", options.max_errors, "Messages of one file to print (20); 0 is no limit")
      ->type_name("N")
      ->check([](const std::string& text) {
        return text.find_first_not_of("0123456789") == std::string::npos ? "" : "it must be a whole number from 0 on";
      })
      ->group(common_group);
  app.add_flag("--strict", options.strict, "Warnings in input files are errors")->group(common_group);
  repeatable(app, "--plugin", options.plugins, "Load one more plugin, a path or a name; repeatable")
      ->type_name("LIB")
      ->group(common_group);
  app.add_flag("--allow-plugins", options.allow_plugins,
               "Run the code of plugins that a model names, wherever they lie")
      ->group(common_group);
}

void add_model_options(CLI::App& app, ModelOptions& options) {
  repeatable(app, "--set", options.set,
             "Replace a parameter or any value by its path: c=\"50 um\", joints.tip.clearance.radial_clearance=0.1mm; "
             "repeatable")
      ->type_name("NAME=VALUE")
      ->group(model_group);
  repeatable(app, "--ideal", options.ideal, "Close the clearance of a joint: name, pattern with * or all; repeatable")
      ->type_name("JOINT")
      ->group(model_group);
}

void add_model_options_without_ideal(CLI::App& app, ModelOptions& options) {
  add_model_options(app, options);
  app.get_option("--ideal")->group(hidden_group);
}

void not_in_this_release(const std::string& what) {
  throw Error(Error::Category::usage, "not-in-this-release", fmt::format("{}: not in this release", what));
}

}  // namespace freeplay
