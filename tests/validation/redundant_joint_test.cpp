#include "run_model.h"

namespace freeplay::test {
namespace {

constexpr const char* twice =
    "freeplay: 1\ngravity: [0, -9.81]\n"
    "bodies: {rod: {mass: 1, inertia: 1/12, com: [0.5, 0]}}\n"
    "joints:\n"
    "  one: {type: revolute, between: [ground, rod]}\n"
    "  two: {type: revolute, between: [ground, rod]}\n"
    "initial: {joints: {one: 0.3}}\n"
    "simulation: {end: 0.5, step: 1 ms}\n";

// Rod at rest at 0.3 rad, closed form: each pin takes half.
TEST(RedundantJoint, EachOfTwoEqualPinsTakesHalfTheLoad) {
  const ModelRun run(twice);
  for (const char* pin : {"joint.one", "joint.two"}) {
    EXPECT_NEAR(run.at(0, std::string(pin) + ".fx"), 1.038589249501, 1e-11);
    EXPECT_NEAR(run.at(0, std::string(pin) + ".fy"), 1.547523303326, 1e-11);
  }
  EXPECT_EQ(run.start().facts.actual.rank, 2);
  EXPECT_EQ(run.start().facts.actual.redundant, 2);
  EXPECT_EQ(run.start().facts.actual.dof, 1);
}

TEST(RedundantJoint, TheMotionIsThatOfOnePin) {
  const ModelRun both(twice);
  const ModelRun single(replaced(twice, "  two: {type: revolute, between: [ground, rod]}\n", ""));
  ASSERT_EQ(both.outcome().status, RunStatus::completed);
  EXPECT_EQ(both.outcome().rejected, 0);
  double worst = 0.0;
  for (std::size_t i = 0; i < both.rows(); ++i) {
    worst = std::max(worst, std::abs(both.at(i, "body.rod.angle") - single.at(i, "body.rod.angle")));
    // Halves at every instant, the whole equal to that of one pin.
    EXPECT_NEAR(both.at(i, "joint.one.fy"), 0.5 * single.at(i, "joint.one.fy"), 1e-8) << i;
    EXPECT_NEAR(both.at(i, "joint.one.fy"), both.at(i, "joint.two.fy"), 1e-10) << i;
  }
  record("angle_difference", worst);
  EXPECT_LE(worst, 1e-9);  // iterations end at 1e-10 of the model size
  EXPECT_LT(both.statistics().position_residual(), 1e-10);
}

// Rows that say the same leave no noise in the error, however little is allowed.
TEST(RedundantJoint, TakesTheStepsOfOnePinUnderATolerance) {
  for (const char* tolerance : {"1e-8", "1e-11", "1e-13"}) {
    const std::string text = replaced(twice, "step: 1 ms",
                                      "integrator: dopri5, step: {size: 1e-3, adaptive: true, "
                                      "tolerance: " +
                                          std::string(tolerance) + "}");
    const ModelRun both(text);
    const ModelRun single(replaced(text, "  two: {type: revolute, between: [ground, rod]}\n", ""));
    ASSERT_EQ(both.outcome().status, RunStatus::completed) << tolerance << ": " << both.outcome().reason;
    EXPECT_NEAR(static_cast<double>(both.outcome().steps), static_cast<double>(single.outcome().steps),
                1.0 + 0.02 * static_cast<double>(single.outcome().steps))
        << tolerance;
  }
}

}  // namespace
}  // namespace freeplay::test
