#include "cli/completion.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <optional>
#include <string_view>
#include <system_error>

#include <CLI/CLI.hpp>

#include "contract/type_list.h"
#include "load/load.h"
#include "load/plugins.h"
#include "model/channel.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;
using WordList = std::vector<std::string>;

const WordList any_file, model_endings{".yaml", ".yml", ".urdf", ".sdf", ".xml"};

/// The command that is being typed, as far as it is there.
struct Line {
  const CLI::App* command;
  const CLI::Option* open = nullptr;  ///< waits for its value
  WordList arguments{};               ///< words that belong to no option
};

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

const CLI::Option* option_of(const CLI::App& command, const std::string& name) {
  const CLI::Option* option = command.get_option_no_throw(name);
  return option != nullptr && option->nonpositional() ? option : nullptr;
}

Line line_of(const CLI::App& program, const WordList& words) {
  Line line{&program};
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    const std::string& word = words[i];
    if (line.open != nullptr) {
      line.open = nullptr;
    } else if (word.starts_with('-')) {
      const CLI::Option* option = option_of(*line.command, word);
      if (option != nullptr && takes_value(*option)) line.open = option;
    } else {
      const auto commands = line.command->get_subcommands(nullptr);
      const auto found = std::ranges::find(commands, word, [](const CLI::App* app) { return app->get_name(); });
      found != commands.end() ? void(line.command = *found) : line.arguments.push_back(word);
    }
  }
  return line;
}

/// The argument that the next word is.
const CLI::Option* next_argument(const Line& line) {
  const CLI::Option* found = nullptr;
  std::size_t before = line.arguments.size();
  for (const CLI::Option* option : line.command->get_options()) {
    if (!option->get_positional()) continue;
    found = option;
    if (before == 0) return found;
    --before;
  }
  return found != nullptr && found->get_items_expected_max() > 1 ? found : nullptr;  // the last may take all words
}

/// The words of a help such as "Of the results: csv, hdf5, both (both)" or "model (the default) or plugin".
WordList named_values(std::string_view help) {
  if (const auto colon = help.rfind(": "); colon != help.npos) help.remove_prefix(colon + 2);
  help = help.substr(0, help.find(';'));
  std::string list(help);
  for (const std::string_view divider : {", ", " or "}) {
    for (auto at = list.find(divider); at != list.npos; at = list.find(divider)) list.replace(at, divider.size(), "\n");
  }
  WordList values;
  for (std::size_t from = 0; from <= list.size();) {
    const std::size_t end = std::min(list.find('\n', from), list.size());
    std::string word = list.substr(from, end - from);
    word = word.substr(0, std::min(word.find(" ("), word.find('[')));
    if (word.empty() || word.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") != word.npos) return {};
    values.push_back(std::move(word));
    from = end + 1;
  }
  return values.size() > 1 ? values : WordList();
}

/// Files with one of the endings, and folders, that begin with `begun`, as it is typed.
WordList files(const std::string& begun, const WordList& endings) {
  const std::size_t slash = begun.rfind('/');
  const std::string folder = slash == begun.npos ? "" : begun.substr(0, slash + 1), name = begun.substr(folder.size());
  const char* home = std::getenv("HOME");
  const fs::path there = folder.empty()                                ? fs::path(".")
                         : folder.starts_with("~/") && home != nullptr ? fs::path(home) / folder.substr(2)
                                                                       : fs::path(folder);
  WordList found;
  std::error_code error, ignored;
  for (fs::directory_iterator it(there, error), end; !error && it != end; it.increment(error)) {
    const std::string file = it->path().filename().string();
    if (!file.starts_with(name) || (file.starts_with('.') && !name.starts_with('.'))) continue;
    if (it->is_directory(ignored)) {
      found.push_back(folder + file + "/");
    } else if (endings.empty() || std::ranges::find(endings, it->path().extension().string()) != endings.end()) {
      found.push_back(folder + file);
    }
  }
  return found;
}

WordList types(const std::string& kind) {
  WordList names;
  for (const Json& entry : type_entries(load_registry({}, nullptr), kind)) {
    if (kind == "plugins" || entry.value("kind", "") != "plugin") names.push_back(entry.value("name", ""));
  }
  return names;
}

/// The model on the line: a file, or the copy in a result.
std::optional<LoadedModel> model_of(const Line& line) {
  for (const std::string& word : line.arguments) {
    std::error_code ignored;
    const fs::path file = fs::is_directory(word, ignored) ? fs::path(word) / "model.yaml" : fs::path(word);
    const bool is_model = std::ranges::find(model_endings, file.extension().string()) != model_endings.end();
    if (!is_model || !fs::is_regular_file(file, ignored)) continue;
    LoadedModel loaded = load_model(file.string(), {}, {});
    if (loaded.model) return loaded;
  }
  return std::nullopt;
}

WordList names_of_model(const Line& line, const std::string& kind) {
  const std::optional<LoadedModel> loaded = model_of(line);
  WordList names;
  if (kind == "JOINT") {
    if (loaded) {
      for (const JointElement& joint : loaded->model->joints) {
        if (joint.has_play) names.push_back(joint.name);
      }
    }
    names.emplace_back("all");
  } else if (loaded && kind == "NAME=VALUE") {
    for (const auto& [name, value] : loaded->model->parameters) names.push_back(name + "=");
  } else if (loaded) {
    const Channels channels(*loaded->model);
    for (const ChannelInfo& channel : channels.all()) names.push_back(channel.name);
  }
  return names;
}

/// Values of an option or argument, by what stands for it in the help.
WordList values_of(const Line& line, const CLI::Option& option, const std::string& begun) {
  if (WordList named = named_values(option.get_description()); !named.empty()) return named;
  const std::string kind = option.nonpositional() ? option.get_type_name() : option.get_name();
  if (option.get_name() == "--integrator") return types("integrators");
  if (kind == "NAME" && !option.nonpositional() && line.command->get_name() == "describe") return types("");
  if (kind == "JOINT" || kind == "NAME=VALUE" || kind == "PATTERN" || kind == "CHANNEL" || kind == "CHANNELS") {
    return names_of_model(line, kind);
  }
  if (kind == "MODEL" || kind == "IN" || kind == "FILE|DIR") return files(begun, model_endings);
  if (kind == "LIB") {
    WordList found = files(begun, {".so"});
    std::ranges::move(types("plugins"), std::back_inserter(found));
    return found;
  }
  const bool is_file =
      kind == "FILE" || kind == "DIR" || kind == "RESULT" || kind == "OUT" || kind == "A" || kind == "B";
  return is_file ? files(begun, any_file) : WordList();
}

WordList options_of(const CLI::App& command) {
  WordList names;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group().empty()) continue;  // hidden
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

WordList candidates(const Line& line, const std::string& begun) {
  if (line.open != nullptr) return values_of(line, *line.open, begun);
  const std::size_t equals = begun.find('=');
  if (begun.starts_with("--") && equals != begun.npos) {
    const CLI::Option* option = option_of(*line.command, begun.substr(0, equals));
    WordList values = option == nullptr ? WordList() : values_of(line, *option, begun.substr(equals + 1));
    for (std::string& value : values) value.insert(0, begun.substr(0, equals + 1));
    return values;
  }
  if (begun.starts_with('-')) return options_of(*line.command);
  WordList words;
  if (line.arguments.empty()) {
    for (const CLI::App* command : line.command->get_subcommands(nullptr)) words.push_back(command->get_name());
  }
  if (const CLI::Option* argument = next_argument(line)) {
    std::ranges::move(values_of(line, *argument, begun), std::back_inserter(words));
  }
  return words;
}

}  // namespace

std::vector<std::string> completions(const CLI::App& program, const std::vector<std::string>& words) {
  const std::string begun = words.empty() ? std::string() : words.back();
  WordList found;
  try {
    found = candidates(line_of(program, words), begun);
  } catch (const std::exception&) {
    return {};  // a wrong line is reported when it is entered
  }
  std::erase_if(found, [&](const std::string& word) { return !word.starts_with(begun); });
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace freeplay
