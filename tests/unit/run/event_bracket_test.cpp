#include "run/event_bracket.h"

#include <cmath>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

StepEvents::Passage ended_at(double value, int event = 0) { return {.joint = 0, .event = event, .value = value}; }

TEST(EventBracket, KnowsNoLengthWhileAllStepsEndedOnOneSide) {
  EventBracket bracket;
  EXPECT_FALSE(bracket.inside(0.0));
  for (const double dt : {1.0, 2.0, 1.5}) bracket.note(ended_at(-0.1), dt);
  EXPECT_FALSE(bracket.inside(0.0));
}

TEST(EventBracket, FindsAZeroToWhichNewtonsStepsDoNotCome) {
  // The sign of the root of |x - 1|: Newton's step from one side of it leads as far to the other.
  const auto value = [](double dt) { return std::copysign(std::sqrt(std::abs(dt - 1.0)), dt - 1.0); };
  EventBracket bracket;
  bracket.note(ended_at(value(0.3)), 0.3);
  bracket.note(ended_at(value(1.4)), 1.4);
  double dt = 0.0;
  for (int i = 0; i < 20; ++i) {
    dt = *bracket.inside(1e-6);
    bracket.note(ended_at(value(dt)), dt);
  }
  EXPECT_NEAR(dt, 1.0, 1e-6);
}

TEST(EventBracket, IsOfOneEvent) {
  EventBracket bracket;
  bracket.note(ended_at(-1.0, 0), 1.0);
  bracket.note(ended_at(1.0, 1), 2.0);
  EXPECT_FALSE(bracket.inside(0.0));
}

}  // namespace
}  // namespace freeplay
