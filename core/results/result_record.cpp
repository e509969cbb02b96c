#include "results/result_record.h"

#include <fstream>
#include <system_error>

#include <fmt/format.h>

#include "base/error.h"
#include "base/input_text.h"
#include "base/kept_input.h"
#include "base/version.h"
#include "results/checkpoint.h"
#include "results/schema.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

std::string attribute(const ResultReader& reader, const char* name) {
  for (const auto& [key, text] : reader.layout().attributes) {
    if (key == name) return text;
  }
  return {};
}

std::string text_of(const fs::path& file) {
  std::string text;
  return read_input(file.string(), text).empty() ? text : std::string();
}

bool is_record(const Json& json) { return json.is_object() && json.contains("model") && json["model"].is_object(); }

Json record_of_summary(const std::string& text) {
  const Json summary = json_of(text);
  return summary.is_object() ? summary.value("provenance", Json()) : Json();
}

/// What a checkpoint says of the making of its run; empty where there is none.
Json made_of_checkpoint(const fs::path& folder) {
  try {
    return read_checkpoint(folder).made;
  } catch (const Error&) {
    return Json::object();
  }
}

/// Of results.h5, which may be damaged: other files have the same.
Json record_of_rows(const fs::path& folder) {
  std::error_code ignored;
  if (!fs::exists(folder / "results.h5", ignored)) return nullptr;
  try {
    return json_of(attribute(*open_hdf5(folder / "results.h5"), "provenance"));
  } catch (const Error&) {
    return nullptr;
  }
}

}  // namespace

Json json_of(const std::string& text) {
  Json json = Json::parse(text, nullptr, false);
  return json.is_discarded() ? Json(nullptr) : json;
}

bool has_ended(const Json& summary) {
  if (!summary.is_object()) return false;
  return summary.value("status", Json()) != "interrupted" && summary.value("exit_code", Json()) != 6;
}

Json record_of_directory(const fs::path& folder) {
  Json record = record_of_summary(text_of(folder / "summary.json"));
  if (!is_record(record)) record = record_of_rows(folder);
  if (!is_record(record)) record = made_of_checkpoint(folder).value("provenance", Json());
  if (!is_record(record)) return nullptr;
  record["model"]["text"] = text_of(kept_model(folder.string()));
  for (Json& input : record["inputs"]) {
    if (!input.is_object() || !input.value("name", Json()).is_string()) continue;
    // No more than a name, whatever a record from elsewhere says.
    input["text"] = text_of(folder / "inputs" / fs::path(input["name"].get<std::string>()).filename());
  }
  return record;
}

Json read_summary(const fs::path& folder) {
  const fs::path file = folder / "summary.json";
  Json summary = json_of(text_of(file));
  if (!summary.is_object()) return nullptr;
  require_known_schema(file.string(), summary.value(Json::json_pointer("/freeplay/schema"), Json(schema_version)),
                       summary.value(Json::json_pointer("/freeplay/version"), Json()));
  return summary;
}

void require_known_schema(const std::string& file, const Json& schema, const Json& version) {
  if (schema == schema_version) return;
  unreadable_result(
      file, fmt::format("its schema is {}, and this program reads schema {}", schema.dump(), schema_version), 0,
      version.is_string()
          ? fmt::format("it was written by freeplay {}, this is {}", version.get<std::string>(), program_version)
          : "");
}

Json summary_of_unfinished(const fs::path& folder, const ResultReader& reader) {
  Json summary = {{"status", "incomplete"}};
  Json made = made_of_checkpoint(folder);
  for (const char* name : {"settings", "provenance"}) {
    Json part = json_of(attribute(reader, name));
    if (!part.is_object()) part = made.value(name, Json());
    if (part.is_object()) summary[name] = std::move(part);
  }
  if (is_record(summary.value("provenance", Json()))) {
    summary["model"] = {{"name", summary["provenance"]["model"].value("name", Json())}};
  }
  return summary;
}

std::string unfinished_words(const Json& summary) {
  const std::string status = summary.is_object() ? summary.value("status", "") : "";
  if (status == "completed" || status == "stopped" || status.empty()) return "";
  return status == "incomplete" ? " (the run goes on, or was killed)" : " (" + status + ")";
}

Json record_inside(ResultReader& reader) {
  Json record = json_of(attribute(reader, "provenance"));
  if (!is_record(record)) return nullptr;
  if (record.value("made", Json()) != "run") return record;  // what was made from a result has it all
  const Json of_summary = record_of_summary(reader.summary());
  if (is_record(of_summary)) record = of_summary;  // which has hashes
  record["model"]["text"] = attribute(reader, "model");
  record["inputs"] = json_of(attribute(reader, "inputs"));
  return record;
}

Json record_of(const fs::path& path, ResultReader& reader, const MadeOfResult& made) {
  Json record = record_inside(reader);
  if (!is_record(record)) {
    std::error_code ignored;
    record = record_of_directory(fs::is_directory(path, ignored) ? path : path.parent_path());
  }
  if (!is_record(record)) return nullptr;
  if (record.value("made", Json()) == "run") {
    record["run"] = {{"command", record.value("command", Json())},
                     {"arguments", record.value("arguments", Json::array())},
                     {"ended", has_ended(json_of(reader.summary()))}};
  } else {
    record["before"].push_back(record.value("arguments", Json::array()));  // a table of a table
  }
  record["made"] = made.made;
  record["command"] = made.command;
  record["arguments"] = made.arguments;
  return record;
}

}  // namespace freeplay
