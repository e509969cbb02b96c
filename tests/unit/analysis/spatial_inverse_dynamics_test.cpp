// Drive forces of mechanisms in space, and planar mechanisms whose axes are all z against those in the plane.
#include <gtest/gtest.h>

#include "analysis/inverse_dynamics.h"
#include "analysis/mobility.h"
#include "analysis/station.h"
#include "platforms.h"

namespace freeplay {
namespace {

using platforms::Bench;

/// A rod on a turning base: yaw about z, elevation about -y. Functions of time as expressions and as jets.
TEST(SpatialInverseDynamics, TorquesOfATurningArmAreThoseOfLagrange) {
  const double m = 2.0, l = 0.4, ix = 0.01, iy = 0.05, iz = 0.06, base = 0.3, g = 9.81;
  const std::string model = fmt::format(
      "freeplay: 1\nspace: spatial\ngravity: [0, 0, -{}]\n"
      "bodies:\n  base: {{mass: 1, inertia: [1, 1, {}]}}\n  rod: {{mass: {}, inertia: [{}, {}, {}], com: [{}, 0, 0]}}\n"
      "joints:\n  yaw: {{type: revolute, between: [ground, base]}}\n"
      "  lift: {{type: revolute, between: [base, rod], axis: [0, -1, 0]}}\n"
      "drivers:\n  Y: {{joint: yaw, kind: angle, value: \"0.3*sin(2*t) + 0.5*t\"}}\n"
      "  E: {{joint: lift, kind: angle, value: \"0.4 + 0.2*cos(3*t)\"}}\n"
      "analysis: {{frame: rod}}\n",
      g, base, m, ix, iy, iz, l);
  Bench bench(model);
  const GridValues times{{}, 0.0, 2.0, 9, false};
  InverseDynamics dynamics(bench.solver);
  for (const Station& station : along_path(bench.mechanism, times)) {
    ASSERT_TRUE(station.reachable);
    const double t = station.time;
    const double yaw1 = 0.6 * std::cos(2 * t) + 0.5, yaw2 = -1.2 * std::sin(2 * t);
    const double e = 0.4 + 0.2 * std::cos(3 * t), e1 = -0.6 * std::sin(3 * t), e2 = -1.8 * std::cos(3 * t);
    // T = (J + (Iz + m l^2) cos^2 e + Ix sin^2 e) yaw'^2 / 2 + (Iy + m l^2) e'^2 / 2, V = m g l sin e.
    const double across = iz + m * l * l, c = std::cos(e), s = std::sin(e);
    const double turn = base + across * c * c + ix * s * s, slope = 2.0 * (ix - across) * s * c;
    std::vector<double> v, a;
    ASSERT_TRUE(bench.solver.rates(station.demand, station.posture, v, a));
    Efforts efforts;
    ASSERT_EQ(dynamics.solve(t, station.posture, v, a, 0.0, efforts), InverseDynamics::Found::yes);
    EXPECT_NEAR(efforts.input[0], turn * yaw2 + slope * e1 * yaw1, 1e-11);
    EXPECT_NEAR(efforts.input[1], (iy + m * l * l) * e2 - 0.5 * slope * yaw1 * yaw1 + m * g * l * c, 1e-11);
    // The base holds the weight and the centripetal force of the rod; power is the rate of energy.
    const double power = efforts.input[0] * yaw1 + efforts.input[1] * e1;
    const double rate =
        turn * yaw1 * yaw2 + 0.5 * slope * e1 * yaw1 * yaw1 + (iy + m * l * l) * e1 * e2 + m * g * l * c * e1;
    EXPECT_NEAR(power, rate, 1e-11);
    const double lifted = l * (c * e2 - s * e1 * e1);  // acceleration of the centre of mass upwards
    EXPECT_NEAR(efforts.wrench[1][2], m * (g + lifted), 1e-11);
  }
}

/// A five-bar with driven cranks in the plane or, with all axes z, in space.
std::string five_bar(const std::string& space, const std::string& clearance) {
  const bool planar = space == "planar";
  const auto v = [&](double x, double y) {
    return planar ? fmt::format("[{}, {}]", x, y) : fmt::format("[{}, {}, 0]", x, y);
  };
  const auto inertia = [&](double i) { return planar ? fmt::format("{}", i) : fmt::format("[{0}, {0}, {0}]", i); };
  const auto pose = [&](double x, double y, double angle) {
    return fmt::format("pose: {{position: {}, {}}}", v(x, y),
                       planar ? fmt::format("angle: {}", angle) : fmt::format("rpy: [0, 0, {}]", angle));
  };
  return "freeplay: 1\nspace: " + space + "\ngravity: " + (planar ? "[1, -9.81]" : "[1, -9.81, 0]") +
         fmt::format(
             "\nbodies:\n"
             "  left: {{mass: 0.3, inertia: {i}, com: {c}, frames: {{tip: {t}}}, {p1}}}\n"
             "  right: {{mass: 0.3, inertia: {i}, com: {c}, frames: {{tip: {t}}}, {p2}}}\n"
             "  rod: {{mass: 0.5, inertia: {i}, com: {d}, frames: {{tip: {u}}}, {p3}}}\n"
             "  arm: {{mass: 0.6, inertia: {i}, com: {d}, frames: {{tip: {u}}}, {p4}}}\n"
             "frames: {{ground/A: {a}, ground/B: {b}}}\n"
             "joints:\n"
             "  A: {{type: revolute, between: [ground/A, left]}}\n"
             "  B: {{type: revolute, between: [ground/B, right]}}\n"
             "  P: {{type: revolute, between: [left/tip, rod]}}\n"
             "  Q: {{type: revolute, between: [right/tip, arm]}}\n"
             "  C: {{type: revolute, between: [rod/tip, arm/tip]}}\n"
             "drivers:\n"
             "  left: {{joint: A, kind: angle, value: \"2.0 + 0.3*sin(5*t)\"}}\n"
             "  right: {{joint: B, kind: angle, value: \"1.1 + 0.2*cos(4*t)\"}}\n"
             "analysis: {{frame: arm/tip, error: {{input: 1e-3 rad, clearance: {{{cl}}}}}}}\n",
             fmt::arg("i", inertia(1e-3)), fmt::arg("c", v(0.05, 0)), fmt::arg("t", v(0.1, 0)),
             fmt::arg("d", v(0.1, 0.01)), fmt::arg("u", v(0.2, 0)), fmt::arg("a", v(-0.1, 0)), fmt::arg("b", v(0.1, 0)),
             fmt::arg("p1", pose(-0.1, 0, 2.0)), fmt::arg("p2", pose(0.1, 0, 1.3)),
             fmt::arg("p3", pose(-0.14, 0.09, 0.6)), fmt::arg("p4", pose(0.12, 0.09, 2.2)), fmt::arg("cl", clearance));
}

TEST(SpatialInverseDynamics, PlanarMechanismInSpaceNeedsThePlanarEfforts) {
  Bench plane(five_bar("planar", "")), space(five_bar("spatial", ""));
  const GridValues times{{}, 0.0, 1.0, 11, false};
  const auto in_plane = along_path(plane.mechanism, times), in_space = along_path(space.mechanism, times);
  InverseDynamics planar(plane.solver), spatial(space.solver);
  for (std::size_t k = 0; k < in_plane.size(); ++k) {
    Efforts efforts[2];
    std::vector<double> v, a;
    ASSERT_TRUE(in_plane[k].reachable && in_space[k].reachable);
    ASSERT_TRUE(plane.solver.rates(in_plane[k].demand, in_plane[k].posture, v, a));
    ASSERT_EQ(planar.solve(in_plane[k].time, in_plane[k].posture, v, a, 0.0, efforts[0]), InverseDynamics::Found::yes);
    ASSERT_TRUE(space.solver.rates(in_space[k].demand, in_space[k].posture, v, a));
    ASSERT_EQ(spatial.solve(in_space[k].time, in_space[k].posture, v, a, 0.0, efforts[1]), InverseDynamics::Found::yes);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(efforts[0].input[i], efforts[1].input[i], 1e-9);
    for (std::size_t j = 0; j < 5; ++j) {
      for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(efforts[0].wrench[j][i], efforts[1].wrench[j][i], 1e-9);
    }
  }
}

// Out of the plane the pins of a planar mechanism hold it more than once, so only some play closes; in the plane all
// does.
TEST(SpatialPlatform, PlanarMechanismInSpaceHasThePlanarErrors) {
  const std::string play = "P: 1e-4, C: 2e-4";
  Bench plane(five_bar("planar", play)), space(five_bar("spatial", play));
  EXPECT_EQ(general_mobility(space.solver, 0.0, space.mechanism.start()).general.redundant_rows, 3);
  const auto planar = clearance_error(plane.mechanism, plane.map(plane.mechanism.start()));
  const auto spatial =
      clearance_error(space.mechanism, space.map(space.mechanism.start(), space.mechanism.form().all()));
  ASSERT_TRUE(planar && spatial);
  EXPECT_NEAR(spatial->exact.change[0], planar->exact.change[0], 1e-9 * planar->exact.change[0]);
  EXPECT_NEAR(spatial->exact.change[1], planar->exact.change[1], 1e-9 * planar->exact.change[1]);
  EXPECT_NEAR(spatial->exact.change[5], planar->exact.dangle, 1e-9 * planar->exact.dangle);
}

}  // namespace
}  // namespace freeplay
