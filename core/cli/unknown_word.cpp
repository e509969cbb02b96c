#include "cli/unknown_word.h"

#include <algorithm>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/error.h"
#include "base/suggestion.h"
#include "cli/options.h"

namespace freeplay {
namespace {

[[noreturn]] void refuse(const std::string& id, const std::string& message, const std::string& word,
                         const std::vector<std::string>& known, const std::string& prefix = "") {
  const auto nearest = suggestion(word, known);
  throw Error(Error::Category::usage, id, message, {},
              nearest ? fmt::format("did you mean '{}{}'?", prefix, *nearest) : "");
}

std::vector<std::string> command_names(const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands(nullptr)) names.push_back(command->get_name());
  return names;
}

/// Long names without their dashes, so that these do not count as letters in common.
std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;  // hidden: of a later release
    for (const std::string& name : option->get_lnames()) names.push_back(name);
  }
  return names;
}

void refuse_word(const CLI::App& app, bool has_commands, const std::string& word) {
  if (word.starts_with('-') && word.size() > 1) {
    const std::string option = word.substr(0, word.find('='));
    const std::string letters = option.substr(std::min(option.find_first_not_of('-'), option.size()));
    refuse("unknown-option", fmt::format("unknown option '{}'", option), letters, option_names(app), "--");
  }
  if (!has_commands) {
    throw Error(Error::Category::usage, "unexpected-argument", fmt::format("unexpected argument '{}'", word));
  }
  if (word == "sweep") {
    throw Error(Error::Category::usage, "unknown-command", "unknown command 'sweep'", {}, "it is called study");
  }
  refuse("unknown-command", fmt::format("unknown command '{}'", word), word, command_names(app));
}

/// An unknown option explains the stray words after it better than the other way round.
std::string telling(const std::vector<std::string>& words) {
  const auto option = std::ranges::find_if(words, [](const std::string& word) { return word.starts_with('-'); });
  return option == words.end() ? words.front() : *option;
}

}  // namespace

void refuse_unknown_words(const CLI::App& program) {
  const std::vector<std::string> words = program.remaining();
  const bool has_commands = !program.get_subcommands(nullptr).empty(), chosen = !program.get_subcommands().empty();
  if (!words.empty()) refuse_word(program, has_commands, has_commands && !chosen ? words.front() : telling(words));
  for (const CLI::App* command : program.get_subcommands()) refuse_unknown_words(*command);
}

}  // namespace freeplay
