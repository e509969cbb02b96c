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

// Neither is to be seen at 4096 instants of 200 s.
TEST(MotionPeriod, OfShortPulsesIsThatOfWhatTheyAreMadeOf) {
  EXPECT_NEAR(period_of("kind: velocity, value: 'max(0, sin(2*pi*50*t) - 0.999)'", 200.0).value(), 0.02, 1e-9);
  EXPECT_NEAR(period_of("kind: velocity, value: 'max(0, sin(2*pi*97*t)*sin(2*pi*t) - 0.995)'", 200.0).value(), 0.5,
              1e-9);
  EXPECT_NEAR(period_of("kind: velocity, value: 'abs(sin(2*pi*50*t)) + 0.01*sin(2*pi*0.05*t)'", 200.0).value(), 20.0,
              1e-6);
}

TEST(MotionPeriod, OfWhatIsConstantButForInstantsIsThatOfAConstant) {
  EXPECT_FALSE(period_of("kind: torque, value: 'abs(sign(sin(1e5*t)))'"));
  EXPECT_NEAR(period_of("kind: velocity, value: '10*abs(sign(sin(50*t)))'").value(), 0.2 * M_PI, 1e-9);
}

TEST(MotionPeriod, OfARampThatIsOverIsThatOfTheRest) {
  EXPECT_NEAR(period_of("kind: velocity, value: 'smooth(t, 0, 0.1)*sin(2*pi*t)'").value(), 1.0, 1e-9);
  EXPECT_NEAR(period_of("kind: angle, value: '3*max(t, 0.1) + sin(2*pi*t)'").value(), 1.0, 1e-9);
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
  EXPECT_FALSE(period_of("kind: velocity, value: 'max(0, sin(2*pi*50*t) - 0.999) + 1e-3*exp(-t)'", 200.0));
  EXPECT_FALSE(period_of("kind: velocity, value: 'sin(t) + sin(sqrt(2)*t)'", 200.0)) << "two that never agree";
  EXPECT_FALSE(period_of("kind: torque, value: 3"));
  EXPECT_FALSE(period_of("kind: angle, value: sin(t)", 2.0)) << "longer than what was looked at";
}

}  // namespace
}  // namespace freeplay
