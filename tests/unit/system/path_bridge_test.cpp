#include "system/path_bridge.h"

#include <cmath>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

void expect_near(const Jet& expected, const Jet& found, double by) {
  EXPECT_NEAR(expected.value, found.value, by);
  EXPECT_NEAR(expected.rate, found.rate, by);
  EXPECT_NEAR(expected.acceleration, found.acceleration, by);
}

/// 1 - 2 t + t^2/2 + 3 t^3 - t^4 + t^5/4
Jet polynomial(double t) {
  return {1.0 + t * (-2.0 + t * (0.5 + t * (3.0 + t * (-1.0 + t * 0.25)))),
          -2.0 + t * (1.0 + t * (9.0 + t * (-4.0 + t * 1.25))), 1.0 + t * (18.0 + t * (-12.0 + t * 5.0))};
}

TEST(Quintic, IsThePolynomialOfTheFifthDegreeThatBothEndsHave) {
  const double from = 0.3, length = 1.4;
  const Jet a = polynomial(from), b = polynomial(from + length);
  for (const double s : {-0.2, 0.0, 0.13, 0.5, 0.87, 1.0, 1.2}) {
    expect_near(polynomial(from + s * length), quintic(a, b, length, s), 1e-12);
  }
}

/// A frame that goes along x and turns about a skew axis, at speeds that change.
PathPose pose_at(double t) {
  const double axis[] = {2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0};
  const Jet half{0.5 * (3.0 * t + 0.4 * t * t), 0.5 * (3.0 + 0.8 * t), 0.4};
  const Jet c = cos(half), s = sin(half);
  PathPose pose;
  pose[0] = polynomial(t);
  pose.turning = turning_of({c, s * Jet::constant(axis[0]), s * Jet::constant(axis[1]), s * Jet::constant(axis[2])});
  return pose;
}
PathBridge::End end_at(double t) { return {.t = t, .drivers = {polynomial(t)}, .frames = {pose_at(t)}}; }

TEST(PathBridge, CoversWhatIsBetweenItsEnds) {
  const PathBridge bridge(end_at(0.2), end_at(0.5));
  EXPECT_TRUE(bridge.covers(0.3));
  EXPECT_FALSE(bridge.covers(0.2) || bridge.covers(0.5));
  EXPECT_TRUE(bridge.touches(0.2) && bridge.touches(0.5));
  EXPECT_FALSE(bridge.touches(0.1) || bridge.touches(0.6));
  expect_near(polynomial(0.41), bridge.driver(0, 0.41), 1e-12);
}

/// By which the turning of the frame is off in any of its numbers.
double error_of(const PathBridge& bridge, double t) {
  const PathPose expected = pose_at(t);
  PathPose found;
  bridge.frame(0, t, true, found);
  expect_near(expected[0], found[0], 1e-10);
  double largest = 0.0;
  const auto compare = [&](const auto& one, const auto& other) {
    for (std::size_t i = 0; i < one.size(); ++i) largest = std::max(largest, std::abs(one[i] - other[i]));
  };
  compare(expected.turning.rotation, found.turning.rotation);
  compare(expected.turning.velocity, found.turning.velocity);
  compare(expected.turning.acceleration, found.turning.acceleration);
  return largest;
}

// Of a quintic, with the distance of its ends: values by the sixth, accelerations by the fourth power.
TEST(PathBridge, TurnsOfFramesComeCloseByTheFourthOrder) {
  const auto largest_error = [](double begin, double length) {
    const PathBridge bridge(end_at(begin), end_at(begin + length));
    EXPECT_LT(error_of(bridge, begin), 1e-11);
    EXPECT_LT(error_of(bridge, begin + length), 1e-11);
    double largest = 0.0;
    for (int i = 1; i < 20; ++i) largest = std::max(largest, error_of(bridge, begin + 0.05 * i * length));
    return largest;
  };
  // The second passes two thirds of a turn, where the quaternion that is found of a rotation changes its sign.
  for (const double begin : {0.1, 1.15}) {
    const double far = largest_error(begin, 0.2), near = largest_error(begin, 0.1);
    EXPECT_LT(far, 1e-2);
    EXPECT_NEAR(4.0, std::log2(far / near), 0.5);
  }
}

}  // namespace
}  // namespace freeplay
