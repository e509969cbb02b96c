#include "results/whole_result.h"

#include <cstdint>
#include <fstream>
#include <limits>
#include <memory>
#include <numeric>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "base/input_text.h"
#include "base/kept_input.h"
#include "base/sha256.h"
#include "results/kept_part.h"
#include "results/row_hash.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t shown_digits = 12;

bool is_file(const fs::path& file) {
  std::error_code ignored;
  return fs::exists(file, ignored);
}

Json field(const Json& json, const char* pointer) {
  const Json::json_pointer path(pointer);
  return json.contains(path) ? json.at(path) : Json();
}

Json record_in(const fs::path& file) {
  std::string text;
  if (!is_file(file) || !read_input(file.string(), text).empty()) return nullptr;
  return Json::parse(text, nullptr, false);
}

std::optional<ChangedSource> changed_file(const fs::path& file, const std::string& name, const Json& then) {
  if (!then.is_string()) return std::nullopt;
  std::string text;
  const bool gone = !is_file(file) || !read_input(file.string(), text).empty();
  const std::string now = gone ? "gone" : sha256(text), before = then.get<std::string>();
  if (now == before) return std::nullopt;
  return ChangedSource{name, before.substr(0, shown_digits), now.substr(0, shown_digits)};
}

/// Whether a file of rows is CSV: its first column is the time.
bool is_text(const fs::path& file) {
  constexpr std::string_view mark = "time";
  std::string head(mark.size(), '\0');
  std::ifstream(file, std::ios::binary).read(head.data(), static_cast<std::streamsize>(head.size()));
  return head == mark;
}

/// Of results.csv or results.h5.
std::string misfit_of_rows(const fs::path& file, const Json& count, const Json& digits) {
  const auto reader = ResultReader::open(file);
  const std::size_t width = reader->layout().columns.size();
  std::vector<std::size_t> all(width);
  std::iota(all.begin(), all.end(), std::size_t{0});
  RowHash hash;
  std::int64_t rows = 0;
  reader->rows(all, {}, [&](std::span<const double> some) {
    hash.write({.rows = some, .events = {}});
    rows += static_cast<std::int64_t>(some.size() / width);
  });
  const std::int64_t counted = count.is_number_integer() ? count.get<std::int64_t>() : rows;
  // Without a fingerprint a file may hold more: another one could not be written.
  if (digits.is_string() ? rows != counted : rows < counted) {
    return fmt::format("'{}' has {} row{}, and its summary counts {}", file.string(), rows, rows == 1 ? "" : "s",
                       counted);
  }
  if (!digits.is_string() || hash.digits() == digits.get<std::string>()) return {};
  return fmt::format("'{}' was changed: its rows are not those that its summary has the fingerprint of", file.string());
}

std::string misfit_of_events(const fs::path& file, const Json& digits) {
  if (!digits.is_string()) return {};
  if (!is_file(file)) return fmt::format("'{}' is gone", file.string());
  Sha256 hash;
  whole_lines(file, std::numeric_limits<std::int64_t>::max(), &hash);
  if (hash.digits() == digits.get<std::string>()) return {};
  return fmt::format("'{}' was changed or cut: its events are not those that its summary has the fingerprint of",
                     file.string());
}

bool has_open_line(const fs::path& file) { return whole_lines(file, std::numeric_limits<std::int64_t>::max()).more; }

std::string left_out(const fs::path& file) {
  return fmt::format("the last line of '{}' has no end and is left out: its run goes on or was killed, or it was cut",
                     file.string());
}

/// Of events.csv in a directory that may have a summary.
std::string missing_events(const fs::path& directory) {
  const fs::path file = directory / "events.csv";
  const Json summary = record_in(directory / "summary.json");
  if (!is_file(file)) return {};
  std::string misfit = summary.is_object() ? misfit_of_events(file, field(summary, "/hashes/events")) : std::string();
  return misfit.empty() && has_open_line(file) ? left_out(file) : misfit;
}

}  // namespace

std::optional<ChangedSource> changed_source(const fs::path& directory, const Json& record) {
  const fs::path model = kept_model(directory.string());
  if (!record.is_object()) return std::nullopt;
  if (auto changed = changed_file(model, "the model", field(record, "/model/sha256"))) return changed;
  for (const Json& input : record.value("inputs", Json::array())) {
    const std::string name = input.value("name", "");
    auto changed =
        changed_file(directory / "inputs" / name, fmt::format("'{}' of the inputs", name), field(input, "/sha256"));
    if (changed) return changed;
  }
  return std::nullopt;
}

std::string misfit_of(const fs::path& directory, const Json& summary) {
  const Json count = field(summary, "/counts/rows"), digits = field(summary, "/hashes/rows");
  // The files of a killed run end at different rows.
  const bool killed = field(summary, "/stop_reason") == Json("killed");
  bool any = false;
  for (const char* name : {"results.h5", "results.csv"}) {
    const fs::path file = directory / name;
    if (!is_file(file) || (killed && any)) continue;
    any = true;
    if (std::string misfit = misfit_of_rows(file, count, digits); !misfit.empty()) return misfit;
  }
  if (!any && count.is_number_integer() && count.get<std::int64_t>() > 0) {
    return fmt::format("'{}' holds neither results.h5 nor results.csv", directory.string());
  }
  return misfit_of_events(directory / "events.csv", field(summary, "/hashes/events"));
}

std::string part_of_a_line(const fs::path& directory) {
  for (const char* name : {"results.csv", "events.csv"}) {
    const fs::path file = directory / name;
    if (is_file(file) && has_open_line(file)) {
      return fmt::format("'{}' was changed: it ends in part of a line, which its run did not write", file.string());
    }
  }
  return {};
}

std::string visibly_missing(const ResultReader& reader) {
  const fs::path file = reader.file();
  if (!reader.passed_over().empty())
    return fmt::format("{}; rows are those of '{}'", reader.passed_over(), file.string());
  if (!is_text(file)) return {};
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  if (stream.tellg() > 0) stream.seekg(-1, std::ios::end);
  const int last = stream.get();
  return last == std::char_traits<char>::eof() || last == '\n' ? std::string() : left_out(file);
}

std::string missing_part(ResultReader& reader, const std::string& table) {
  const fs::path file = reader.file();
  if (!reader.passed_over().empty()) return visibly_missing(reader);
  if (!is_text(file)) return {};  // others are read as a whole or not at all
  if (table == "events" || table == "impacts") return missing_events(file.parent_path());
  Sha256 hash;
  const WholeLines lines = whole_lines(file, std::numeric_limits<std::int64_t>::max(), &hash);
  const Json record = record_in(file.string() + ".provenance.json");
  const Json digits = record.is_object() ? field(record, "/data_sha256") : Json();
  if (digits.is_string() && (lines.more || hash.digits() != digits.get<std::string>())) {
    return fmt::format("'{}' was changed or cut: it has not the fingerprint in the record beside it", file.string());
  }
  const Json summary = file.filename() == "results.csv" ? record_in(file.parent_path() / "summary.json") : Json();
  const Json counted = summary.is_object() ? field(summary, "/counts/rows") : Json();
  if (counted.is_number_integer() && counted.get<std::int64_t>() > lines.lines - 1) {
    return fmt::format("rows of '{}' are missing: it has {}, and its summary counts {}", file.string(), lines.lines - 1,
                       counted.get<std::int64_t>());
  }
  return lines.more ? left_out(file) : std::string();
}

}  // namespace freeplay
