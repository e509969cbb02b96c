#include "cli/remaking.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "base/error.h"
#include "base/kept_input.h"
#include "base/sha256.h"
#include "base/whole_file.h"
#include "cli/commands.h"
#include "cli/loading.h"
#include "cli/scratch_folder.h"
#include "cli/terminal.h"
#include "component/library.h"
#include "load/plugins.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

constexpr std::array makers{"run", "export", "analyze", "plot", "report", "show"};
/// What a record may not ask for, wherever it is from: to write elsewhere, to run code, to leave out questions.
constexpr std::array forbidden{"--out",    "--svg",           "--force", "--yes",   "--resume",
                               "--plugin", "--allow-plugins", "--json",  "--quiet", "--checkpoint"};

[[noreturn]] void refuse_record(const MadeFile& made, const std::string& why) {
  throw Error(Error::Category::file, "no-provenance",
              fmt::format("'{}' has a record that cannot be followed: {}", made.path.string(), why));
}

/// Words of a command line, --plugin and its value left out: whoever makes it again says which are to be trusted.
std::vector<std::string> words_of(const MadeFile& made, const Json& list) {
  std::vector<std::string> words;
  if (!list.is_array()) refuse_record(made, "it has no arguments");
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (!list[i].is_string()) refuse_record(made, "an argument is no text");
    const std::string word = list[i].get<std::string>();
    const std::string option = word.substr(0, word.find('='));
    if (word == "--plugin") {
      ++i;
      continue;
    }
    if (std::ranges::find(forbidden, option) != forbidden.end())
      refuse_record(made, fmt::format("it asks for {}", word));
    words.push_back(word);
  }
  return words;
}

/// Those of that name in the folders for plugins.
std::vector<fs::path> installed_plugins(const fs::path& name) {
  std::vector<fs::path> files;
  for (const fs::path& folder : plugin_folders()) {
    std::error_code ignored;
    if (fs::is_regular_file(folder / name, ignored)) files.push_back(folder / name);
  }
  return files;
}

const char* ending_of(MadeKind kind) {
  switch (kind) {
    case MadeKind::hdf5:
      return ".h5";
    case MadeKind::mat:
      return ".mat";
    case MadeKind::picture:
      return ".svg";
    case MadeKind::page:
      return ".html";
    case MadeKind::json:
      return ".json";
    case MadeKind::csv:
    case MadeKind::result:
      break;
  }
  return ".csv";
}

}  // namespace

Remaking::Remaking(const MadeFile& made, const CommonOptions& common, const fs::path& out, bool yes)
    : made_(made), common_(common), yes_(yes) {
  const Json maker = made.record.value("made", Json());
  if (!maker.is_string()) refuse_record(made, "it does not say by which command");
  command_ = maker.get<std::string>();
  const auto known = [&](const CommandEntry& entry) { return entry.name == command_; };
  if (std::ranges::find(makers, command_) == makers.end() || std::ranges::none_of(all_commands(), known)) {
    refuse_record(made, fmt::format("this program makes nothing by '{}'", command_));
  }
  std::error_code error;
  if (!out.empty() && fs::exists(out, error) && !fs::is_empty(out, error)) {
    throw Error(Error::Category::file, "cannot-write",
                fmt::format("'{}' is there already, and not empty", out.string()), {},
                "choose another directory with --out");
  }
  scratch_ = new_scratch_folder();
  out_ = out.empty() ? scratch_ / "again" : out;
}

Remaking::~Remaking() {
  std::error_code ignored;
  fs::remove_all(scratch_, ignored);
}

/// The model and its inputs as in a result that says nothing but the model's name.
fs::path Remaking::stage(const Json& run, std::size_t number) const {
  const fs::path folder = scratch_ / fmt::format("model-{}", number);
  const Json& model = run["model"];
  const std::string text = model["text"].get<std::string>();
  const std::size_t first = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  const bool robot = first != std::string::npos && text[first] == '<';
  const fs::path file = folder / (!robot                                      ? "model.yaml"
                                  : text.find("<mujoco") != std::string::npos ? "model.xml"
                                  : text.find("<sdf") != std::string::npos    ? "model.sdf"
                                                                              : "model.urdf");
  write_whole_file(file, text);
  write_whole_file(folder / "summary.json", json_text({{"provenance", {{"model", {{"name", model["name"]}}}}}}));
  write_whole_file(folder / only_copies, "");
  for (const Json& input : run.value("inputs", Json::array())) {
    const fs::path name = fs::path(input.value("name", "")).filename();
    if (!name.empty()) write_whole_file(folder / "inputs" / name, input.value("text", ""));
  }
  return file;
}

/// A library with the bytes of one that the run used gets the name by which the model knows it.
std::string Remaking::known_name(const std::string& library, const Json& run) const {
  std::error_code ignored;
  if (!fs::is_regular_file(library, ignored)) return library;
  const Json digits = sha256_of_file(library);
  for (const Json& plugin : run.value("plugins", Json::array())) {
    const fs::path name = fs::path(plugin.value("file", "")).filename();
    if (plugin.value("sha256", Json()) != digits || name.empty() || name == fs::path(library).filename()) continue;
    const fs::path link = scratch_ / "plugins" / name;
    fs::create_directories(link.parent_path(), ignored);
    fs::create_symlink(fs::absolute(library), link, ignored);
    return link.string();
  }
  return library;
}

std::vector<std::string> Remaking::plugin_words(const Json& run) const {
  std::vector<std::string> words;
  for (const std::string& plugin : common_.plugins) words.insert(words.end(), {"--plugin", known_name(plugin, run)});
  if (common_.allow_plugins) words.emplace_back("--allow-plugins");
  const LoadOptions options = loading(common_);
  for (const Json& plugin : run.value("plugins", Json::array())) {
    const fs::path file = plugin.value("file", "");
    const Json digits = plugin.value("sha256", Json());
    const auto is_recorded = [&](const fs::path& other) { return Json(sha256_of_file(other.string())) == digits; };
    const auto stands_for_it = [&](const fs::path& other) {
      return other.filename() == file.filename() || is_recorded(other);
    };
    if (std::ranges::any_of(common_.plugins, stands_for_it)) continue;
    // That of the same bytes goes before one of the same name, and one in a folder for plugins before another.
    std::vector<fs::path> found = installed_plugins(file.filename());
    std::error_code ignored;
    if (fs::is_regular_file(file, ignored)) found.push_back(file);
    if (found.empty()) {
      throw Error(
          Error::Category::plugin, "plugin-not-found",
          fmt::format("'{}' was made with the plugin '{}', which is not there", made_.path.string(), file.string()), {},
          "say where it is with --plugin LIB");
    }
    const auto same = std::ranges::find_if(found, is_recorded);
    const fs::path& chosen = same != found.end() ? *same : found.front();
    require_plugin_allowed(chosen, options);
    words.insert(words.end(), {"--plugin", chosen.string()});
  }
  return words;
}

bool Remaking::execute(std::vector<std::string> words, const Json& run) {
  const std::vector<std::string> plugins = plugin_words(run);
  words.insert(words.end(), plugins.begin(), plugins.end());
  const bool shows = stderr_is_terminal() && !common_.quiet;
  if (words.front() != "plot") words.emplace_back("--json");  // the numbers of a picture, which not every view has
  if (!shows) words.emplace_back("--quiet");
  if (common_.no_color) words.emplace_back("--no-color");
  end_ = run_own_program(words, shows);
  if (common_.verbose) print_messages(end_.messages, common_.no_color);
  return end_.exit_code == 0;
}

bool Remaking::run_model(const Json& run, std::size_t number, const fs::path& out) {
  std::vector<std::string> words{"run", stage(run, number).string(), "--out", out.string()};
  const std::vector<std::string> more = words_of(made_, run.value("arguments", Json()));
  words.insert(words.end(), more.begin(), more.end());
  if (yes_) words.emplace_back("--yes");
  execute(std::move(words), run);
  // A run that fails leaves a result, too, unless it was refused before.
  std::error_code ignored;
  return end_.exit_code != 130 && end_.exit_code != 6 && fs::exists(out / "summary.json", ignored);
}

bool Remaking::analyze(const Json& run) {
  std::vector<std::string> words = words_of(made_, run.value("arguments", Json()));
  if (words.empty()) refuse_record(made_, "it does not say which analysis");
  words.insert(words.begin(), "analyze");
  words.insert(words.begin() + 2, stage(run, 0).string());
  const bool printed = made_.kind == MadeKind::json;
  if (!printed) words.insert(words.end(), {made_.kind == MadeKind::picture ? "--svg" : "--out", again_.string()});
  if (!execute(std::move(words), run)) return false;
  if (printed) write_whole_file(again_, end_.printed);
  return true;
}

bool Remaking::draw(const Json& run) {
  std::vector<std::string> words{"show", stage(run, 0).string(), "--out", again_.string()};
  const std::vector<std::string> more = words_of(made_, run.value("arguments", Json()));
  words.insert(words.end(), more.begin(), more.end());
  return execute(std::move(words), run);
}

/// From results, which are made first.
bool Remaking::derive() {
  for (const Json& run : runs_of(made_)) {
    const std::size_t number = results_.size();
    results_.push_back((out_ / fmt::format("run-{}", number)).string());
    if (!run_model(run, number, results_.back())) return false;
  }
  std::vector<std::vector<std::string>> steps;
  for (const Json& before : made_.record.value("before", Json::array())) steps.push_back(words_of(made_, before));
  for (std::size_t i = 0; i < steps.size(); ++i) {
    std::vector<std::string> words{"export", results_[0]};
    words.insert(words.end(), steps[i].begin(), steps[i].end());
    const std::string table = (scratch_ / fmt::format("table-{}.h5", i)).string();
    words.insert(words.end(), {"--out", table});
    if (!execute(std::move(words), Json::object())) return false;
    results_ = {table};
  }
  std::vector<std::string> words{command_};
  for (std::size_t i = 0; i < results_.size(); ++i) {
    if (i > 0 && command_ == "plot") words.emplace_back("--against");
    words.push_back(results_[i]);
  }
  const std::vector<std::string> more = words_of(made_, made_.record.value("arguments", Json()));
  words.insert(words.end(), more.begin(), more.end());
  words.insert(words.end(), {"--out", again_.string()});
  return execute(std::move(words), Json::object());
}

bool Remaking::make() {
  if (command_ == "run") {
    again_ = out_;
    return run_model(made_.record, 0, out_);
  }
  again_ = out_ / (made_.path.stem().string() + ending_of(made_.kind));
  if (command_ == "analyze") return analyze(made_.record);
  return command_ == "show" && !made_.record.contains("run") ? draw(made_.record) : derive();
}

}  // namespace freeplay
