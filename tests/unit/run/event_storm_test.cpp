#include "run/event_storm.h"

#include <cmath>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

constexpr double end = 2.0;
constexpr EventStorm::Limits limits{1e-14 * end, 1e-5 * end, 8};

TEST(EventStorm, IsAThousandEventsAtOneInstant) {
  EventStorm storm(2, limits);
  double time = 0.7;
  for (long i = 0; i < 1000; ++i, time = std::nextafter(time, end)) {
    if (i > 100) time = std::min(time, 0.7 + 1e-14);
    ASSERT_EQ(storm.note(1, time, i).events, 0);
    if (i % 2 == 0) {
      ASSERT_EQ(storm.note(0, 0.001 * static_cast<double>(i), i).events, 0);
    }
  }
  const EventStorm::Finding found = storm.note(1, time, 1000);
  EXPECT_EQ(found.events, 1001);
  EXPECT_LE(found.within, limits.instant);
}

TEST(EventStorm, IsTwentyThousandEventsWithinAStepSize) {
  EventStorm storm(1, limits);
  long events = 0;
  while (storm.note(0, 0.5 + 1e-10 * static_cast<double>(events), events).events == 0) ++events;
  EXPECT_EQ(events, 20000);
}

TEST(EventStorm, IsAHundredStepsFullOfEvents) {
  EventStorm storm(1, {1e-15, 0.0, 8});
  long step = 0;
  const auto full = [&] {
    EventStorm::Finding found;
    for (int i = 0; i < 8; ++i) found = storm.note(0, 1e-6 * static_cast<double>(step), step);
    ++step;
    return found;
  };
  for (int i = 0; i < 100; ++i) ASSERT_EQ(full().events, 0);
  ++step;  // one without events
  for (int i = 0; i < 100; ++i) ASSERT_EQ(full().events, 0);
  EXPECT_EQ(full().events, 800);
}

// A ball whose impacts last 1e-7 s and leave it nine tenths of its speed: the flights shrink below the impacts.
TEST(EventStorm, IsNoneWhereABallComesToRest) {
  EventStorm storm(1, limits);
  double time = 0.0, flight = 0.1;
  for (long i = 0; i < 2000; ++i) {
    ASSERT_EQ(storm.note(0, time, 2 * i).events, 0);
    ASSERT_EQ(storm.note(0, time += 1e-7, 2 * i + 1).events, 0);
    time += flight *= 0.9;
  }
}

}  // namespace
}  // namespace freeplay
