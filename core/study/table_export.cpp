#include "study/table_export.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/kept_input.h"
#include "base/name_pattern.h"
#include "base/suggestion.h"
#include "base/whole_file.h"
#include "study/table_rows.h"

namespace freeplay {
namespace {

constexpr std::size_t piece = 1 << 16;  // characters given at a time

/// Places of the columns that are wanted.
std::vector<std::size_t> chosen(const TableRows& table, const std::vector<std::string>& patterns) {
  const std::vector<std::string>& names = table.columns();
  for (const std::string& pattern : patterns) {
    if (std::ranges::any_of(names, [&](const std::string& name) { return matches(pattern, name); })) continue;
    const auto nearest = suggestion(pattern, names);
    throw Error(Error::Category::usage, "unknown-channel", fmt::format("no column fits --channels '{}'", pattern), {},
                nearest ? fmt::format("did you mean '{}'?", *nearest) : "");
  }
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto fits = [&](const std::string& pattern) { return matches(pattern, names[i]); };
    if (i == 0 || patterns.empty() || std::ranges::any_of(patterns, fits)) places.push_back(i);
  }
  return places;
}

std::string unit_of(const OpenStudy& study, const std::string& name) {
  for (const AxisColumn& column : study.plan().axis_columns()) {
    if (column.name == name) return column.unit;
  }
  for (const StudyColumn& column : study.columns().table) {
    if (column.name == name) return column.unit;
  }
  return name == "index" || name == "sample" || name == "exit_code" ? "1" : "";
}

std::string compact(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

/// A number as it stands there, a word in quotes.
void append_json(std::string& text, std::string_view cell) {
  double value = 0.0;
  const auto read = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (cell.empty()) {
    text += "null";
  } else if (read.ec == std::errc() && read.ptr == cell.data() + cell.size() && std::isfinite(value)) {
    text += cell;
  } else {
    text += compact(std::string(cell));
  }
}

}  // namespace

void give_study_csv(const TableExport& of, const std::function<void(std::string_view)>& take) {
  TableRows table(of.folder);
  const std::vector<std::size_t> places = chosen(table, of.channels);
  std::string text;
  const auto put = [&](const auto& cells) {
    for (const std::size_t place : places) {
      if (place != 0) text += ',';
      text += cells[place];
    }
    text += '\n';
  };
  put(table.columns());
  while (table.next()) {
    put(table.cells());
    if (text.size() < piece) continue;
    take(text);
    text.clear();
  }
  take(text);
}

void give_study_json(const TableExport& of, const Json& provenance, const std::function<void(std::string_view)>& take) {
  TableRows table(of.folder);
  const std::vector<std::size_t> places = chosen(table, of.channels);
  Json columns = Json::array(), units = Json::array();
  for (const std::size_t place : places) {
    columns.push_back(table.columns()[place]);
    units.push_back(unit_of(of.study, table.columns()[place]));
  }
  std::string text = fmt::format("{{\n  \"table\": \"study\",\n  \"columns\": {},\n  \"units\": {},\n  \"rows\": [",
                                 compact(columns), compact(units));
  bool first = true;
  while (table.next()) {
    text += std::exchange(first, false) ? "\n    [" : ",\n    [";
    for (const std::size_t place : places) {
      if (place != 0) text += ", ";
      append_json(text, table.cells()[place]);
    }
    text += "]";
    if (text.size() < piece) continue;
    take(text);
    text.clear();
  }
  text += fmt::format("{}],\n  \"provenance\": {}\n}}\n", first ? "" : "\n  ", compact(provenance));
  take(text);
}

Json study_provenance(const OpenStudy& study, const StudyFolder& folder) {
  Json files = Json::array();
  for (const KeptFile& file : study.plan().kept_files()) {
    if (std::filesystem::path(file.path).extension() != ".so") {
      files.push_back({{"path", file.path}, {"text", file.bytes}});
    }
  }
  return {{"study", folder.record()}, {"files", std::move(files)}};
}

void stage_study(const Json& provenance, const std::filesystem::path& folder) {
  const auto refuse = [](const std::string& why) {
    throw Error(Error::Category::file, "no-provenance", "the record of the study cannot be followed: " + why);
  };
  const Json files = provenance.value("files", Json()), record = provenance.value("study", Json());
  if (!files.is_array() || !record.is_object()) return refuse("it has no files");
  for (const Json& file : files) {
    const Json path = file.is_object() ? file.value("path", Json()) : Json(),
               text = path.is_string() ? file.value("text", Json()) : Json();
    if (!text.is_string()) return refuse("a file of it has no text");
    const std::filesystem::path place(path.get<std::string>());
    const bool inside =
        place.is_relative() && std::ranges::none_of(place, [](const auto& part) { return part == ".."; });
    if (!inside) return refuse(fmt::format("it names the place '{}'", place.string()));
    write_whole_file(folder / place, text.get<std::string>());
    if (place.stem() == "model") write_whole_file((folder / place).parent_path() / only_copies, "");
  }
  write_whole_file(folder / "study.json", json_text(record));
}

}  // namespace freeplay
