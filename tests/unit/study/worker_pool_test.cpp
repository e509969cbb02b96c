#include "workers/worker_pool.h"

#include <chrono>
#include <csignal>
#include <fstream>
#include <map>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <unistd.h>

#include "base/error.h"
#include "study/engine.h"
#include "study/row_scan.h"
#include "study/schedule.h"
#include "study/segment_writer.h"
#include "unit/scratch_folder.h"
#include "unit/study/fake_work.h"

namespace freeplay {
namespace {

struct Found {
  std::map<std::uint64_t, StudyOutcome> outcomes;
  std::uint64_t lost = 0;
};

/// All points of `work` by `options`, each of which is to come once.
Found run_all(FakeWork& work, const PoolOptions& options) {
  Found found;
  WorkerPool pool(work, options);
  std::uint64_t unit = 0;
  pool.run(
      [&](StudyTask& task) {
        if (unit == work.units()) return false;
        task = {unit, 0, work.unit_size(unit)};
        ++unit;
        return true;
      },
      [&](std::uint64_t point, const StudyOutcome& outcome) {
        EXPECT_TRUE(found.outcomes.emplace(point, outcome).second) << point;
      },
      [] { return true; });
  found.lost = pool.lost();
  EXPECT_EQ(work.points(), found.outcomes.size());
  return found;
}

TEST(WorkerPool, EveryPointRunsOnceWithAnyNumberOfWorkers) {
  for (const int jobs : {1, 2, 3, 8}) {
    FakeWork work(500);
    const Found found = run_all(work, {.jobs = jobs});
    for (const auto& [point, outcome] : found.outcomes) {
      EXPECT_EQ(static_cast<double>(point) + 0.25, outcome.values.at(0));
    }
    EXPECT_EQ(0u, found.lost);
  }
}

TEST(WorkerPool, ACallerThatIsBusyTakesTurnsAndForksNothing) {
  FakeWork work(300);
  WorkerPool pool(work, {.jobs = 3});
  std::map<std::uint64_t, StudyOutcome> found;
  std::uint64_t unit = 0;
  const auto next = [&](StudyTask& task) {
    if (unit == work.units()) return false;
    task = {unit, 0, 1};
    ++unit;
    return true;
  };
  const auto take = [&](std::uint64_t point, const StudyOutcome& outcome) {
    EXPECT_TRUE(found.emplace(point, outcome).second) << point;
  };
  pool.turn(next, take);
  EXPECT_EQ(0u, unit);  // no worker is there
  pool.start(1);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (found.size() < 100 && std::chrono::steady_clock::now() < deadline) {
    pool.turn(next, take);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_GE(found.size(), 100u);
  pool.run(next, take, [] { return true; });
  EXPECT_EQ(300u, found.size());
}

TEST(WorkerPool, ChainsHandTheirStateOn) {
  for (const bool isolate : {false, true}) {
    FakeWork work(12, 4);
    const Found found = run_all(work, {.jobs = 2, .isolate = isolate});
    EXPECT_EQ(0.25 + 1.25 + 2.25 + 3.25, found.outcomes.at(3).values[0]);
    EXPECT_EQ("cold", found.outcomes.at(4).start);
    EXPECT_EQ("warm", found.outcomes.at(5).start);
  }
}

TEST(WorkerPool, CrashCostsOnePoint) {
  FakeWork work(200);
  work.before([](std::uint64_t point) {
    if (point == 17) std::raise(SIGSEGV);
    if (point == 90) std::raise(SIGABRT);
    if (point == 91) std::_Exit(3);
  });
  const Found found = run_all(work, {.jobs = 2});
  const std::map<std::uint64_t, std::string> errors = {
      {17, "crash-SIGSEGV"}, {90, "crash-SIGABRT"}, {91, "crash-exit"}};
  for (const auto& [point, outcome] : found.outcomes) {
    const auto error = errors.find(point);
    EXPECT_EQ(error == errors.end() ? "" : error->second, outcome.error) << point;
    EXPECT_EQ(error == errors.end() ? 0 : 5, outcome.exit_code) << point;
  }
  EXPECT_EQ("code of a plugin ended its process, with exit code 3", found.outcomes.at(91).message);
  EXPECT_EQ(3u, found.lost);
}

TEST(WorkerPool, ChainGoesOnColdAfterACrash) {
  FakeWork work(4, 4);
  work.before([](std::uint64_t point) {
    if (point == 1) std::raise(SIGSEGV);
  });
  const Found found = run_all(work, {.jobs = 1});
  EXPECT_EQ("crash-SIGSEGV", found.outcomes.at(1).error);
  EXPECT_EQ("cold", found.outcomes.at(2).start);
  EXPECT_EQ(2.25 + 3.25, found.outcomes.at(3).values[0]);
}

TEST(WorkerPool, KilledWorkerIsTriedOnceMore) {
  const ScratchFolder folder;
  const std::string mark = folder.file("mark").string();
  FakeWork work(50);
  work.before([&](std::uint64_t point) {
    if (point == 30) ::kill(::getpid(), SIGKILL);
    if (point == 7 && ::access(mark.c_str(), F_OK) != 0) {
      std::ofstream(mark) << 1;
      ::kill(::getpid(), SIGKILL);
    }
  });
  const Found found = run_all(work, {.jobs = 2});
  EXPECT_EQ("", found.outcomes.at(7).error);
  EXPECT_EQ("killed", found.outcomes.at(30).error);
  EXPECT_EQ(1, found.outcomes.at(30).exit_code);
  EXPECT_EQ(3u, found.lost);
}

TEST(WorkerPool, WorkersThatDieAtOnceDoNotEndTheProgram) {
  std::signal(SIGPIPE, SIG_DFL);
  FakeWork work(400);
  work.before([](std::uint64_t) { std::raise(SIGABRT); });
  const Found found = run_all(work, {.jobs = 2});
  for (const auto& [point, outcome] : found.outcomes) EXPECT_EQ("crash-SIGABRT", outcome.error) << point;
  EXPECT_EQ(400u, found.lost);
}

TEST(WorkerPool, PointThatTakesTooLongIsGivenUp) {
  FakeWork work(20);
  work.before([](std::uint64_t point) {
    if (point == 5) std::this_thread::sleep_for(std::chrono::hours(1));
  });
  const Found found = run_all(work, {.jobs = 2, .point_timeout = 0.3});
  EXPECT_EQ("timeout", found.outcomes.at(5).error);
  EXPECT_EQ(4, found.outcomes.at(5).exit_code);
  EXPECT_EQ(0, found.outcomes.at(6).exit_code);
}

TEST(WorkerPool, IsolatedPointsShareNoVariables) {
  FakeWork work(30);
  static int seen = 0;
  work.before([](std::uint64_t) {
    if (++seen > 1) std::raise(SIGSEGV);
  });
  const Found found = run_all(work, {.jobs = 3, .isolate = true});
  for (const auto& [point, outcome] : found.outcomes) EXPECT_EQ(0, outcome.exit_code) << point;
}

TEST(WorkerPool, LargeOutcomesPassThroughThePipe) {
  class Large : public FakeWork {
   public:
    Large() : FakeWork(40, 10) {}
    StudyOutcome run(std::uint64_t point, const std::string& state) override {
      StudyOutcome outcome;
      outcome.state = std::string(300'000, static_cast<char>('a' + point % 26));
      outcome.values = {state.empty() ? 0.0 : static_cast<double>(state.front())};
      return outcome;
    }
  } work;
  const Found found = run_all(work, {.jobs = 3});
  EXPECT_EQ(static_cast<double>('a' + 10), found.outcomes.at(11).values[0]);
}

/// The folder with rows of what `work` gives, after `beats` looks at most; -1: all.
std::uint64_t run_engine(FakeWork& work, const std::filesystem::path& folder, std::uint64_t most_rows,
                         ScheduleOptions options = {}) {
  RowScan scan(work, fake_layout(work));
  std::vector<std::filesystem::path> segments;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) segments.push_back(entry.path());
  scan.read(
      segments, [](const SegmentReader&) { return true; }, [](const auto&, std::size_t) {});
  Schedule schedule(work, scan, options);
  SegmentWriter writer(folder, {"s", "p", "a", options.shard, "h", "now"}, 1.0);
  const EngineReport report = run_points(work, fake_layout(work), schedule, scan, writer, {.jobs = 2}, {},
                                         [&](const EngineReport& so_far) { return so_far.ran < most_rows; });
  return report.ran;
}

TEST(Engine, GoesOnWhereItWasInterrupted) {
  for (const std::uint64_t length : {1u, 25u}) {
    const ScratchFolder folder;
    FakeWork work(100, length);
    work.before([](std::uint64_t) { std::this_thread::sleep_for(std::chrono::microseconds(300)); });
    std::uint64_t ran = 0;
    int calls = 0;
    for (; ran < 100 && calls < 100; ++calls) ran += run_engine(work, folder.path(), 10);
    EXPECT_EQ(100u, ran);
    EXPECT_GT(calls, 1);
    EXPECT_EQ(0u, run_engine(work, folder.path(), 10));
  }
}

TEST(Engine, ShardsRunEveryPointOnce) {
  const ScratchFolder folder;
  FakeWork work(25);
  std::uint64_t ran = 0;
  for (std::uint64_t part = 1; part <= 3; ++part) ran += run_engine(work, folder.path(), 1000, {.shard = {part, 3}});
  EXPECT_EQ(25u, ran);
  for (std::uint64_t part = 1; part <= 2; ++part) {
    EXPECT_EQ(0u, run_engine(work, folder.path(), 1000, {.shard = {part, 2}}));
  }
}

TEST(Engine, RunsOnlyWhatIsNamedAndAChainUpToIt) {
  const ScratchFolder folder, chains;
  FakeWork work(25), chain(24, 8);
  EXPECT_EQ(4u, run_engine(work, folder.path(), 1000, {.only = point_ranges("--only", "3,7-9", 25)}));
  EXPECT_EQ(3u, run_engine(chain, chains.path(), 1000, {.only = point_ranges("--only", "10", 24)}));
}

TEST(Engine, FailedPointsRunAgainOnDemandAndKilledOnesAlways) {
  const ScratchFolder folder;
  FakeWork work(10);
  work.before([](std::uint64_t point) {
    if (point == 2) std::raise(SIGSEGV);
    if (point == 5) std::raise(SIGKILL);
  });
  EXPECT_EQ(10u, run_engine(work, folder.path(), 1000));
  work.before({});
  EXPECT_EQ(1u, run_engine(work, folder.path(), 1000));
  EXPECT_EQ(1u, run_engine(work, folder.path(), 1000, {.retry_failed = true}));
  EXPECT_EQ(0u, run_engine(work, folder.path(), 1000, {.retry_failed = true}));
}

TEST(Schedule, RangesAreChecked) {
  EXPECT_EQ((PointRanges{{0, 9}, {12, 12}}), point_ranges("--only", "12,0-5,6-9", 13));
  for (const char* text : {"", "a", "3-", "5-2", "1,,2", "13", "0-13", "1;2"}) {
    EXPECT_THROW(point_ranges("--only", text, 13), Error) << text;
  }
}

}  // namespace
}  // namespace freeplay
