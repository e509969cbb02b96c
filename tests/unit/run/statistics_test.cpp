#include "run/statistics.h"

#include <cmath>

#include "validation/puck.h"

namespace freeplay {
namespace {

using test::ModelRun;

std::string slider(const std::string& output) {
  // x = 2 + 3 t^2 by a constant force: known maxima and means.
  return "freeplay: 1\nbodies: {mass: {mass: 1, inertia: 1}}\n"
         "joints: {guide: {type: prismatic, between: [ground, mass]}}\n"
         "drivers: {push: {joint: guide, kind: force, value: \"2*t\"}}\n"
         "simulation: {end: 1, step: 1 ms, output: {interval: 0.25" +
         output + "}}\n";
}

// Effort 2 t over 1 s: greatest 2, mean square 4/3; speed t^2, work the integral of 2 t^3. The trapezoidal rule over
// 1000 steps errs by 1e-6/12 of second derivatives of up to 12.
TEST(Statistics, AreTakenOverEveryStepNotOverRows) {
  const ModelRun run(slider(""));
  const DriverStatistics push = run.statistics().driver(0);
  EXPECT_NEAR(push.max_abs, 2.0, 1e-12);
  EXPECT_NEAR(push.rms, std::sqrt(4.0 / 3.0), 1e-6);
  EXPECT_NEAR(push.work, 0.5, 2e-6);
  EXPECT_NEAR(run.statistics().body_max_speed(0), 1.0, 1e-6);
}

TEST(Statistics, LeaveOutWhatIsDiscarded) {
  const ModelRun run(slider(", discard: 0.5"));
  const DriverStatistics push = run.statistics().driver(0);
  EXPECT_NEAR(push.rms, std::sqrt((4.0 / 3.0) * (1.0 - 0.125) / 0.5), 1e-6);
  EXPECT_NEAR(push.work, 0.5 * (1.0 - 0.0625), 2e-6);
}

// Steps of an accuracy are as long as half of the run here, so that the rows inside make the means.
TEST(Statistics, BeginInsideOfALongStepWithTheRowsInIt) {
  for (const std::string discard : {"0.5", "0.83", "0.4999"}) {
    const double left_out = std::stod(discard), length = 1.0 - left_out;
    const ModelRun run(test::replaced(test::replaced(slider(", discard: " + discard), "step: 1 ms", "accuracy: 1e-5"),
                                      "interval: 0.25", "interval: 0.01"));
    const DriverStatistics push = run.statistics().driver(0);
    EXPECT_NEAR(push.rms, std::sqrt((4.0 / 3.0) * (1.0 - std::pow(left_out, 3)) / length), 1e-5) << discard;
    EXPECT_NEAR(push.work, 0.5 * (1.0 - std::pow(left_out, 4)), 1e-5) << discard;
  }
}

TEST(Statistics, HaveNoValueWhenEverythingIsDiscarded) {
  const ModelRun run(slider(", discard: 2"));
  EXPECT_TRUE(std::isnan(run.statistics().driver(0).rms));
  EXPECT_TRUE(std::isnan(run.statistics().body_max_speed(0)));
  EXPECT_EQ(run.statistics().contacts(), 0);
}

// One bounce of a mass on a hard ring: closed form of the elastic impact.
TEST(Statistics, CountContactsAndTheirShareOfTime) {
  test::Puck puck;
  puck.y = -0.09e-3;
  puck.vy = -0.1;
  puck.end = 4e-4;
  puck.step = 1e-7;
  const ModelRun run = puck.run();
  const JointStatistics ring = run.statistics().joint(0);
  EXPECT_EQ(ring.contacts, 1);
  EXPECT_EQ(run.statistics().contacts_total(), 1);
  EXPECT_NEAR(ring.max_penetration, 4.06450543819949e-06, 1e-5 * 4.06450543819949e-06);
  EXPECT_NEAR(ring.max_normal_force, 615.080982917188, 1e-5 * 615.0);
  EXPECT_NEAR(ring.max_eccentricity, 1e-4 + 4.06450543819949e-06, 1e-10);
  EXPECT_NEAR(ring.contact_fraction, 0.000119629579928 / 4e-4, 1e-3);  // whole steps at both ends
  EXPECT_NEAR(ring.dissipated, 0.0, 1e-8);                             // of 1 mJ
}

// The force grows by the power 1.5 of the time in the only step that is made in contact.
TEST(Statistics, CountTheContactInWhichARunEnds) {
  const auto rms = [](const std::string& accuracy) {
    const std::string text =
        "freeplay: 1\nbodies: {ball: {mass: 1, inertia: 1e-4}}\njoints: {ring: {type: revolute, between: [ground, "
        "ball], "
        "clearance: {bearing_radius: 10 mm, radial_clearance: 0.1 mm, initial: {velocity: [4 mm/s, 0]}, "
        "contact: {law: hertz, K: 1e9}}}}\n"
        "simulation: {end: 25.06 ms, accuracy: " +
        accuracy + ", output: {interval: 1 ms}}\n";
    return ModelRun(text).statistics().joint(0).rms_force;
  };
  const double right = rms("1e-12");
  EXPECT_NEAR(rms("1e-6"), right, 0.05 * right);
}

}  // namespace
}  // namespace freeplay
