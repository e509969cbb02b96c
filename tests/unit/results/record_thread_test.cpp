#include "results/record_thread.h"

#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>

namespace freeplay {
namespace {

using testing::ElementsAre;

/// What a file was given, and was told to write.
class Noted : public RecordWriter {
 public:
  void write(const RecordBlock& block) override {
    rows.insert(rows.end(), block.rows.begin(), block.rows.end());
    events.insert(events.end(), block.events.begin(), block.events.end());
  }
  void flush() override {
    if (rows.size() >= room) reason_ = "cannot write 'noted': No space left on device";
    if (reason_.empty() && !rows.empty()) held_ = {static_cast<long>(rows.size() / 2), rows[rows.size() - 2]};
  }
  void sync() override { flush(); }
  void close() override { flush(); }
  void look_after() override {}
  const HeldRows* held() const override { return &held_; }
  const std::string& failure() const override { return reason_; }

  std::vector<double> rows, events;
  std::size_t room = 1 << 20;

 private:
  HeldRows held_;
  std::string reason_;
};

struct Writing {
  RecordThread::Writers two() {
    RecordThread::Writers writers;
    for (Noted*& one : noted) {
      auto made = std::make_unique<Noted>();
      one = made.get();
      writers.push_back(std::move(made));
    }
    noted[1]->room = room;
    return writers;
  }
  std::size_t room;
  Noted* noted[2] = {};
  RecordThread thread{2, two()};
};

void add(RecordThread& thread, double first, int count) {
  constexpr std::size_t both[] = {0, 1};
  for (int i = 0; i < count; ++i) {
    const double row[] = {first + i, 0.5};
    thread.add_row(row, both);
  }
}

TEST(RecordThread, CallsWhenExactlyWhatWasAddedIsSafe) {
  Writing writing{.room = 1 << 20};
  std::vector<std::size_t> rows, events;
  std::vector<long> held;
  const auto note = [&] {
    rows.push_back(writing.noted[0]->rows.size());
    events.push_back(writing.noted[0]->events.size());
    held.push_back(writing.noted[1]->held()->count);
  };
  constexpr double event[] = {0.0, 1.0, 2.0};
  writing.thread.when_safe(note);
  add(writing.thread, 0.0, 3);
  writing.thread.add_event(event);
  writing.thread.when_safe(note);
  add(writing.thread, 3.0, 50000);
  writing.thread.when_safe(note);
  writing.thread.add_event(event);
  add(writing.thread, 50003.0, 1);
  EXPECT_EQ("", writing.thread.close());
  EXPECT_THAT(rows, ElementsAre(0, 6, 100006));
  EXPECT_THAT(events, ElementsAre(0, 3, 3));
  EXPECT_THAT(held, ElementsAre(0, 3, 50003));
  EXPECT_EQ(100008, writing.noted[0]->rows.size());
  EXPECT_EQ(50004, writing.thread.held().count);
}

TEST(RecordThread, CountsTheRowsOfTheFileThatHoldsLeast) {
  Writing writing{.room = 100};
  int asked = 0;
  add(writing.thread, 0.0, 7);
  writing.thread.when_safe([&] { ++asked; });
  add(writing.thread, 7.0, 93);
  writing.thread.when_safe([&] { ++asked; });
  EXPECT_EQ("cannot write 'noted': No space left on device", writing.thread.close());
  EXPECT_EQ(1, asked);
  EXPECT_EQ(100, writing.noted[0]->held()->count);
  EXPECT_EQ(7, writing.thread.held().count);
  EXPECT_EQ(6.0, writing.thread.held().last_time);
}

}  // namespace
}  // namespace freeplay
