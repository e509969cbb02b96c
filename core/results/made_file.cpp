#include "results/made_file.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/sha256.h"
#include "results/made_text.h"
#include "results/mat_table.h"
#include "results/reader.h"
#include "results/result_record.h"
#include "results/row_hash.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

std::string whole_text_of(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) {
    unreadable_result(path.string(),
                      fs::exists(path, ignored) ? "it is no file" : "there is no such file or directory");
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) unreadable_result(path.string(), std::strerror(errno));
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (file.bad()) unreadable_result(path.string(), "reading it failed");
  return text;
}

std::string lower_case(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

MadeKind kind_of(const fs::path& path) {
  constexpr std::size_t enough = 1024;
  std::ifstream file(path, std::ios::binary);
  std::string head(enough, '\0');
  file.read(head.data(), static_cast<std::streamsize>(enough));
  head.resize(static_cast<std::size_t>(file.gcount()));
  if (head.starts_with("\x89HDF")) return MadeKind::hdf5;
  if (head.starts_with("MATLAB 5.0")) return MadeKind::mat;
  head = lower_case(std::move(head));
  const std::size_t first = std::min(head.find_first_not_of(" \t\r\n\xef\xbb\xbf"), head.size());
  const std::string_view text = std::string_view(head).substr(first);
  if (text.starts_with("<!doctype html") || text.starts_with("<html")) return MadeKind::page;
  if (text.starts_with("<")) return MadeKind::picture;
  return text.starts_with("{") ? MadeKind::json : MadeKind::csv;
}

/// The result that a file of one stands for.
std::optional<fs::path> directory_of(const fs::path& file) {
  constexpr const char* names[] = {"results.csv", "events.csv", "summary.json", "model.yaml",
                                   "model.urdf",  "model.sdf",  "model.xml"};
  std::error_code ignored;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (std::ranges::find(names, file.filename().string()) == std::end(names)) return std::nullopt;
  if (!fs::exists(folder / "results.csv", ignored) && !fs::exists(folder / "results.h5", ignored)) return std::nullopt;
  return folder;
}

[[noreturn]] void no_provenance(const fs::path& path, const std::string& why, const std::string& hint = {}) {
  throw Error(Error::Category::file, "no-provenance", fmt::format("'{}' {}", path.string(), why), {}, hint);
}

Json record_beside_table(const fs::path& path) {
  const fs::path beside = path.string() + ".provenance.json";
  std::error_code ignored;
  return fs::exists(beside, ignored) ? json_of(whole_text_of(beside)) : Json(nullptr);
}

/// Record and data, by kind; whether its run had ended.
MadeFile read_as(MadeKind kind, const fs::path& path) {
  MadeFile made{.kind = kind, .path = path, .record = nullptr};
  if (kind == MadeKind::result) {
    made.record = record_of_directory(path);
    std::error_code ignored;
    const fs::path summary = path / "summary.json";
    made.ended = false;
    if (fs::exists(summary, ignored)) {
      const Json json = json_of(whole_text_of(summary));
      if (!json.is_object()) unreadable_result(summary.string(), "it is no JSON object");
      made.ended = has_ended(json);
    }
  } else if (kind == MadeKind::hdf5) {
    const std::unique_ptr<ResultReader> reader = open_hdf5(path);
    made.record = record_inside(*reader);
    made.ended = has_ended(json_of(reader->summary()));
  } else if (kind == MadeKind::mat) {
    made.record = json_of(read_mat(path).provenance);
  } else {
    const std::string text = whole_text_of(path);
    MadeText parts = kind == MadeKind::csv       ? MadeText{record_beside_table(path), text}
                     : kind == MadeKind::json    ? split_json(text)
                     : kind == MadeKind::picture ? split_picture(text)
                                                 : split_page(text);
    made.record = std::move(parts.record);
    made.data = std::move(parts.data);
  }
  if (!made.record.is_object()) return made;
  const Json run = made.record.value("run", Json());
  if (run.is_object()) made.ended = run.value("ended", true);
  if (kind != MadeKind::page) return made;
  for (const Json& shown : json_of(made.data)) made.ended = made.ended && has_ended(shown.value("summary", Json()));
  return made;
}

void require_record(const MadeFile& made) {
  if (!made.record.is_object() || !made.record.contains("made")) {
    const bool table = made.kind == MadeKind::csv;
    no_provenance(made.path, "has no record of how it was made",
                  table ? fmt::format("a table has it beside it: '{}.provenance.json'", made.path.string())
                        : "give a result directory, or a file that this program has made");
  }
  if (made.record.contains("study")) return;  // its files are those of the study
  for (const Json& run : runs_of(made)) {
    const Json model = run.value("model", Json());
    if (!model.is_object() || !model.value("text", Json()).is_string() || !model.value("sha256", Json()).is_string()) {
      no_provenance(made.path, "has a record without the text of its model");
    }
  }
}

std::string digits_of_data(const MadeFile& made) {
  const Json digits = made.record.value("data_sha256", Json());
  return digits.is_string() ? digits.get<std::string>() : std::string();
}

void compare_digest(const std::string& what, const Json& then, const std::string& now, bool of_model,
                    std::vector<RecordFault>& faults) {
  if (!then.is_string() || then.get<std::string>() == now) return;
  faults.push_back({fmt::format("{} was changed afterwards: SHA-256 {} recorded, {} now", what,
                                then.get<std::string>().substr(0, 12), now.substr(0, 12)),
                    of_model});
}

/// SHA-256 of all rows as a run counts them.
std::string digits_of_rows(ResultReader& reader) {
  RowHash hash;
  std::vector<std::size_t> all(reader.layout().columns.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  reader.rows(all, {}, [&](std::span<const double> rows) { hash.write({.rows = rows, .events = {}}); });
  return hash.digits();
}

void compare_rows(const MadeFile& made, std::vector<RecordFault>& faults) {
  const Json hashes = made.record.value("hashes", Json());
  if (!hashes.is_object() || !made.ended) return;
  const Json rows = hashes.value("rows", Json());
  std::error_code ignored;
  const bool alone = made.kind == MadeKind::hdf5;
  if (alone) compare_digest("the rows", rows, digits_of_rows(*open_hdf5(made.path)), false, faults);
  if (alone) return;
  if (const fs::path csv = made.path / "results.csv"; fs::exists(csv, ignored)) {
    compare_digest("results.csv", rows, digits_of_rows(*open_csv(csv)), false, faults);
  }
  if (const fs::path hdf5 = made.path / "results.h5"; fs::exists(hdf5, ignored)) {
    compare_digest("results.h5", rows, digits_of_rows(*open_hdf5(hdf5)), false, faults);
  }
  if (const fs::path events = made.path / "events.csv"; fs::exists(events, ignored)) {
    compare_digest("events.csv", hashes.value("events", Json()), sha256_of_file(events.string()), false, faults);
  }
}

/// Of a page: what its runs say of themselves, with texts of inputs as the record of the page has them.
std::vector<Json> runs_in_page(const MadeFile& made) {
  std::vector<Json> runs;
  const Json inputs = made.record.value("inputs", Json::array());
  for (const Json& run : json_of(made.data)) {
    Json record = run.value("summary", Json::object()).value("provenance", Json());
    if (!record.is_object() || !record.contains("model")) return {};
    record["model"]["text"] = run.value("model", Json());
    for (Json& input : record["inputs"]) {
      const auto same = [&](const Json& other) {
        return other.value("sha256", Json()) == input.value("sha256", Json());
      };
      const auto there = std::ranges::find_if(inputs, same);
      if (there != inputs.end()) input["text"] = there->value("text", Json());
    }
    runs.push_back(std::move(record));
  }
  return runs;
}

}  // namespace

std::string data_of(MadeKind kind, const fs::path& path) { return read_as(kind, path).data; }

MadeFile read_made_file(const fs::path& path) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) unreadable_result(path.string(), "there is no such file or directory");
  try {
    MadeFile made{};
    if (fs::is_directory(path, ignored)) {
      made = read_as(MadeKind::result, path);
    } else if (const auto folder = directory_of(path)) {
      made = read_as(MadeKind::result, *folder);
    } else {
      made = read_as(kind_of(path), path);
    }
    require_record(made);
    return made;
  } catch (const Json::exception&) {
    no_provenance(path, "has a record of another form than this program writes");
  }
}

std::vector<Json> runs_of(const MadeFile& made) {
  std::vector<Json> runs;
  if (made.kind == MadeKind::page) runs = runs_in_page(made);
  if (runs.empty()) runs = {made.record};
  if (const Json list = made.record.value("runs", Json()); list.is_array() && !list.empty()) {
    runs.assign(list.begin(), list.end());
  }
  for (Json& one : runs) {
    const Json run = one.value("run", Json());
    if (run.is_object()) one["arguments"] = run.value("arguments", Json::array());
  }
  return runs;
}

std::vector<RecordFault> record_faults(const MadeFile& made) {
  std::vector<RecordFault> faults;
  for (const Json& run : runs_of(made)) {
    const Json& model = run["model"];
    compare_digest("the model", model["sha256"], sha256(model["text"].get<std::string>()), true, faults);
    for (const Json& input : run.value("inputs", Json::array())) {
      const std::string text = input.value("text", "");
      compare_digest(fmt::format("the input '{}'", input.value("name", "")), input.value("sha256", Json()),
                     sha256(text), true, faults);
    }
  }
  if (const std::string digits = digits_of_data(made); !digits.empty()) {
    std::string now = sha256(made.data);
    if (now != digits) {  // or of the text that the page stands for
      std::string plain = made.data;
      for (std::size_t at = 0; (at = plain.find("\\u003c", at)) != std::string::npos;) plain.replace(at, 6, "<");
      if (sha256(plain) == digits) now = digits;
    }
    compare_digest("its data", digits, now, false, faults);
  }
  if (made.record.value("made", Json()) == "run") compare_rows(made, faults);
  return faults;
}

}  // namespace freeplay
