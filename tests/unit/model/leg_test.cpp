#include "model/leg.h"

#include <array>
#include <cmath>

#include "validation/run_model.h"

namespace freeplay {
namespace {

using test::load;
using test::mechanism;
using test::replaced;

Leg sample_leg(int elbow) {
  Leg leg;
  leg.name = "sample";
  leg.ax = -0.3;
  leg.ay = 0.1;
  leg.crank = 0.24;
  leg.coupler = 0.31;
  leg.cx = 0.05;
  leg.cy = -0.08;
  leg.crank_direction = 0.4;
  leg.coupler_direction = -0.7;
  leg.elbow = elbow;
  return leg;
}

/// A path that turns and moves: value and exact derivatives.
struct Path {
  Jet x, y, angle;
};
Path path_at(double t) {
  const double c = std::cos(3.0 * t), s = std::sin(3.0 * t);
  return {
      {0.1 * c, -0.3 * s, -0.9 * c}, {0.05 + 0.1 * s, 0.3 * c, -0.9 * s}, {0.2 * t + 0.1 * t * t, 0.2 + 0.2 * t, 0.2}};
}
LegPose pose_at(const Leg& leg, double t) {
  const Path p = path_at(t);
  return solve_leg(leg, p.x, p.y, p.angle);
}

// B is where two circles meet, on the left of the line from A to C for elbow 1.
TEST(Leg, EqualsTheIntersectionOfTwoCircles) {
  for (const int elbow : {1, -1}) {
    const Leg leg = sample_leg(elbow);
    for (const double t : {0.0, 0.3, 0.9, 1.7}) {
      const Path p = path_at(t);
      const LegPose pose = pose_at(leg, t);
      ASSERT_TRUE(pose.reachable);
      const double c = std::cos(p.angle.value), s = std::sin(p.angle.value);
      const double cx = p.x.value + c * leg.cx - s * leg.cy, cy = p.y.value + s * leg.cx + c * leg.cy;
      const double dx = cx - leg.ax, dy = cy - leg.ay, distance = std::hypot(dx, dy);
      EXPECT_NEAR(pose.distance, distance, 1e-15);
      const double along = (distance * distance + leg.crank * leg.crank - leg.coupler * leg.coupler) / (2.0 * distance);
      const double across = elbow * std::sqrt(leg.crank * leg.crank - along * along);
      const double bx = leg.ax + (along * dx - across * dy) / distance;
      const double by = leg.ay + (along * dy + across * dx) / distance;
      const double crank = pose.crank.value + leg.crank_direction, coupler = pose.coupler.value + leg.coupler_direction;
      EXPECT_NEAR(leg.ax + leg.crank * std::cos(crank), bx, 1e-14);
      EXPECT_NEAR(leg.ay + leg.crank * std::sin(crank), by, 1e-14);
      EXPECT_NEAR(bx + leg.coupler * std::cos(coupler), cx, 1e-14);
      EXPECT_NEAR(by + leg.coupler * std::sin(coupler), cy, 1e-14);
    }
  }
}

// Differences of fourth order over 1e-3 s: (1e-3)^4 times derivatives of up to 1e4, and rounding of 1e-13.
TEST(Leg, DerivativesAreThoseOfThePose) {
  constexpr double h = 1e-3;
  for (const int elbow : {1, -1}) {
    const Leg leg = sample_leg(elbow);
    for (const double t : {0.1, 0.8, 1.5}) {
      std::array<LegPose, 5> near;
      for (int i = -2; i <= 2; ++i) near[static_cast<std::size_t>(i + 2)] = pose_at(leg, t + i * h);
      for (const auto member : std::initializer_list<Jet LegPose::*>{&LegPose::crank, &LegPose::coupler}) {
        const auto slope = [&](auto value) {
          return (8.0 * (value(3) - value(1)) - (value(4) - value(0))) / (12.0 * h);
        };
        const double rate = slope([&](std::size_t i) { return (near[i].*member).value; });
        const double second = slope([&](std::size_t i) { return (near[i].*member).rate; });
        EXPECT_NEAR((near[2].*member).rate, rate, 1e-8);
        EXPECT_NEAR((near[2].*member).acceleration, second, 1e-7);
      }
    }
  }
}

TEST(Leg, SaysWhenItCannotReach) {
  const Leg leg = sample_leg(1);
  const auto at = [&](double x) {
    return solve_leg(leg, Jet::constant(x - leg.cx), Jet::constant(leg.ay - leg.cy), Jet::constant(0.0)).reachable;
  };
  EXPECT_TRUE(at(leg.ax + 0.5499));
  EXPECT_FALSE(at(leg.ax + 0.5501));  // crank and coupler reach 0.55
  EXPECT_TRUE(at(leg.ax + 0.0701));
  EXPECT_FALSE(at(leg.ax + 0.0699));
}

TEST(FindLeg, ReadsTheLegsOfAParallelMechanism) {
  const auto model = load(mechanism("3-rrr"));
  ASSERT_EQ(model->drivers.size(), 3u);
  for (int i = 0; i < 3; ++i) {
    const auto leg = find_leg(*model, model->drivers[static_cast<std::size_t>(i)].joint, model->kinematics[0].marker);
    ASSERT_TRUE(leg);
    const double at = 7.0 * M_PI / 6.0 + 2.0 * M_PI * i / 3.0;
    EXPECT_NEAR(leg->ax, 0.4 * std::cos(at), 1e-15);
    EXPECT_NEAR(leg->ay, 0.4 * std::sin(at), 1e-15);
    EXPECT_NEAR(leg->cx, 0.11 * std::cos(at), 1e-15);
    EXPECT_DOUBLE_EQ(leg->crank, 0.24);
    EXPECT_DOUBLE_EQ(leg->coupler, 0.24);
    EXPECT_EQ(leg->crank_direction, 0.0);
  }
}

TEST(FindLeg, FindsNoneInAChainOfAnotherShape) {
  // The frame is on the coupler itself: there is no platform behind a second pin.
  const auto model = load(mechanism("four-bar"));
  int on_coupler = -1, on_rocker = -1;
  for (int m = 0; m < static_cast<int>(model->markers.size()); ++m) {
    if (model->markers[static_cast<std::size_t>(m)].name == "coupler/tip") on_coupler = m;
    if (model->markers[static_cast<std::size_t>(m)].name == "rocker/tip") on_rocker = m;
  }
  ASSERT_GE(on_coupler, 0);
  ASSERT_GE(on_rocker, 0);
  EXPECT_FALSE(find_leg(*model, 0, on_coupler));
  EXPECT_TRUE(find_leg(*model, 0, on_rocker));   // crank, coupler, and the rocker as platform
  EXPECT_FALSE(find_leg(*model, 1, on_rocker));  // the driven pin does not stand on the ground
}

}  // namespace
}  // namespace freeplay
