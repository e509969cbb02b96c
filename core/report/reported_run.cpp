#include "report/reported_run.h"

#include <algorithm>
#include <system_error>

#include <fmt/format.h>

#include "base/error.h"
#include "base/input_text.h"
#include "base/kept_input.h"
#include "base/sha256.h"
#include "base/shell_word.h"
#include "load/result_model.h"
#include "results/directory.h"
#include "results/result_record.h"
#include "results/whole_result.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

std::string attribute(const ResultReader& reader, std::string_view name) {
  for (const auto& [key, text] : reader.layout().attributes) {
    if (key == name) return text;
  }
  return {};
}

std::string text_of(const fs::path& file) {
  std::string text;
  return read_input(file.string(), text).empty() ? text : std::string();
}

Json list_in(const std::string& text) {
  Json json = Json::parse(text, nullptr, false);
  return json.is_array() ? json : Json::array();
}

Json field(const Json& json, const char* name) {
  const auto found = json.is_object() ? json.find(name) : json.end();
  return json.is_object() && found != json.end() && found->is_object() ? *found : Json::object();
}

std::string text_in(const Json& json, const char* name) {
  const auto found = json.find(name);
  return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
}

void take_summary(ReportedRun& run, const fs::path& folder) {
  if (const Json summary = read_summary(folder); summary.is_object()) run.summary = summary;
  run.summary.erase("performance");
  if (!run.summary.empty()) return;
  std::error_code ignored;
  run.note = fs::exists(folder / "summary.json", ignored)
                 ? "summary.json is damaged: what it said is not here"
                 : "no summary.json: the run goes on or was killed, or its files are not all here";
  run.summary = summary_of_unfinished(folder, *run.reader);
}

/// What the model itself says, where the summary says nothing of it: the run goes on, or was killed.
void know_model(ReportedRun& run) {
  if (!run.model || field(run.summary, "model").contains("bodies")) return;
  const Model& model = *run.model;
  Json known = {{"name", model.name},
                {"space", model.space == Space::planar ? "planar" : "spatial"},
                {"bodies", model.bodies.size()},
                {"joints", model.joints.size()},
                {"clearance_joints", std::ranges::count_if(model.joints, &JointElement::has_play)},
                {"drivers", model.drivers.size()}};
  known.update(field(run.summary, "model"));
  run.summary["model"] = std::move(known);
}

void read_inputs(ReportedRun& run, const fs::path& folder) {
  for (const Json& input : field(run.summary, "provenance").value("inputs", Json::array())) {
    const std::string name = input.is_object() ? text_in(input, "name") : std::string();
    std::string text = name.empty() ? name : text_of(folder / "inputs" / fs::path(name).filename());
    for (const Json& inside : list_in(attribute(*run.reader, "inputs"))) {
      if (text.empty() && inside.is_object() && text_in(inside, "name") == name) text = text_in(inside, "text");
    }
    if (text.empty()) continue;
    std::string hash = sha256(text);
    run.inputs.push_back({{"name", name}, {"sha256", std::move(hash)}, {"text", std::move(text)}});
  }
}

/// The model in the directory, else that in the file of results.
void read_model(ReportedRun& run, const fs::path& folder, const LoadOptions& options) {
  std::error_code ignored;
  const fs::path file = kept_model(folder.string());
  const bool beside = fs::exists(file, ignored);
  run.model_text = beside ? text_of(file) : attribute(*run.reader, "model");
  if (run.model_text.empty()) return;
  const std::string digits = text_in(field(run.summary, "model"), "sha256");
  if (!digits.empty() && digits != sha256(run.model_text)) {
    run.note += (run.note.empty() ? "" : "; ") +
                fmt::format("'{}' is not the model of this run: it was changed since", file.filename().string());
  }
  BuildOptions build;
  use_settings(field(run.summary, "settings"), build);
  LoadOptions quiet = options;
  quiet.strict = false;
  quiet.warn = quiet.note = {};
  std::string why = "it has mistakes";
  try {
    LoadedModel loaded =
        beside ? load_model(file.string(), build, quiet) : load_text(run.model_text, file.string(), build, quiet);
    run.model = std::move(loaded.model);
    if (run.model) return;
    for (const Diagnostic& diagnostic : loaded.diagnostics.sorted()) {
      why = diagnostic.message;
      break;
    }
  } catch (const Error& error) {
    why = error.message();
  }
  run.note += (run.note.empty() ? "" : "; ") + ("no animation, as the model cannot be read: " + why);
}

/// Names and units as the model has them, where the file of rows says nothing.
void know_units(ReportedRun& run) {
  if (run.model) run.reader->know_units(*run.model);
  run.columns = run.reader->layout().columns;
}

}  // namespace

ReportedRun open_reported(const fs::path& path, const LoadOptions& options) {
  std::error_code ignored;
  ReportedRun run;
  run.reader = ResultReader::open(path);
  const bool directory = fs::is_directory(path, ignored);
  const fs::path folder = directory ? path : path.parent_path();
  take_summary(run, folder);
  read_model(run, folder, options);
  know_model(run);
  read_inputs(run, folder);
  know_units(run);
  // Of a run that has ended its count of rows says more.
  const std::string missing = visibly_missing(*run.reader);
  const bool counted = field(run.summary, "counts").contains("rows") && text_in(run.summary, "status") != "incomplete";
  if (!missing.empty() && (!counted || !run.reader->passed_over().empty()))
    run.note += (run.note.empty() ? "" : "; ") + missing;
  run.name = text_in(field(run.summary, "model"), "name");
  if (run.name.empty() && run.model) run.name = run.model->name;
  if (run.name.empty()) run.name = attribute(*run.reader, "title");
  if (run.name.empty()) run.name = fs::absolute(path).lexically_normal().filename().string();
  const auto ideal = field(run.summary, "settings").value("ideal", Json::array());
  if (ideal.is_array() && !ideal.empty()) run.name += "-ideal";
  return run;
}

std::string rerun_command(const ReportedRun& run) {
  const Json provenance = field(run.summary, "provenance");
  std::string model = text_in(field(provenance, "model"), "name");
  if (model.empty()) model = run.name;
  std::string command = "freeplay run " + shell_word(model + ".yaml");
  for (const Json& word : provenance.value("arguments", Json::array())) {
    if (word.is_string()) command += " " + shell_word(word.get<std::string>());
  }
  return command;
}

}  // namespace freeplay
