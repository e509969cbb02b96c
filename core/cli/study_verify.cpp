#include <algorithm>
#include <bit>
#include <map>
#include <random>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/number_text.h"
#include "base/processors.h"
#include "cli/study_table.h"
#include "cli/study_views.h"
#include "cli/terminal.h"
#include "study/row_outcome.h"
#include "workers/worker_pool.h"

namespace freeplay {
namespace {

/// Points with rows that say something of the point, chosen by chance, each as often as any other.
std::vector<std::uint64_t> choose(const StudyTable& table, std::uint64_t points, std::size_t count,
                                  std::uint64_t seed) {
  std::mt19937_64 chance(seed);
  std::vector<std::uint64_t> chosen;
  std::uint64_t seen = 0;
  for (std::uint64_t point = 0; point < points; ++point) {
    if (!table.scan().done().has(point) || table.scan().killed().has(point)) continue;
    ++seen;
    if (chosen.size() < count) {
      chosen.push_back(point);
    } else if (const std::uint64_t at = chance() % seen; at < count) {
      chosen[static_cast<std::size_t>(at)] = point;
    }
  }
  std::ranges::sort(chosen);
  return chosen;
}

bool same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) || (a != a && b != b);
}

/// The first thing in which two outcomes of a point differ, with both values; empty where there is none.
std::string difference(const StudyOutcome& row, const StudyOutcome& now, const RowLayout& layout) {
  if (row.exit_code != now.exit_code || row.error != now.error) {
    const auto words = [](const StudyOutcome& of) { return of.error.empty() ? std::string("ok") : of.error; };
    return fmt::format("error {} {}", words(row), words(now));
  }
  if (row.exit_code != 0) return {};
  for (std::size_t i = 0; i < layout.columns.size(); ++i) {
    if (!same(row.values[i], now.values[i])) {
      return fmt::format("{} {} {}", layout.columns[i].name, number_text(row.values[i]), number_text(now.values[i]));
    }
  }
  for (std::size_t i = 0; i < layout.samples.size(); ++i) {
    if (row.samples[i] != now.samples[i]) return fmt::format("values of {}", layout.samples[i]);
  }
  return row.state == now.state ? std::string() : "the state at its end";
}

/// Rows that count of some points.
std::map<std::uint64_t, StudyOutcome> rows_of(const std::vector<std::uint64_t>& points, const RowScan& scan,
                                              const RowLayout& layout) {
  std::map<std::uint64_t, StudyOutcome> rows;
  scan.each_that_counts([&](const SegmentRow& row) {
    if (!std::ranges::binary_search(points, row.index)) return;
    const auto [place, added] = rows.try_emplace(row.index);
    if (added || place->second.exit_code != 0) place->second = outcome_of(row, layout);
  });
  return rows;
}

}  // namespace

int study_verify(const StudyOptions& options, const CommonOptions& common) {
  constexpr long usual = 20;
  StudyInFolder opened = open_kept(only_study(options, "verify", "DIR"), StudyUse::run_points, common);
  if (!opened.study) return opened.exit_code;
  OpenStudy& study = *opened.study;
  const long count = options.points.empty() ? usual : whole_number("--points", options.points, 1);
  const long seed = options.seed.empty() ? 1 : whole_number("--seed", options.seed, 0);
  StudyTable table(study, opened.folder);
  table.look(study.mark(), {}, warn_of_damage(common));
  const std::vector<std::uint64_t> points =
      choose(table, study.plan().points(), static_cast<std::size_t>(count), static_cast<std::uint64_t>(seed));
  const auto rows = rows_of(points, table.scan(), study.layout());
  std::map<std::uint64_t, std::string> differing;
  std::size_t given = 0;
  WorkerPool pool(study.work(), {.jobs = processor_count(), .isolate = true});
  pool.run(
      [&](StudyTask& task) {
        if (given == points.size()) return false;
        const UnitPlace at = study.plan().place_of(points[given++]);
        task = {at.unit, at.place, at.place + 1, table.scan().state_before(at.unit, at.place)};
        return true;
      },
      [&](std::uint64_t point, const StudyOutcome& outcome) {
        const std::string what = difference(rows.at(point), outcome, study.layout());
        if (!what.empty()) differing[point] = what;
      },
      [] { return true; });
  if (common.json) {
    Json list = Json::array();
    for (const auto& [point, what] : differing) list.push_back({{"index", point}, {"difference", what}});
    print_json({{"points", points.size()}, {"differ", list}});
  } else if (differing.empty()) {
    print(fmt::format("{} points: same\n", points.size()));
  } else {
    for (const auto& [point, what] : differing) print(fmt::format("point {} differs: {}\n", point, what));
  }
  return differing.empty() ? 0 : 7;
}

}  // namespace freeplay
