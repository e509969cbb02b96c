// RecordThread: rows, events and requests of the thread that runs reach the thread that writes whole and in order.
#include "results/record_thread.h"

#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

constexpr std::size_t width = 3;

/// Keeps what it is given; fails from a number of rows on.
class Keeper final : public RecordWriter {
 public:
  struct Kept {
    std::vector<double> rows, events;
    int syncs = 0;
    bool closed = false;
  };
  explicit Keeper(Kept& kept, std::size_t most = 1 << 30) : kept_(kept), most_(most) {}
  void write(const RecordBlock& block) override {
    kept_.rows.insert(kept_.rows.end(), block.rows.begin(), block.rows.end());
    held_.count = static_cast<long>(kept_.rows.size() / width);
    if (!kept_.rows.empty()) held_.last_time = kept_.rows[kept_.rows.size() - width];
    kept_.events.insert(kept_.events.end(), block.events.begin(), block.events.end());
    if (kept_.rows.size() > width * most_) failure_ = "cannot write 'rows': full";
  }
  void flush() override {}
  void sync() override { ++kept_.syncs; }
  void close() override { kept_.closed = true; }
  void look_after() override {}
  const HeldRows* held() const override { return &held_; }
  const std::string& failure() const override { return failure_; }

 private:
  Kept& kept_;
  std::size_t most_;
  HeldRows held_;
  std::string failure_;
};

RecordThread::Writers keeper_of(Keeper::Kept& kept, std::size_t most = 1 << 30) {
  RecordThread::Writers writers;
  writers.push_back(std::make_unique<Keeper>(kept, most));
  return writers;
}

void add(RecordThread& thread, int row) {
  const std::array<double, 4> values{1.0 * row, -1.0, 2.0 * row, 3.0 * row};
  const std::array<std::size_t, width> picked{0, 2, 3};
  thread.add_row(values, picked);
}

TEST(RecordThread, RowsAndEventsArriveInTheirOrder) {
  constexpr int rows = 100000;
  Keeper::Kept kept;
  RecordThread thread(width, keeper_of(kept));
  for (int row = 0; row < rows; ++row) {
    add(thread, row);
    if (row % 100 == 0) thread.add_event(std::array<double, 1>{1.0 * row});
  }
  EXPECT_EQ(thread.close(), "");
  EXPECT_TRUE(kept.closed);
  EXPECT_EQ(thread.held().count, rows);
  EXPECT_EQ(thread.held().last_time, rows - 1.0);
  ASSERT_EQ(kept.rows.size(), width * rows);
  ASSERT_EQ(kept.events.size(), rows / 100);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t c = 0; c < width; ++c) {
      ASSERT_EQ(kept.rows[width * row + c], static_cast<double>((c + 1) * row));
    }
  }
  for (std::size_t i = 0; i < kept.events.size(); ++i) ASSERT_EQ(kept.events[i], 100.0 * static_cast<double>(i));
}

TEST(RecordThread, WhatIsAskedForIsDoneOnceAllThatWasAddedBeforeIsSafe) {
  Keeper::Kept kept;
  std::vector<std::size_t> safe;  // rows, by request
  RecordThread thread(width, keeper_of(kept));
  for (int request = 1; request <= 3; ++request) {
    for (int row = 0; row < 10; ++row) add(thread, row);
    thread.when_safe([&] { safe.push_back(kept.syncs > 0 ? kept.rows.size() / width : 0); });
  }
  EXPECT_EQ(thread.close(), "");
  ASSERT_EQ(safe.size(), 3u);
  for (std::size_t request = 0; request < 3; ++request) EXPECT_GE(safe[request], 10 * (request + 1));
}

TEST(RecordThread, AFailureOfAWriterIsSeenAndNothingIsCalledAfterIt) {
  Keeper::Kept kept;
  bool called = false;
  RecordThread thread(width, keeper_of(kept, 5));
  for (int row = 0; thread.ok() && row < 100000000; ++row) add(thread, row);
  EXPECT_FALSE(thread.ok());
  thread.when_safe([&] { called = true; });
  EXPECT_EQ(thread.close(), "cannot write 'rows': full");
  EXPECT_FALSE(called);
}

}  // namespace
}  // namespace freeplay
