#include "system/joint_derivatives.h"

#include <cmath>
#include <vector>

#include "validation/run_model.h"

namespace freeplay {
namespace {

/// A marker that turns and moves.
MarkerKinematics marker(double x, double y, double angle, double vx, double vy, double w) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {{x, y, 0.0}, {c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0}, {vx, vy, 0.0}, {0.0, 0.0, w}};
}

// The penetration of 1 mm is wide against a difference of 6e-6 of the clearance of 2 mm.
TEST(DifferenceForces, EqualTheDerivativesThatAJointGivesItself) {
  const auto model = test::load(
      "freeplay: 1\nbodies: {shaft: {mass: 1, inertia: 1}}\njoints:\n  pin: {type: revolute, between: [ground, shaft],"
      " clearance: {bearing_radius: 20 mm, radial_clearance: 2 mm, contact: {law: lankarani-nikravesh, K: 1e6,"
      " restitution: 0.7}, friction: {law: ambrosio, mu: 0.2, v0: 0.01, v1: 1}}}\n");
  const JointElement& joint = model->joints[0];
  const MarkerKinematics a = marker(0.1, 0.2, 0.3, 0.1, -0.05, 4.0);
  const MarkerKinematics b = marker(0.1 + 2.6e-3, 0.2 + 1.5e-3, -0.2, 0.25, 0.1, -3.0);
  std::vector<double> history(static_cast<std::size_t>(joint.layout.history), 0.0);
  history[0] = 1.0;  // in contact
  history[1] = 0.2;  // approach speed
  const JointInput in{0.0, &a, &b, -0.5, -7.0, {}, {history.data(), history.size()}};
  Message message;

  std::vector<double> own(12 * 24, 0.0), differences(12 * 24, 0.0);
  JointForces forces{};
  forces.derivatives = {own.data(), own.size()};
  ASSERT_TRUE(joint.joint.apply(in, forces, message)) << message.text;
  ASSERT_GT(std::hypot(forces.wrench_b[0], forces.wrench_b[1]), 10.0);
  std::vector<double> work(difference_numbers(0, joint.layout.events.size));
  ASSERT_TRUE(difference_forces({joint.joint, joint.layout, 0.3, work}, in, forces, differences, message))
      << message.text;
  double worst = 0.0;
  for (std::size_t block = 0; block < 2; ++block) {  // poses, twists: numbers of different size
    double largest = 0.0, off = 0.0;
    for (std::size_t r = 0; r < 12; ++r) {
      for (std::size_t c = 12 * block; c < 12 * block + 12; ++c) {
        largest = std::max(largest, std::abs(own[r * 24 + c]));
        off = std::max(off, std::abs(own[r * 24 + c] - differences[r * 24 + c]));
      }
    }
    ASSERT_GT(largest, 0.0);
    worst = std::max(worst, off / largest);
  }
  test::record("worst_of_largest", worst);
  EXPECT_LE(worst, 1e-5);
}

// The spherical joint in space, where all six components of each marker count.
TEST(DifferenceForces, EqualTheDerivativesThatAJointGivesItselfInSpace) {
  const auto model = test::load(
      "freeplay: 1\nspace: spatial\nbodies: {ball: {mass: 1, inertia: [1, 1, 1]}}\njoints:\n  socket: {type: spherical,"
      " between: [ground, ball], clearance: {bearing_radius: 20 mm, radial_clearance: 2 mm, contact: {law: flores, K: "
      "1e6,"
      " restitution: 0.7}, friction: {law: ambrosio, mu: 0.2, v0: 0.01, v1: 1}}}\n");
  const JointElement& joint = model->joints[0];
  const MarkerKinematics a{
      {0.1, 0.2, 0.3}, {0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0}, {0.1, 0.2, -0.1}, {1.0, -2.0, 3.0}};
  const MarkerKinematics b{
      {0.1016, 0.2017, 0.2985}, {1.0, 0.0, 0.0, 0.0, 0.8, -0.6, 0.0, 0.6, 0.8}, {0.3, 0.25, -0.3}, {-2.0, 1.0, 0.5}};
  std::vector<double> history(static_cast<std::size_t>(joint.layout.history), 0.0);
  history[0] = 1.0;  // in contact
  history[1] = 0.2;  // approach speed
  const JointInput in{0.0, &a, &b, 0.0, 0.0, {}, {history.data(), history.size()}};
  Message message;
  std::vector<double> own(12 * 24, 0.0), differences(12 * 24, 0.0);
  JointForces forces{};
  forces.derivatives = {own.data(), own.size()};
  ASSERT_TRUE(joint.joint.apply(in, forces, message)) << message.text;
  ASSERT_NE(joint.layout.analytic_derivatives, 0u);
  ASSERT_GT(std::hypot(forces.wrench_b[0], forces.wrench_b[2]), 10.0);
  std::vector<double> work(difference_numbers(0, joint.layout.events.size));
  ASSERT_TRUE(difference_forces({joint.joint, joint.layout, 0.3, work}, in, forces, differences, message))
      << message.text;
  double largest = 0.0, off = 0.0;
  for (std::size_t i = 0; i < own.size(); ++i) {
    largest = std::max(largest, std::abs(own[i]));
    off = std::max(off, std::abs(own[i] - differences[i]));
  }
  EXPECT_LE(off, 1e-6 * largest);
}

/// A spring of 1e5 N/m at x > 0.1 m and nothing before; says so by an event that is a number all the time.
struct Stop final : Joint {
  void declare(JointLayout&) const override {}
  void apply(const JointInput& in, JointForces& out) const override {
    out.wrench_b[0] = -1e5 * std::max(0.0, in.b->position[0] - 0.1);
    out.wrench_a[0] = -out.wrench_b[0];
  }
  void events(const JointInput& in, Span<double> g, Span<double> rate) const override {
    g[0] = in.b->position[0] - 0.1;
    rate[0] = in.b->velocity[0];
  }
};

// The model is large, and with it the step: 6e-8 m, a hundred times the distance to where the stop begins.
TEST(DifferenceForces, DoNotReachAcrossTheZeroOfAnEventFunction) {
  static constexpr Event events[] = {{"touch", Crossing::rising, 1, {}}};
  const Stop stop;
  const JointRef joint(abi::joint_table<Stop>, &stop);
  JointLayout layout;
  layout.events = events;
  std::vector<double> work(difference_numbers(0, 1)), differences(12 * 24);
  for (const double depth : {-6e-10, 6e-10}) {
    const MarkerKinematics a = marker(0.0, 0.0, 0.0, 0.0, 0.0, 0.0), b = marker(0.1 + depth, 0.0, 0.0, 0.0, 0.0, 0.0);
    const JointInput in{0.0, &a, &b, 0.0, 0.0, {}, {}};
    Message message;
    JointForces here{};
    ASSERT_TRUE(joint.apply(in, here, message));
    ASSERT_TRUE(difference_forces({joint, layout, 1.0, work}, in, here, differences, message)) << message.text;
    EXPECT_NEAR(differences[6 * 24 + 6], depth > 0.0 ? -1e5 : 0.0, 1.0);
  }
}

// Without the events the same joint is differenced over both sides of its edge.
TEST(DifferenceForces, AreSizedByTheClearance) {
  const Stop stop;
  const JointRef joint(abi::joint_table<Stop>, &stop);
  JointLayout layout;
  layout.clearance = 1e-5;
  std::vector<double> differences(12 * 24);
  const MarkerKinematics a = marker(0.0, 0.0, 0.0, 0.0, 0.0, 0.0), b = marker(0.1 + 1e-10, 0.0, 0.0, 0.0, 0.0, 0.0);
  const JointInput in{0.0, &a, &b, 0.0, 0.0, {}, {}};
  Message message;
  JointForces here{};
  ASSERT_TRUE(joint.apply(in, here, message));
  ASSERT_TRUE(difference_forces({joint, layout, 1.0, {}}, in, here, differences, message)) << message.text;
  EXPECT_NEAR(differences[6 * 24 + 6], -1e5, 10.0);
}

}  // namespace
}  // namespace freeplay
