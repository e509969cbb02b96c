#include "run_model.h"

namespace freeplay::test {
namespace {

/// Means over twelve runs in quadruple precision whose starts differ by multiples of 1e-12 m, 0.1 s < t < 0.5 s.
struct Means {
  const char* model;
  double position_max, position_rms, angle_rms;  ///< of the platform against its path [m, m, rad]
  double torque_rms;                             ///< over all motors [N m]
  double force_rms;                              ///< over all joints with play [N]
};
class ClearanceStatisticsLong : public ::testing::TestWithParam<Means> {};

// Motions with many impacts are chaotic: only statistics can be compared. Their spread between the twelve runs is
// 0.05 % in position, 0.1 % in angle, 0.4 % in torque and force; the limits are those that the program promises.
TEST_P(ClearanceStatisticsLong, AreThoseOfTheReference) {
  const Means& want = GetParam();
  const ModelRun run(mechanism(want.model), {.set = {}, .ideal = {}, .end = 0.5, .step = 2e-6, .integrator = {}},
                     {"time"});
  ASSERT_EQ(run.outcome().status, RunStatus::completed) << run.outcome().reason;
  const PathStatistics path = run.statistics().path(0);
  double torque = 0.0, force = 0.0;
  int drivers = 0, joints = 0;
  for (int d = 0; d < static_cast<int>(run.model().drivers.size()); ++d, ++drivers) {
    torque += std::pow(run.statistics().driver(d).rms, 2);
  }
  for (int j = 0; j < static_cast<int>(run.model().joints.size()); ++j) {
    if (!run.model().joints[static_cast<std::size_t>(j)].has_play) continue;
    force += std::pow(run.statistics().joint(j).rms_force, 2);
    ++joints;
  }
  torque = std::sqrt(torque / drivers);
  force = std::sqrt(force / joints);
  record("position_max", path.max_position / want.position_max - 1.0);
  record("position_rms", path.rms_position / want.position_rms - 1.0);
  record("angle_rms", path.rms_angle / want.angle_rms - 1.0);
  record("torque_rms", torque / want.torque_rms - 1.0);
  record("force_rms", force / want.force_rms - 1.0);
  record("contacts", static_cast<double>(run.statistics().contacts_total()));
  EXPECT_NEAR(path.max_position, want.position_max, 5e-3 * want.position_max);
  EXPECT_NEAR(path.rms_position, want.position_rms, 5e-3 * want.position_rms);
  EXPECT_NEAR(path.rms_angle, want.angle_rms, 2e-2 * want.angle_rms);
  EXPECT_NEAR(torque, want.torque_rms, 2e-2 * want.torque_rms);
  EXPECT_NEAR(force, want.force_rms, 2e-2 * want.force_rms);
  EXPECT_LT(run.statistics().position_residual(), 1e-10);
  EXPECT_LT(run.statistics().velocity_residual(), 1e-8);
}
void PrintTo(const Means& means, std::ostream* out) { *out << means.model; }

INSTANTIATE_TEST_SUITE_P(Models, ClearanceStatisticsLong,
                         ::testing::Values(Means{"3-rrr", 306.30e-6, 275.86e-6, 0.9097e-3, 1.527, 5.646},
                                           Means{"4-rrr", 285.09e-6, 261.33e-6, 0.2565e-3, 1.1978, 4.215}));

// Triangles of a force between corners of a table: a step each side, and the square of the force is a parabola.
TEST(Statistics, MeanSquareOfShortPulsesIsThatOfTheirTable) {
  for (const int pulses : {1, 3, 40}) {
    std::string points = "[0, 0]";
    for (int i = 0; i < pulses; ++i) {
      const double at = 0.1 + 0.04 * i;
      points += ", [" + number(at) + ", 0], [" + number(at + 1e-4) + ", 1000], [" + number(at + 3e-4) + ", 0]";
    }
    const ModelRun run(
        "freeplay: 1\nbodies: {m: {mass: 1, inertia: 1}}\njoints: {g: {type: prismatic, between: [ground, m]}}\n"
        "drivers: {d: {joint: g, kind: force, table: {interpolation: linear, points: [" +
        points + ", [2, 0]]}}}\nsimulation: {end: 2 s, accuracy: 1 um}\n");
    const double rms = 1000.0 * std::sqrt(pulses * 3e-4 / 3.0 / 2.0);
    EXPECT_NEAR(run.statistics().driver(0).rms, rms, 1e-9 * rms) << pulses;
  }
}

// A bar of 2 kg that turns evenly about its end: steps of half a turn. Its weight turns the motor by
// 2 kg g 0.5 m cos(w t) and pulls at the pin by a force with the mean square (m g)^2 + (m w^2 r)^2.
TEST(Statistics, MeansOfLongStepsAreThoseOfTheRowsInside) {
  constexpr double w = 2.0 * M_PI, weight = 2.0 * 9.81, pull = 2.0 * w * w * 0.5;
  for (const char* integrator : {"dopri5", "verner7"}) {
    const ModelRun run(
        "freeplay: 1\ngravity: [0, -9.81]\nbodies: {bar: {mass: 2, inertia: 0.2, com: [0.5, 0]}}\n"
        "joints: {pin: {type: revolute, between: [ground, bar]}}\n"
        "drivers: {motor: {joint: pin, kind: angle, value: \"2*pi*t\"}}\n"
        "simulation: {end: 10 s, accuracy: 1 cm, output: {interval: 20 ms}, integrator: " +
        std::string(integrator) + "}\n");
    ASSERT_EQ(run.outcome().exit_code, 0) << run.outcome().reason;
    ASSERT_LT(run.outcome().steps, 200);
    const double torque = weight * 0.5 / std::sqrt(2.0), force = std::hypot(weight, pull);
    EXPECT_NEAR(run.statistics().driver(0).rms, torque, 1e-6 * torque) << integrator;
    EXPECT_NEAR(run.statistics().joint(0).rms_force, force, 1e-6 * force) << integrator;
  }
}

}  // namespace
}  // namespace freeplay::test
