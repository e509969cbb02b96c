#include "results/result_record.h"

#include <fstream>
#include <system_error>

#include "base/input_text.h"

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

Json parsed(const std::string& text) {
  Json json = Json::parse(text, nullptr, false);
  return json.is_discarded() ? Json(nullptr) : json;
}

/// From the files beside a CSV file.
Json record_beside(const fs::path& folder) {
  const Json summary = parsed(text_of(folder / "summary.json"));
  if (!summary.is_object() || !summary.contains("provenance") || !summary["provenance"].is_object()) return nullptr;
  Json record = summary["provenance"];
  std::error_code ignored;
  record["model"]["text"] =
      text_of(fs::exists(folder / "model.urdf", ignored) ? folder / "model.urdf" : folder / "model.yaml");
  if (!record.contains("inputs")) return record;
  for (Json& input : record["inputs"]) {
    if (input.contains("name") && input["name"].is_string()) {
      input["text"] = text_of(folder / "inputs" / input["name"].get<std::string>());
    }
  }
  return record;
}

}  // namespace

Json record_of(const fs::path& path, const ResultReader& reader, const MadeOfResult& made) {
  Json record = parsed(attribute(reader, "provenance"));
  if (record.is_object()) {
    record["model"]["text"] = attribute(reader, "model");
    record["inputs"] = parsed(attribute(reader, "inputs"));
  } else {
    std::error_code ignored;
    record = record_beside(fs::is_directory(path, ignored) ? path : path.parent_path());
  }
  if (!record.is_object()) return nullptr;
  if (record.value("made", "") == "run") {
    record["run"] = {{"command", record.value("command", "")}, {"arguments", record.value("arguments", Json::array())}};
  }
  record["made"] = made.made;
  record["command"] = made.command;
  record["arguments"] = made.arguments;
  return record;
}

}  // namespace freeplay
