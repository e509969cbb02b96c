#include "load/result_model.h"

#include <filesystem>
#include <optional>
#include <system_error>

#include <fmt/format.h>

#include "base/error.h"
#include "base/json_text.h"
#include "base/kept_input.h"
#include "load/load.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void no_result(const std::string& folder, const char* missing) {
  throw Error(Error::Category::input, "file-not-found",
              fmt::format("'{}' is a directory without a result: it has no {}", folder, missing), {},
              "give a model file, or a directory that `freeplay run` has written");
}

std::string text(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

std::optional<double> number(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? std::optional(found->get<double>()) : std::nullopt;
}

}  // namespace

ResultWords use_model_of_result(std::string& path, const Json& summary, BuildOptions& build) {
  std::error_code ignored;
  const fs::path folder = path;
  if (!fs::is_directory(folder, ignored)) return {};
  const std::string file = kept_model(path);
  if (!summary.is_object() || !summary.contains("settings")) no_result(path, "summary.json of a run");
  if (!fs::exists(file, ignored)) no_result(path, "model.yaml, model.urdf, model.sdf or model.xml");
  path = file;
  const Json& settings = summary["settings"];
  use_settings(settings, build);
  return {text(summary.value("model", Json::object()), "name"),
          text(settings.value("integrator", Json::object()), "type")};
}

std::unique_ptr<Model> model_beside(const fs::path& folder, const Json& summary, const LoadOptions& options) {
  std::error_code ignored;
  const fs::path file = kept_model(folder.string());
  if (!fs::exists(file, ignored)) return nullptr;
  BuildOptions build;
  if (summary.is_object() && summary.contains("settings")) use_settings(summary["settings"], build);
  LoadOptions quiet = options;
  quiet.strict = false;
  quiet.warn = quiet.note = {};
  try {
    return load_model(file.string(), build, quiet).model;
  } catch (const Error&) {
    return nullptr;
  }
}

void use_settings(const Json& settings, BuildOptions& build) {
  const Json set = settings.value("set", Json::object()), ideal = settings.value("ideal", Json::array());
  std::vector<std::pair<std::string, std::string>> all;
  for (const auto& [name, value] : set.items()) {
    if (value.is_string()) all.emplace_back(name, value.get<std::string>());
  }
  all.insert(all.end(), build.set.begin(), build.set.end());
  build.set = std::move(all);
  for (const Json& name : ideal) {
    if (name.is_string()) build.ideal.push_back(name.get<std::string>());
  }
  const Json step = settings.value("step", Json::object());
  build.end = number(settings, "end");
  build.accuracy = number(step, "accuracy");
  if (!build.accuracy) build.step = number(step, "size");
}

}  // namespace freeplay
