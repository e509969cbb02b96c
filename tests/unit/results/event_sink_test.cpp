#include "results/event_sink.h"

#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <gtest/gtest.h>

#include "base/archive.h"
#include "base/sha256.h"
#include "results/contact_advice.h"
#include "results/text_writers.h"
#include "unit/scratch_folder.h"

namespace freeplay {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr const char* header =
    "time,joint,kind,speed,tangential_speed,direction,duration,max_fn,max_delta,steps,approach_speed,impulse,"
    "tangential_impulse,energy_lost,impact,heat\n";

const Channel hit_fields[] = {{"heat", "J"}, {"steps", "1"}, {"duration", "s"}, {"speed", "m/s"}};
const Event events[] = {{"hit", Crossing::rising, 0, Span<const Channel>(hit_fields)},
                        {"turn", Crossing::falling, 0, {}}};

Model two_joints() {
  Model model;
  for (const char* name : {"first", "second"}) {
    JointElement& joint = model.joints.emplace_back();
    joint.name = name;
    joint.layout.events = Span<const Event>(events);
  }
  return model;
}

EventRecord record(double time, int joint, int event, std::span<const double> fields = {}) {
  return {time, joint, event, fields};
}

/// What a sink gives, as text.
class EventFile {
 public:
  explicit EventFile(const Model& model) {
    add_event_columns(model, layout_);
    file_.emplace(folder_.file("events.csv"), layout_);
    sink.emplace(model, layout_, [this](std::span<const double> numbers) {
      file_->write({.rows = {}, .events = {numbers.begin(), numbers.end()}});
    });
  }
  std::string text() {
    sink->finish();
    file_->close();
    EXPECT_EQ(sha256(folder_.read("events.csv")), file_->digits());
    return folder_.read("events.csv");
  }
  const RecordLayout& layout() const { return layout_; }
  std::optional<EventSink> sink;

 private:
  ScratchFolder folder_;
  RecordLayout layout_;
  std::optional<EventTextWriter> file_;
};

TEST(EventSink, FillsColumnsByNameAndAppendsOthers) {
  const Model model = two_joints();
  EventFile file(model);
  EventSink& sink = *file.sink;
  const std::array<double, 4> fields{2.5, 12.0, none, 0.25};
  sink.event(record(1.5, 0, 0, fields));
  sink.event(record(2.0, 1, 1));
  EXPECT_EQ(std::string(header) + "1.5,first,hit,0.25,,,,,,12,,,,,,2.5\n2,second,turn,,,,,,,,,,,,,\n", file.text());
}

TEST(EventSink, SortsByTimeThenJointAcrossRows) {
  const Model model = two_joints();
  EventFile file(model);
  EventSink& sink = *file.sink;
  const double at[] = {2.0};
  sink.event(record(1.75, 1, 1));
  sink.event(record(2.25, 1, 1));  // of a step that crosses the row
  sink.event(record(1.5, 1, 1));
  sink.event(record(1.5, 0, 1));
  sink.row(at);
  sink.event(record(2.125, 0, 1));
  EXPECT_EQ(std::string(header) +
                "1.5,first,turn,,,,,,,,,,,,,\n1.5,second,turn,,,,,,,,,,,,,\n1.75,second,turn,,,,,,,,,,,,,\n"
                "2.125,first,turn,,,,,,,,,,,,,\n2.25,second,turn,,,,,,,,,,,,,\n",
            file.text());
}

TEST(EventSink, WhatWaitsIsSavedAndRestored) {
  const Model model = two_joints();
  EventFile whole(model), second(model);
  const std::array<double, 4> fields{2.5, 12.0, none, 0.25};
  const std::array<double, 1> at{1.0};
  Archive archive;
  {
    EventSink first(model, second.layout(), [](std::span<const double>) {});
    for (EventSink* sink : {&first, &*whole.sink}) {
      sink->event(record(1.5, 1, 1));
      sink->event(record(1.25, 0, 0, fields));
      sink->row(at);
    }
    ArchiveWriter{archive}(first);
  }
  ArchiveReader reader(archive);
  reader(*second.sink);
  reader.finish();
  for (EventSink* sink : {&*second.sink, &*whole.sink}) sink->event(record(1.375, 0, 1));
  EXPECT_EQ(whole.text(), second.text());
}

TEST(ContactAdvice, CountsContactsWithTooFewSteps) {
  Model model = two_joints();
  model.settings.discard = 1.0;
  ContactAdvice advice(model);
  const auto tell = [&](double time, double steps, double duration) {
    const std::array<double, 4> fields{0.0, steps, duration, 0.0};
    advice.event(record(time, 0, 0, fields));
  };
  tell(0.5, 1.0, 1e-6);  // before statistics begin
  tell(1.5, 40.0, 4e-3);
  EXPECT_EQ(0, advice.under_resolved());
  EXPECT_TRUE(std::isnan(advice.step()));
  tell(2.0, 10.0, 1e-3);
  tell(2.5, 15.0, 2e-3);
  EXPECT_EQ(2, advice.under_resolved());
  EXPECT_EQ(10.0, advice.fewest_steps());
  EXPECT_DOUBLE_EQ(5e-5, advice.step());  // 1 ms in 20 steps
}

}  // namespace
}  // namespace freeplay
