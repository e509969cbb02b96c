#include "run/motion_period.h"

#include <cmath>

#include <gtest/gtest.h>

#include "validation/run_model.h"

namespace freeplay {
namespace {

std::optional<double> period_of(const std::string& driver, double longest = 10.0) {
  const auto model = test::load(
      "freeplay: 1\nname: x\nbodies: {a: {mass: 1 kg, inertia: 1}}\n"
      "joints: {A: {type: revolute, between: [ground, a]}}\n"
      "drivers: {m: {joint: A, " +
      driver + "}}\nsimulation: {end: 1 s, step: 1 ms}\n");
  return motion_period(*model, model->drivers[0], 0.1, longest);
}

TEST(MotionPeriod, OfASteadyTurnIsThatOfTheTurn) {
  EXPECT_NEAR(period_of("kind: velocity, value: 10").value(), 0.2 * M_PI, 1e-12);
  EXPECT_NEAR(period_of("kind: angle, value: 1 - 10*t").value(), 0.2 * M_PI, 1e-12);
}

TEST(MotionPeriod, OfAFormulaIsTheLeastAfterWhichItComesAgain) {
  EXPECT_NEAR(period_of("kind: angle, value: sin(2*pi*t/3)").value(), 3.0, 1e-6);
  EXPECT_NEAR(period_of("kind: angle, value: sin(2*pi*t) + 0.5*cos(4*pi*t)").value(), 1.0, 1e-6);
  EXPECT_NEAR(period_of("kind: velocity, value: 5 + sin(2*pi*t)").value(), 1.0, 1e-6);
  EXPECT_NEAR(period_of("kind: torque, value: abs(sin(2*pi*t))").value(), 0.5, 1e-6);
}

TEST(MotionPeriod, OfATableIsThatAtWhichItIsRepeated) {
  const std::string points = "kind: angle, table: {points: [[0, 0], [0.25, 1], [0.5, 0]], interpolation: linear";
  EXPECT_NEAR(period_of(points + ", outside: repeat}").value(), 0.5, 1e-12);
  EXPECT_FALSE(period_of(points + "}"));
}

TEST(MotionPeriod, IsNoneOfAMotionThatDoesNotComeAgain) {
  EXPECT_FALSE(period_of("kind: angle, value: 'smooth(t, 0, 1)'"));
  EXPECT_FALSE(period_of("kind: angle, value: t^2"));
  EXPECT_FALSE(period_of("kind: angle, value: exp(-t)*sin(2*pi*t)"));
  EXPECT_FALSE(period_of("kind: torque, value: 3"));
  EXPECT_FALSE(period_of("kind: angle, value: sin(t)", 2.0)) << "longer than what was looked at";
}

}  // namespace
}  // namespace freeplay
