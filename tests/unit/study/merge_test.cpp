#include "study/merge.h"

#include <algorithm>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "study/point_set.h"
#include "study/row_sorter.h"
#include "unit/scratch_folder.h"

namespace freeplay {
namespace {

const SegmentHeader merged_header{"s", "p", "a", {}, "host", "now"};

MergePlan plan_of(std::uint64_t points) {
  MergePlan plan;
  plan.points = points;
  plan.layout = {{{"force", "N"}}, {}, false};
  plan.keys = {{"c", "m"}, {"law", "", true}};
  plan.cells = [](std::uint64_t point, std::vector<std::string>& cells) {
    cells = {std::to_string(point) + ".5", point % 2 == 0 ? "flores" : "hertz"};
  };
  plan.title = "test";
  return plan;
}

std::string row(std::uint64_t index, double force, const MergePlan& plan, double wall = 0.0) {
  StudyOutcome outcome;
  outcome.values = {force};
  outcome.wall = wall;
  std::string lines;
  append_point(lines, index, std::string(24, 'c'), outcome, plan.layout);
  return lines;
}

std::string failed(std::uint64_t index, const std::string& error, const MergePlan& plan) {
  std::string lines;
  append_point(lines, index, std::string(24, 'c'), {.exit_code = 4, .error = error, .message = "why"}, plan.layout);
  return lines;
}

/// The table of segments with these texts.
std::string table(const std::vector<std::string>& texts, const MergePlan& plan, const ScratchFolder& folder) {
  std::vector<std::filesystem::path> segments;
  for (const std::string& text : texts) {
    const std::string name = std::to_string(segments.size()) + ".rows";
    folder.write(name, merged_header.text() + text);
    segments.push_back(folder.file(name));
  }
  merge_rows(folder.path(), segments, plan, [](const auto&, std::size_t) {});
  return folder.read("study.csv");
}

TEST(Merge, TableIsSortedAndComplete) {
  const ScratchFolder folder;
  const MergePlan plan = plan_of(3);
  EXPECT_EQ("index,c,law,force,exit_code,error\n0,0.5,flores,10,0,\n1,1.5,hertz,,4,timeout\n2,2.5,flores,0.1,0,\n",
            table({row(2, 0.1, plan) + failed(1, "timeout", plan), row(0, 10.0, plan)}, plan, folder));
  EXPECT_EQ("{\"index\":1,\"exit_code\":4,\"error\":\"timeout\",\"message\":\"why\"}\n", folder.read("failures.jsonl"));
  EXPECT_EQ("\x89HDF\r\n\x1a\n", folder.read("study.h5").substr(0, 8));
  EXPECT_TRUE(folder.read("timing.csv").starts_with("index,host,wall_seconds,cpu_seconds,run_seconds\n0,host,"));
}

TEST(Merge, GoodRowReplacesFailedOnesAndTheLastFailureCounts) {
  const ScratchFolder folder;
  const MergePlan plan = plan_of(2);
  const std::string text =
      table({failed(0, "killed", plan) + row(1, 1.0, plan), failed(1, "timeout", plan) + failed(0, "timeout", plan)},
            plan, folder);
  EXPECT_NE(std::string::npos, text.find("0,0.5,flores,,4,timeout\n1,1.5,hertz,1,0,\n")) << text;
}

TEST(Merge, RowsThatAgreeUpToTheirTimesAreOne) {
  const ScratchFolder folder;
  const MergePlan plan = plan_of(1);
  const std::string text = table({row(0, 1.0, plan, 0.1), row(0, 1.0, plan, 0.2)}, plan, folder);
  EXPECT_EQ(2, std::ranges::count(text, '\n'));
}

TEST(Merge, RowsThatDifferAreRefusedWithTheirColumns) {
  const ScratchFolder folder;
  const MergePlan plan = plan_of(1);
  try {
    table({row(0, 1.0, plan), row(0, 1.0 + 1e-15, plan)}, plan, folder);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ("study-conflict", error.id());
    EXPECT_EQ(3, error.exit_code());
    EXPECT_NE(std::string::npos, error.message().find("force")) << error.message();
    EXPECT_NE(std::string::npos, error.message().find("1.rows")) << error.message();
  }
}

TEST(Merge, OrderOfSegmentsChangesNothing) {
  const MergePlan plan = plan_of(400);
  std::vector<std::uint64_t> points(400);
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = i;
  std::string first, first_numbers;
  for (unsigned seed = 0; seed < 3; ++seed) {
    const ScratchFolder folder;
    std::mt19937 random(seed);
    std::ranges::shuffle(points, random);
    std::vector<std::string> texts(1 + seed);
    for (const std::uint64_t point : points)
      texts[point % texts.size()] += row(point, 0.1 * static_cast<double>(point), plan);
    const std::string text = table(texts, plan, folder), numbers = folder.read("study.h5");
    if (seed == 0) {
      first = text;
      first_numbers = numbers;
    }
    EXPECT_EQ(first, text);
    EXPECT_EQ(first_numbers, numbers);
  }
}

TEST(Merge, SamplesStandInTheirOwnTable) {
  const ScratchFolder folder;
  MergePlan plan = plan_of(2);
  plan.layout.samples = {"force"};
  StudyOutcome outcome;
  outcome.values = {2.0};
  outcome.samples = {{{0.5, 1.5}, {1.0, -2.0}}};
  std::string lines;
  append_point(lines, 1, std::string(24, 'c'), outcome, plan.layout);
  table({lines}, plan, folder);
  EXPECT_EQ("index,reducer,k,time,value\n1,force,0,0.5,1.5\n1,force,1,1,-2\n", folder.read("samples.csv"));
}

/// Rows of one range of a large study: the first division into buckets leaves them in one.
TEST(RowSorter, SortsAcrossManyBuckets) {
  const ScratchFolder folder;
  constexpr std::uint64_t points = 1'000'000'000'000;
  RowSorter sorter(folder.path(), points, std::uint64_t{10} << 30);
  std::mt19937_64 random(1);
  std::map<std::uint64_t, int> put;
  const std::string values(200, 'v');
  for (int i = 0; i < 2000; ++i) {
    SegmentRow row;
    row.index = random() % points;
    row.values = values;
    sorter.put(row, 0);
    ++put[row.index];
  }
  std::vector<std::uint64_t> seen;
  sorter.visit([&](const std::vector<SortedRow>& rows) {
    seen.push_back(rows.front().index);
    EXPECT_EQ(put[rows.front().index], static_cast<int>(rows.size()));
    EXPECT_EQ(values, rows.front().values);
  });
  EXPECT_EQ(put.size(), seen.size());
  EXPECT_TRUE(std::ranges::is_sorted(seen));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(PointSet, HoldsPointsFarApart) {
  PointSet set;
  EXPECT_TRUE(set.insert(0));
  EXPECT_TRUE(set.insert(999'999'999'999));
  EXPECT_FALSE(set.insert(0));
  EXPECT_TRUE(set.has(999'999'999'999));
  EXPECT_FALSE(set.has(1));
  EXPECT_TRUE(set.erase(0));
  EXPECT_FALSE(set.erase(0));
  EXPECT_EQ(1u, set.count());
}

}  // namespace
}  // namespace freeplay
