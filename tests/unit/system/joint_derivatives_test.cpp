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

// The penetration of 1 mm is wide against the 6e-6 m of a difference: (6e-6/1e-3)^2/24 of the stiffness, 2e-6.
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
  ASSERT_TRUE(difference_forces(joint.joint, in, true, differences, {}, message)) << message.text;
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

}  // namespace
}  // namespace freeplay
