// Freeplay's command line: parses, calls the command, and turns whatever is thrown into an exit code.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <malloc.h>
#include <sys/resource.h>

#include "base/caught_error.h"
#include "base/version.h"
#include "cli/commands.h"
#include "cli/completion.h"
#include "cli/failure.h"
#include "cli/interrupt.h"
#include "cli/terminal.h"
#include "cli/unknown_word.h"
#include "freeplay/plugin.h"

namespace freeplay {
namespace {

int print_version(const CommonOptions& common) {
  if (common.json) {
    print_json(Json{{"freeplay", program_version},
                    {"schema", schema_version},
                    {"plugin_abi", abi_version},
                    {"compiler", compiler},
                    {"build", FREEPLAY_BUILD}});
  } else {
    print(fmt::format("freeplay {} (schema {}, plugin ABI {})\n", program_version, schema_version, abi_version));
  }
  return 0;
}

/// For shells, not for people: a word that no help shows.
int print_completions(const CLI::App& program, const std::vector<std::string>& words) {
  for (const std::string& word : completions(program, words)) print(word + "\n");
  return 0;
}

int execute(int argc, char** argv, CommonOptions& common) {
  CLI::App program("Freeplay simulates mechanisms whose joints have clearance.", "freeplay");
  bool version = false;
  program.add_flag("--version", version, "Print the version");
  add_common_options(program, common);
  // Options of one command take a tenth of a millisecond: those of the others are left out where the first word is one.
  const std::string_view first = argc > 1 ? argv[1] : "";
  const bool named = std::ranges::any_of(all_commands(), [&](const auto& word) { return word.name == first; });
  std::vector<Command> commands;
  for (const auto& [name, add] : all_commands()) {
    if (!named || name == first) commands.push_back(add(program, common));
  }
  // Words that the parser does not know are left to unknown_word(), which suggests what was meant.
  if (first == "complete") return print_completions(program, {argv + 2, argv + argc});
  program.require_subcommand(0, 1)->allow_extras();
  for (const Command& command : commands) command.app->allow_extras();
  try {
    program.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    refuse_unknown_words(program);
    print(program.help());
    return 0;
  } catch (const CLI::ParseError& error) {
    throw Error(Error::Category::usage, "bad-usage", error.what());
  }
  refuse_unknown_words(program);
  if (version) return print_version(common);
  for (const Command& command : commands) {
    if (command.app->parsed()) return command.execute();
  }
  if (common.json) throw Error(Error::Category::usage, "missing-argument", "a command is needed");
  print(program.help());
  return 2;
}

/// True if --json stands on the command line, however the rest of it reads.
bool json_wanted(int argc, char** argv) {
  return std::any_of(argv + 1, argv + argc, [](const char* word) { return std::string_view(word) == "--json"; });
}

int execute_and_report(int argc, char** argv) {
  CommonOptions common;
  common.command = "freeplay";
  for (int i = 1; i < argc; ++i) (common.command += ' ') += argv[i];
  try {
    return execute(argc, argv, common);
  } catch (const std::exception& exception) {
    common.json = common.json || json_wanted(argc, argv);
    return report_failure(error_of(exception), common);
  }
}

/// Each thread would take 128 MB of addresses for itself, and a page for every number where it does not get them.
void share_what_a_limit_leaves() {
  rlimit addresses{};
  if (::getrlimit(RLIMIT_AS, &addresses) == 0 && addresses.rlim_cur != RLIM_INFINITY) ::mallopt(M_ARENA_MAX, 1);
}

}  // namespace
}  // namespace freeplay

int main(int argc, char** argv) {
  freeplay::share_what_a_limit_leaves();
  freeplay::open_standard_descriptors();
  freeplay::handle_signals();
  int exit_code = 1;
  try {
    exit_code = freeplay::execute_and_report(std::max(argc, 1), argv);
  } catch (...) {  // even the report failed
  }
  const std::string failure = freeplay::stdout_failure();
  if (failure.empty()) return exit_code;
  std::fputs(("freeplay: error: cannot write to stdout: " + failure + " [cannot-write]\n").c_str(), stderr);
  return exit_code == 0 ? 6 : exit_code;
}
