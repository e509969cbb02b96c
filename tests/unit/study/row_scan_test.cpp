#include "study/row_scan.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "study/merge.h"
#include "study/schedule.h"
#include "study/segment_header.h"
#include "unit/scratch_folder.h"
#include "unit/study/fake_work.h"

namespace freeplay {
namespace {

constexpr std::uint64_t places = 7;

/// Three chains. A point fails where the sum that it begins with says so, whatever comes in between.
class SumsInChains : public FakeWork {
 public:
  SumsInChains() : FakeWork(3 * places, places) {}
  StudyOutcome run(std::uint64_t point, const std::string& state_before) override {
    StudyOutcome outcome = FakeWork::run(point, state_before);
    if (static_cast<int>(outcome.values[0]) % 5 != 4) return outcome;
    return {.exit_code = 4, .error = "numerical", .message = "the sum is bad", .start = outcome.start};
  }
};

std::vector<std::filesystem::path> sorted_segments(const ScratchFolder& folder) {
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    if (entry.path().extension() == ".rows") found.push_back(entry.path());
  }
  std::ranges::sort(found);
  return found;
}

RowScan scan_of(const StudyWork& work, const std::vector<std::filesystem::path>& segments) {
  RowScan scan(work, fake_layout(work));
  scan.read(
      segments, [](const SegmentReader&) { return true; }, [](const auto&, std::size_t) {});
  return scan;
}

/// Runs what is open, as the engine does, into the segment of this number; points of `late` take too long, and after
/// `most` rows it is killed.
void go_on(StudyWork& work, const ScratchFolder& folder, int number, bool retry, const std::set<std::uint64_t>& late,
           int most = 1000) {
  RowScan scan = scan_of(work, sorted_segments(folder));
  Schedule schedule(work, scan, {.retry_failed = retry});
  std::string text = SegmentHeader{"s", "p", "a", {}, "h", "now"}.text();
  for (StudyTask task; most > 0 && schedule.next(task);) {
    for (; task.first < task.end && most > 0; ++task.first, --most) {
      const std::uint64_t point = work.unit_point(task.unit, task.first);
      const StudyOutcome outcome = late.contains(point)
                                       ? StudyOutcome{.exit_code = 4, .error = "timeout", .message = "it took long"}
                                       : work.run(point, task.state);
      append_point(text, point, work.hash(point), outcome, fake_layout(work), scan.running_origin(point));
      scan.note(point, outcome);
      task.state = outcome.state;
    }
  }
  folder.write(std::to_string(100 + number) + ".rows", text);
}

/// The table and the reasons of what these segments say.
std::string tables_of(const StudyWork& work, const std::vector<std::filesystem::path>& segments) {
  const ScratchFolder folder;
  const RowScan scan = scan_of(work, segments);
  MergePlan plan;
  plan.points = work.points();
  plan.layout = fake_layout(work);
  plan.keys = {{"start", "", true}};
  plan.start_cell = 0;
  plan.cells = [](std::uint64_t, std::vector<std::string>& cells) { cells = {""}; };
  plan.wanted = [&](const SegmentRow& row) { return scan.counts(row); };
  merge_rows(folder.path(), segments, plan, [](const auto&, std::size_t) {});
  return folder.read("study.csv") + folder.read("failures.jsonl");
}

TEST(RowScan, DisturbedChainsHaveTheTableOfUndisturbedOnesInTheEnd) {
  SumsInChains work;
  const ScratchFolder calm;
  go_on(work, calm, 0, false, {});
  const std::string table = tables_of(work, sorted_segments(calm));
  ASSERT_NE(std::string::npos, table.find("numerical"));  // points that fail whatever happens
  ASSERT_NE(std::string::npos, table.find("warm"));
  std::mt19937 chance(7);
  for (int history = 0; history < 12; ++history) {
    const ScratchFolder here, elsewhere;
    for (int call = 0; call < 6; ++call) {
      std::set<std::uint64_t> late;
      while (chance() % 3 != 0) late.insert(chance() % work.points());
      go_on(work, chance() % 2 == 0 ? here : elsewhere, call, chance() % 2 == 0, late, static_cast<int>(chance() % 25));
    }
    for (int call = 6; call < 10; ++call) {
      go_on(work, here, call, true, {}, static_cast<int>(1 + chance() % 10));
    }
    go_on(work, here, 10, true, {});
    std::vector<std::filesystem::path> all = sorted_segments(here);
    ASSERT_EQ(table, tables_of(work, all)) << history;
    std::ranges::copy(sorted_segments(elsewhere), std::back_inserter(all));
    std::ranges::sort(all, {}, &std::filesystem::path::filename);  // in the order of their making
    ASSERT_EQ(table, tables_of(work, all)) << history;
  }
}

TEST(RowScan, AChainBehindAPointThatFailedIsNotDoneOnceThePointIsGood) {
  FakeWork work(places, places);
  const ScratchFolder folder;
  go_on(work, folder, 0, false, {2});
  EXPECT_EQ(places, scan_of(work, sorted_segments(folder)).done().count());
  go_on(work, folder, 1, true, {}, 2);
  const RowScan scan = scan_of(work, sorted_segments(folder));
  EXPECT_EQ(4u, scan.done().count());
  EXPECT_EQ(0u, scan.failed().count());
  EXPECT_EQ("7", scan.state_before(0, 4));  // 0.25 + 1.25 + 2.25 + 3.25
  go_on(work, folder, 2, false, {});
  EXPECT_EQ(places, scan_of(work, sorted_segments(folder)).done().count());
}

}  // namespace
}  // namespace freeplay
