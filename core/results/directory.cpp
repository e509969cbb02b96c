#include "results/directory.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <system_error>

#include <fmt/format.h>

#include "base/error.h"
#include "base/json_text.h"
#include "base/whole_file.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

constexpr const char* own_files[] = {"results.csv", "results.h5",  "summary.json", "events.csv",
                                     "model.yaml",  "model.urdf",  "inputs",       "checkpoint.bin",
                                     "run.log",     "report.html", "twin"};

[[noreturn]] void fail(std::string message, std::string hint = {}) {
  throw Error(Error::Category::file, "cannot-write", std::move(message), {}, std::move(hint));
}

void require(const std::error_code& error, const char* what, const fs::path& path) {
  if (error) fail(fmt::format("cannot {} '{}': {}", what, path.string(), error.message()));
}

bool holds_result(const fs::path& path) {
  std::ifstream file(path / "summary.json");
  if (!file) return false;
  const Json summary = Json::parse(file, nullptr, false);
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

std::string model_copy_name(const Model& model) {
  return fs::path(model.file).extension() == ".urdf" ? "model.urdf" : "model.yaml";
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
    fail(fmt::format("'{}' holds the result of a run that did not end: it has no summary.json", path.string()),
         "go on with freeplay run --resume, replace it with --force, or choose another directory with --out");
  }
  fail(fmt::format("'{}' holds other files than a result", path.string()),
       "choose another directory with --out, or write beside them with --force");
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

void ResultDirectory::write(std::string_view name, std::string_view text) const {
  write_whole_file(path_ / name, text);
}

void ResultDirectory::remove(std::string_view name) const {
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
