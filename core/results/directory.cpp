#include "results/directory.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <system_error>

#include <fmt/format.h>

#include "base/error.h"
#include "base/json_text.h"
#include "base/sha256.h"
#include "base/whole_file.h"
#include "results/reader.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

constexpr const char* own_files[] = {"results.csv",    "results.h5", "summary.json", "events.csv", "inputs.csv",
                                     "model.yaml",     "model.urdf", "model.sdf",    "model.xml",  "inputs",
                                     "checkpoint.bin", "run.log",    "report.html",  "twin"};

[[noreturn]] void fail(std::string message, std::string hint = {}) {
  throw Error(Error::Category::file, "cannot-write", std::move(message), {}, std::move(hint));
}

void require(const std::error_code& error, const char* what, const fs::path& path) {
  if (error) fail(fmt::format("cannot {} '{}': {}", what, path.string(), error.message()));
}

Json summary_in(const fs::path& path) {
  std::ifstream file(path / "summary.json");
  return file ? Json::parse(file, nullptr, false) : Json();
}

bool holds_result(const fs::path& path) {
  const Json summary = summary_in(path);
  return summary.is_object() && summary.contains("freeplay") && summary["freeplay"].is_object() &&
         summary["freeplay"].contains("schema");
}

/// What a run leaves that was ended before it could write its summary: its log and nothing but files of a result.
bool holds_unfinished_result(const fs::path& path) {
  std::error_code error;
  bool log = false;
  for (const fs::directory_entry& entry : fs::directory_iterator(path, error)) {
    const std::string name = entry.path().filename().string();
    const bool part = name.starts_with('.') && name.ends_with(".part");
    if (!part && std::ranges::find(own_files, name) == std::end(own_files)) return false;
    log = log || name == "run.log";
  }
  return log && !error;
}

bool holds_rows(const fs::path& file) {
  constexpr std::size_t time[] = {0};
  std::error_code error;
  if (!fs::exists(file, error) || fs::file_size(file, error) == 0) return bool(error);
  try {
    return !ResultReader::open(file)->open_rows(time)->next().empty();
  } catch (const Error&) {
    return true;  // for all that is known
  }
}

/// Whether an unfinished result has nothing to lose.
bool holds_no_rows(const fs::path& path) {
  for (const fs::path& folder : {path, path / "twin"}) {
    if (holds_rows(folder / "results.csv") || holds_rows(folder / "results.h5")) return false;
  }
  std::error_code error;
  return !fs::exists(path / "summary.json", error);
}

const fs::path& made(const fs::path& path, bool force) {
  check_result_directory(path, force);
  std::error_code error;
  fs::create_directories(path, error);
  require(error, "make the directory", path);
  return path;
}

}  // namespace

std::string result_name(std::string_view model_name, bool ideal) {
  std::string name;
  bool leading = true;
  for (const char c : model_name) {
    leading = leading && c == '.';
    const bool plain = (static_cast<unsigned char>(c) < 128 && std::isalnum(static_cast<unsigned char>(c)) != 0) ||
                       c == '_' || c == '.' || c == '-';
    // One '_' for each character, not for each byte of it.
    if ((static_cast<unsigned char>(c) & 0xC0U) == 0x80U) continue;
    name += plain && !leading ? c : '_';
  }
  return ideal ? name + "-ideal" : name;
}

std::span<const char* const> result_names() { return own_files; }

std::string model_copy_name(const Model& model) {
  const fs::path suffix = fs::path(model.file).extension();
  return suffix == ".urdf" || suffix == ".sdf" || suffix == ".xml" ? "model" + suffix.string() : "model.yaml";
}

void check_result_directory(const fs::path& path, bool force) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) return;
  require(error, "use", path);
  if (status.type() != fs::file_type::directory) fail(fmt::format("'{}' is not a directory", path.string()));
  const bool empty = fs::is_empty(path, error);
  require(error, "read", path);
  require_no_owner(path);
  if (empty || force || holds_result(path)) return;
  if (holds_unfinished_result(path)) {
    if (holds_no_rows(path)) return;
    fail(fmt::format("'{}' holds the result of a run that did not end: it has no summary.json", path.string()),
         "go on with freeplay run --resume, replace it with --force, or choose another directory with --out");
  }
  fail(fmt::format("'{}' holds other files than a result", path.string()),
       "choose another directory with --out, or write beside them with --force");
}

void require_no_other_model(const fs::path& path, const Model& model) {
  const Json summary = summary_in(path);
  const Json of_model = summary.is_object() ? summary.value("model", Json()) : Json();
  if (!of_model.is_object() || !of_model.value("file", Json()).is_string()) return;
  const fs::path file = of_model["file"].get<std::string>();
  std::error_code error;
  if (!fs::exists(file, error) || fs::equivalent(file, model.file, error) || error) return;
  if (of_model.value("sha256", Json()) == Json(sha256(model.text))) return;
  fail(fmt::format("'{}' holds the result of another model of that name, '{}'", path.string(), file.string()),
       "choose another directory with --out, or replace it with --force");
}

ResultDirectory::ResultDirectory(fs::path path, bool force) : path_(std::move(path)), owner_(made(path_, force)) {
  std::error_code error;
  for (const std::string_view name : own_files) {
    if (name == "run.log") continue;  // others look at its lock
    for (const fs::path& file : {path_ / name, part_of(path_ / name)}) {
      fs::remove_all(file, error);
      require(error, "remove", file);
    }
  }
}

void ResultDirectory::require_there() const {
  if (!there())
    fail(fmt::format("cannot write '{}': it or its run.log was removed or replaced while the run went on",
                     path_.string()));
}

void ResultDirectory::write(std::string_view name, std::string_view text) const {
  require_there();
  write_whole_file(path_ / name, text);
}

void ResultDirectory::remove(std::string_view name) const {
  require_there();
  std::error_code error;
  fs::remove(path_ / name, error);
  require(error, "remove", path_ / name);
}

void ResultDirectory::require_all(std::span<const std::string> names) const {
  for (const std::string& name : names) {
    std::error_code error;
    if (fs::exists(path_ / name, error)) continue;
    fail(fmt::format("cannot write '{}': it was removed while the runs went on", (path_ / name).string()));
  }
}

std::vector<std::string> ResultDirectory::files() const {
  std::vector<std::string> names;
  std::error_code error;  // it may have been removed in the meantime
  for (fs::directory_iterator entry(path_, error), end; !error && entry != end; entry.increment(error)) {
    names.push_back(entry->path().filename().string());
  }
  require(error, "read", path_);
  std::ranges::sort(names);
  return names;
}

}  // namespace freeplay
