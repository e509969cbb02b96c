#include "results/reproduction.h"

#include <algorithm>
#include <fstream>
#include <memory>
#include <system_error>

#include <fmt/format.h>

#include "results/checkpoint.h"
#include "results/json_difference.h"
#include "results/result_record.h"
#include "results/table_difference.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;
using Checks = std::vector<ReproductionCheck>;

/// What of a summary says where files are, how long it took, and what is in the record.
const std::vector<std::string> not_of_the_run{"/performance", "/model/file", "/provenance", "/files"};
/// The same in the data of a page, whose names are those of directories.
const std::vector<std::string> not_of_the_page{
    "/*/name",         "/*/rerun", "/*/summary/performance", "/*/summary/model/file", "/*/summary/provenance",
    "/*/summary/files"};

bool has_file(const fs::path& file) {
  std::error_code ignored;
  return fs::exists(file, ignored);
}

Json json_in(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  Json json = Json::parse(stream, nullptr, false);
  return json.is_discarded() ? Json(nullptr) : json;
}

std::string size_of(const TableDifference& table) {
  const std::string rows =
      table.rows < table.rows_now ? fmt::format("{} of {}", table.rows, table.rows_now) : fmt::format("{}", table.rows);
  return fmt::format("{} x {}", rows, table.columns);
}

ReproductionCheck check_of(const std::string& what, const TableDifference& table) {
  return {.what = what, .size = size_of(table), .first_difference = table.first};
}

/// Its files are those that the run made again has, and others that stood there before. A run that a script controlled
/// has no checkpoint.
std::string missing_file(const Json& then, const Json& now) {
  const Json before = then.value("files", Json::array()), after = now.value("files", Json::array());
  for (const Json& name : after) {
    if (name != checkpoint_name && std::ranges::find(before, name) == before.end())
      return fmt::format("/files: {} now", name.dump());
  }
  return {};
}

ReproductionCheck check_summary(const std::string& what, const Json& then, const Json& now) {
  ReproductionCheck check{.what = what, .size = {}, .first_difference = {}, .bytes = false};
  check.size = fmt::format("{} numbers", count_numbers(then, not_of_the_run));
  check.first_difference = first_difference(then, now, not_of_the_run);
  if (!check.same()) return check;
  const Json record = then.value("provenance", Json::object());
  if (record.contains("hashes")) {
    check.first_difference = first_difference(record["hashes"], now.value("hashes", Json()), {});
    if (!check.same()) check.first_difference.insert(0, "/provenance/hashes");
  }
  if (check.same()) check.first_difference = missing_file(then, now);
  return check;
}

/// Names, units and other words of columns, and what else the file says of itself.
std::string different_words(const RecordLayout& then, const RecordLayout& now) {
  const auto compare = [](const std::vector<RecordColumn>& a, const std::vector<RecordColumn>& b) -> std::string {
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
      const std::pair<const std::string&, const std::string&> pairs[] = {
          {a[i].unit, b[i].unit}, {a[i].long_name, b[i].long_name}, {a[i].source, b[i].source}};
      for (const auto& [x, y] : pairs) {
        if (x != y) return fmt::format("{}: '{}' recorded, '{}' now", a[i].name, x, y);
      }
    }
    return {};
  };
  std::string found = compare(then.columns, now.columns);
  if (found.empty()) found = compare(then.events, now.events);
  for (const auto& attribute : then.attributes) {
    const auto& name = attribute.first;
    const auto& text = attribute.second;
    if (!found.empty() || name == "provenance" || name == "freeplay_version" || name == "inputs") continue;
    const auto same_name = [&](const auto& other) { return other.first == name; };
    const auto other = std::ranges::find_if(now.attributes, same_name);
    if (other == now.attributes.end() || other->second != text) found = fmt::format("attribute '{}'", name);
  }
  return found;
}

std::string different_bearings(ResultReader& then, ResultReader& now) {
  for (const char* quantity : {"contact_time", "impulse", "sliding", "work", "pv_mean", "pv_max"}) {
    if (then.layout().bearings.empty()) return {};
    const std::vector<double> a = then.bearing(quantity), b = now.bearing(quantity);
    for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i) {
      const Json x = i < a.size() ? json_number(a[i]) : Json("nothing"),
                 y = i < b.size() ? json_number(b[i]) : Json("nothing");
      if (x != y) return fmt::format("bearing/{}, number {}: {} recorded, {} now", quantity, i, x.dump(), y.dump());
    }
  }
  return {};
}

/// An HDF5 file of a run: each part by itself, or all of it in one line.
Checks check_hdf5(const fs::path& then_file, const fs::path& now_file, bool of_run, bool ended) {
  const std::unique_ptr<ResultReader> then = open_hdf5(then_file), now = open_hdf5(now_file);
  Checks checks{check_of("rows", compare_rows(*then, *now, {.as_far_as_it_goes = !ended}))};
  if (!then->layout().events.empty()) {
    const TableDifference events = compare_events(*then, *now, {.row = "event", .as_far_as_it_goes = !ended});
    checks.push_back(check_of("events", events));
    checks.back().size = fmt::format("{}", events.rows);
  }
  checks.push_back({.what = "words", .size = {}, .first_difference = different_words(then->layout(), now->layout())});
  if (!of_run || !ended) return checks;
  checks.push_back({.what = "bearing", .size = {}, .first_difference = different_bearings(*then, *now)});
  checks.push_back(check_summary("summary", json_of(then->summary()), json_of(now->summary())));
  return checks;
}

/// Lines that say nothing of their own where all is well.
Checks without_small_parts(Checks checks) {
  std::erase_if(checks, [](const ReproductionCheck& check) { return check.size.empty() && check.same(); });
  return checks;
}

ReproductionCheck in_one(const std::string& what, const Checks& checks) {
  ReproductionCheck out{.what = what, .size = checks.front().size, .first_difference = {}};
  for (const ReproductionCheck& check : checks) {
    if (out.same()) out.first_difference = check.first_difference;
  }
  return out;
}

Checks check_directories(const fs::path& then, const fs::path& now, bool ended, const std::string& prefix) {
  Checks checks;
  const bool text = has_file(then / "results.csv"), hdf5 = has_file(then / "results.h5");
  if (text) {
    checks.push_back(
        check_of("rows", compare_csv(then / "results.csv", now / "results.csv", {.as_far_as_it_goes = !ended})));
  }
  Checks of_hdf5;
  if (hdf5) of_hdf5 = check_hdf5(then / "results.h5", now / "results.h5", true, ended);
  if (hdf5 && !text) checks.push_back(of_hdf5.front());
  const TableRules rules{.row = "event", .as_far_as_it_goes = !ended};
  const TableDifference events = compare_csv(then / "events.csv", now / "events.csv", rules);
  checks.push_back(check_of("events", events));
  checks.back().size = fmt::format("{}", events.rows);
  if (ended) checks.push_back(check_summary("summary", json_in(then / "summary.json"), json_in(now / "summary.json")));
  if (hdf5) checks.push_back(in_one("results.h5", of_hdf5));
  for (ReproductionCheck& check : checks) check.what.insert(0, prefix);
  return checks;
}

/// A table as text, or its first line that differs where it is none with names.
ReproductionCheck check_text(const std::string& what, const std::string& then, const std::string& now, bool ended) {
  ReproductionCheck check{.what = what, .size = fmt::format("{} bytes", then.size()), .first_difference = {}};
  if (then == now || (!ended && now.starts_with(then))) return check;
  const auto at = static_cast<std::size_t>(std::ranges::mismatch(then, now).in1 - then.begin());
  const auto line = std::count(then.begin(), then.begin() + static_cast<std::ptrdiff_t>(at), '\n') + 1;
  const auto around = [&](const std::string& text) {
    const std::size_t from = std::min(at - std::min<std::size_t>(at, 10), text.size());
    std::string some = text.substr(from, 30);
    std::ranges::replace(some, '\n', ' ');
    return some;
  };
  check.first_difference =
      fmt::format("byte {}, line {}: '{}' recorded, '{}' now", at, line, around(then), around(now));
  return check;
}

ReproductionCheck check_page(const std::string& then, const std::string& now) {
  const Json before = json_of(then), after = json_of(now);
  ReproductionCheck check{.what = "data", .size = fmt::format("{} bytes", then.size()), .first_difference = {}};
  check.first_difference = first_difference(before, after, not_of_the_page);
  return check;
}

/// A text with the names of results that the record has.
std::string with_names(std::string text, const std::vector<std::string>& results, const Json& record) {
  const Json names = record.value("results", Json::array());
  for (std::size_t i = 0; i < std::min(results.size(), names.size()); ++i) {
    const std::string name = names[i].get<std::string>();
    for (std::size_t at = 0; (at = text.find(results[i], at)) != std::string::npos; at += name.size()) {
      text.replace(at, results[i].size(), name);
    }
  }
  return text;
}

}  // namespace

std::vector<ReproductionCheck> compare_again(const MadeFile& made, const fs::path& again,
                                             const std::vector<std::string>& results) {
  const bool ended = made.ended;
  switch (made.kind) {
    case MadeKind::result: {
      Checks checks = check_directories(made.path, again, ended, "");
      const fs::path twin = made.path / "twin";
      if (!has_file(twin / "run.log")) return checks;
      const bool twin_ended = ended && has_ended(json_in(twin / "summary.json"));
      Checks more = check_directories(twin, again / "twin", twin_ended, "twin/");
      checks.insert(checks.end(), more.begin(), more.end());
      return checks;
    }
    case MadeKind::hdf5: {
      const bool of_run = made.record.value("made", Json()) == "run";
      return without_small_parts(check_hdf5(made.path, of_run ? again / "results.h5" : again, of_run, ended));
    }
    case MadeKind::mat:
      return {check_of("rows", compare_mat(read_mat(made.path), read_mat(again)))};
    case MadeKind::csv:
      return {check_of("rows", compare_csv(made.path, again, {.as_far_as_it_goes = !ended}))};
    case MadeKind::page:
      return {check_page(made.data, data_of(made.kind, again))};
    case MadeKind::json:
    case MadeKind::picture:
      break;
  }
  return {check_text("data", made.data, with_names(data_of(made.kind, again), results, made.record), ended)};
}

}  // namespace freeplay
