#include "base/kept_input.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "base/json_text.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

/// Of a run that has ended, or was killed.
bool is_result(const fs::path& folder) {
  std::error_code ignored;
  return fs::exists(folder / "summary.json", ignored) || fs::exists(folder / "checkpoint.bin", ignored);
}

/// The record of provenance beside the model; null without.
Json record_beside_model(const std::string& model_file) {
  std::ifstream file(fs::path(model_file).parent_path() / "summary.json");
  if (!file) return nullptr;
  const Json summary = Json::parse(file, nullptr, false);
  if (!summary.is_object()) return nullptr;
  const auto record = summary.find("provenance");
  return record != summary.end() && record->is_object() ? *record : Json(nullptr);
}

std::string text_in(const Json& object, const char* key) {
  if (!object.is_object()) return {};
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

}  // namespace

std::string kept_input(const std::string& model_file, const std::string& path, const std::string& kept_name) {
  std::error_code ignored;
  const fs::path folder = fs::path(model_file).parent_path(), copy = folder / "inputs" / kept_name;
  if (!fs::exists(copy, ignored)) return path;
  if (fs::exists(folder / only_copies, ignored)) return copy.string();
  return !fs::exists(path, ignored) && is_result(folder) ? copy.string() : path;
}

bool is_kept_copy(const std::string& model_file) {
  std::error_code ignored;
  return fs::exists(fs::path(model_file).parent_path() / only_copies, ignored);
}

std::vector<std::string> kept_libraries(const std::string& model_file) {
  std::vector<std::string> files;
  if (!is_kept_copy(model_file)) return files;
  std::error_code none;
  const fs::path folder = fs::path(model_file).parent_path() / libraries_folder;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none)) {
    if (entry.path().extension() == ".so") files.push_back(entry.path().string());
  }
  std::ranges::sort(files);
  return files;
}

std::string kept_model(const std::string& folder) {
  std::error_code ignored;
  for (const char* name : {"model.urdf", "model.sdf", "model.xml"}) {
    if (fs::exists(fs::path(folder) / name, ignored)) return (fs::path(folder) / name).string();
  }
  return (fs::path(folder) / "model.yaml").string();
}

std::string kept_model_name(const std::string& model_file) {
  if (fs::path(model_file).stem() != "model") return {};
  const Json record = record_beside_model(model_file);
  return record.is_object() && record.contains("model") ? text_in(record["model"], "name") : std::string();
}

std::vector<std::string> kept_plugins(const std::string& model_file) {
  std::vector<std::string> files;
  const Json record = record_beside_model(model_file);
  if (!record.is_object() || !record.contains("plugins")) return files;
  for (const Json& plugin : record["plugins"]) {
    if (std::string file = text_in(plugin, "file"); !file.empty()) files.push_back(std::move(file));
  }
  return files;
}

}  // namespace freeplay
