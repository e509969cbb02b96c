#include "analysis/posture.h"

#include <gmock/gmock.h>

#include "analysis/branches.h"
#include "analysis/station.h"
#include "analysis/workspace.h"
#include "unit/analysis/platforms.h"

namespace freeplay {
namespace {

using platforms::Bench;
using ::testing::HasSubstr;

double turned(double a, double b) { return std::abs(std::remainder(a - b, 2.0 * M_PI)); }

TEST(Posture, CrankAnglesAreTheClosedFormOfBothModes) {
  for (const Json& entry : platforms::numbers()["inverse_kinematics"]) {
    Bench bench(platforms::legs_text(platforms::sizes(entry["mechanism"]), entry["elbow"]));
    const Posture posture = bench.reach(platforms::pose_of(entry["pose"]));
    const std::vector<double> inputs = bench.solver.inputs(posture);
    ASSERT_EQ(inputs.size(), entry["crank"].size());
    for (std::size_t i = 0; i < inputs.size(); ++i) EXPECT_LT(turned(inputs[i], entry["crank"][i]), 1e-10);
    // All joints are closed.
    const Evaluation& e = bench.solver.evaluate(0.0, posture, term_position);
    for (const double gap : e.phi) EXPECT_NEAR(gap, 0.0, 1e-14);
  }
}

TEST(Posture, LegsOfVariableLengthSpanTheirPins) {
  Bench bench(test::mechanism("3-rpr"));
  const double pose[3] = {0.02, -0.03, 0.1};
  const std::vector<double> lengths = bench.solver.inputs(bench.reach(Bench::at(pose[0], pose[1], pose[2])));
  for (std::size_t i = 0; i < 3; ++i) {
    const double a = 7.0 * M_PI / 6.0 + 2.0 * M_PI * static_cast<double>(i) / 3.0;
    const double dx = pose[0] + 0.11 * std::cos(pose[2] + a) - 0.4 * std::cos(a);
    const double dy = pose[1] + 0.11 * std::sin(pose[2] + a) - 0.4 * std::sin(a);
    EXPECT_NEAR(lengths[i], std::hypot(dx, dy), 1e-13);
  }
}

TEST(Posture, FiveBarFollowsTheTwoCircles) {
  Bench bench(test::mechanism("five-bar"));
  Demand demand;
  demand.given = {true, true, false};
  demand.pose = {Jet::constant(0.05), Jet::constant(0.25), Jet{}};
  const std::vector<double> inputs = bench.solver.inputs(bench.reach(demand));
  for (std::size_t i = 0; i < 2; ++i) {
    // Crank 0.15 m at (-+0.1, 0), coupler 0.2 m: law of cosines, elbows outside.
    const double px = 0.05 + (i == 0 ? 0.1 : -0.1), py = 0.25, d = std::hypot(px, py);
    const double turn = std::acos((0.15 * 0.15 + d * d - 0.2 * 0.2) / (2.0 * 0.15 * d));
    EXPECT_LT(turned(inputs[i], std::atan2(py, px) + (i == 0 ? turn : -turn)), 1e-12);
  }
}

// A slide on ground at height s, a coupler of length 0.3 from it to the platform: PRR legs by hand.
std::string slide_legs() {
  std::string text =
      "freeplay: 1\nbodies:\n  platform: {mass: 1, inertia: 1e-3, frames: {C0: [-0.05, 0], C1: [0.05, 0], C2: [0, "
      "0.05]}}\n";
  const double x[3] = {-0.3, 0.3, 0.1}, px[3] = {-0.05, 0.05, 0.0};
  for (int i = 0; i < 3; ++i) {
    const double height = i == 2 ? 0.2 : 0.0, turn = std::acos((px[i] - x[i]) / 0.3);
    const double rise = std::sin(turn) * 0.3;
    text += fmt::format("  slide{}: {{mass: 0.2, inertia: 1e-4, pose: {{position: [{}, {}], angle: 90 deg}}}}\n", i,
                        x[i], 0.0 + height / 4 - rise);
    text += fmt::format(
        "  link{}: {{mass: 0.2, inertia: 1e-4, com: [0.15, 0], frames: {{tip: [0.3, 0]}}, pose: {{position: [{}, {}], "
        "angle: "
        "{}}}}}\n",
        i, x[i], height / 4 - rise, turn);
  }
  text +=
      "frames:\n  ground/A0: {position: [-0.3, 0], angle: 90 deg}\n  ground/A1: {position: [0.3, 0], angle: 90 deg}\n"
      "  ground/A2: {position: [0.1, 0], angle: 90 deg}\njoints:\n";
  for (int i = 0; i < 3; ++i) {
    text += fmt::format(
        "  P{0}: {{type: prismatic, between: [ground/A{0}, slide{0}]}}\n"
        "  B{0}: {{type: revolute, between: [slide{0}, link{0}]}}\n"
        "  C{0}: {{type: revolute, between: [link{0}/tip, platform/C{0}]}}\n",
        i);
  }
  return text +
         "drivers:\n  path:\n    inverse_kinematics: {frame: platform, path: {x: 0, y: 0, angle: 0}, joints: P*}\n"
         "analysis: {error: {input: 0.05 mm, clearance: {B0: 0.1 mm, B1: 0.1 mm, B2: 0.1 mm, C0: 0.1 mm, C1: 0.1 mm, "
         "C2: 0.1 "
         "mm}}}\n";
}

TEST(Posture, SlidesWithLinksKeepTheirLength) {
  Bench bench(slide_legs());
  const double x = 0.02, y = 0.03, angle = 0.1;
  const std::vector<double> inputs = bench.solver.inputs(bench.reach(Bench::at(x, y, angle)));
  const double ax[3] = {-0.3, 0.3, 0.1}, cx[3] = {-0.05, 0.05, 0.0}, cy[3] = {0.0, 0.0, 0.05};
  for (std::size_t i = 0; i < 3; ++i) {
    const double px = x + std::cos(angle) * cx[i] - std::sin(angle) * cy[i];
    const double py = y + std::sin(angle) * cx[i] + std::cos(angle) * cy[i];
    EXPECT_NEAR(inputs[i], py - std::sqrt(0.3 * 0.3 - (px - ax[i]) * (px - ax[i])), 1e-12);
  }
}

TEST(Posture, SlidesHaveErrorsAlongTheirLinks) {
  // Each leg: u.dX = u_y ds + u.(delta_B + delta_C), u along the link.
  Bench bench(slide_legs());
  const Posture posture = bench.reach(Bench::at(0.02, 0.03, 0.1));
  const VelocityMap map = bench.map(posture);
  ASSERT_EQ(map.a.rows(), 3);
  const Evaluation& e = bench.solver.evaluate(0.0, posture, term_position);
  Eigen::Matrix3d a;
  Eigen::Vector3d widths;
  for (int i = 0; i < 3; ++i) {
    const JointElement& c = bench.model->joints[static_cast<std::size_t>(3 * i + 2)];
    const JointElement& b = bench.model->joints[static_cast<std::size_t>(3 * i + 1)];
    const double* pc = e.markers[static_cast<std::size_t>(c.marker_b)].position;
    const double* pb = e.markers[static_cast<std::size_t>(b.marker_a)].position;
    const double ux = (pc[0] - pb[0]) / 0.3, uy = (pc[1] - pb[1]) / 0.3;
    a.row(i) << ux, uy, -(pc[1] - 0.03) * ux + (pc[0] - 0.02) * uy;
    widths[i] = 2e-4 + 5e-5 * std::abs(uy);
  }
  const auto error = clearance_error(bench.mechanism, map);
  ASSERT_TRUE(error);
  const Eigen::Matrix3d inverse = a.inverse();
  EXPECT_NEAR(error->exact.change[0], (inverse.row(0).cwiseAbs() * widths)(0), 1e-15);
  EXPECT_NEAR(error->exact.dangle, (inverse.row(2).cwiseAbs() * widths)(0), 1e-14);
  double worst = 0.0;
  for (int signs = 0; signs < 8; ++signs) {
    const Eigen::Vector3d d(signs & 1 ? widths[0] : -widths[0], signs & 2 ? widths[1] : -widths[1],
                            signs & 4 ? widths[2] : -widths[2]);
    worst = std::max(worst, (inverse * d).head<2>().norm());
  }
  EXPECT_NEAR(error->exact.position, worst, 1e-15);
}

TEST(Posture, NamesTheLegThatDoesNotReach) {
  Bench bench(platforms::legs_text(platforms::sizes("3-rrr")));
  Posture posture;
  Unreachable why;
  EXPECT_FALSE(bench.solver.reach(Bench::at(0.3, 0.0, 0.0), {}, posture, why));
  EXPECT_THAT(why.text(bench.mechanism), HasSubstr("'A0'"));
  EXPECT_NEAR(why.most, 0.48, 1e-15);
  EXPECT_EQ(bench.solver.legs_in_reach(Bench::at(0.3, 0.0, 0.0), {}, why), 2);
}

TEST(Posture, LegOfNewtonsMethodThatDoesNotReachIsNamed) {
  Bench bench(slide_legs());
  Posture posture;
  Unreachable why;
  EXPECT_FALSE(bench.solver.reach(Bench::at(0.2, 0.0, 0.0), bench.mechanism.start(), posture, why));
  EXPECT_THAT(why.text(bench.mechanism), HasSubstr("'P0'"));
}

// C at the distance l1 + l2 (or none) from A, all around, in numbers that are rounded: in reach, and singular; a little
// farther it is not.
TEST(Posture, LegsReachToTheirLastDigit) {
  const Json m = platforms::sizes("3-rrr");
  Bench bench(platforms::legs_text(m));
  const double l3 = m["l3"], l4 = m["l4"], reach = m["l1"].get<double>() + m["l2"].get<double>();
  const double a = m["first_angle"];
  const Limb& leg = bench.mechanism.parts()[0];
  for (int i = 0; i < 500; ++i) {
    const double direction = 0.0123 * i, angle = 0.3 * std::sin(i);
    const auto demand = [&](double distance) {
      return Bench::at(l4 * std::cos(a) + distance * std::cos(direction) - l3 * std::cos(a + angle),
                       l4 * std::sin(a) + distance * std::sin(direction) - l3 * std::sin(a + angle), angle);
    };
    Posture posture = bench.solver.blank();
    EXPECT_TRUE(bench.solver.place(leg, 1, demand(reach), posture)) << i;
    EXPECT_FALSE(bench.solver.place(leg, 1, demand(reach + 1e-13), posture)) << i;
    EXPECT_TRUE(bench.solver.place(leg, 1, demand(reach - 1e-13), posture)) << i;
  }
}

TEST(Posture, WaysEndOnAFoldAndNotBeyondIt) {
  Bench bench(test::mechanism("five-bar"));
  const Posture start = bench.mechanism.start();
  const Components flat{true, true, false};
  for (int i = 0; i < 30; ++i) {
    const double direction = 0.2 + 0.03 * i;  // of the stretched leg on A1
    const auto demand = [&](double distance) {
      Demand out = Bench::at(-0.1 + distance * std::cos(direction), distance * std::sin(direction), 0.0);
      out.given = flat;
      return out;
    };
    Posture posture;
    Unreachable why;
    ASSERT_TRUE(bench.solver.reach(demand(0.35), start, posture, why)) << i;
    EXPECT_TRUE(bench.solver.folded());
    EXPECT_EQ(singularity_of(bench.map(posture, flat), 1.0).kind, SingularityKind::inverse);
    const double crank = std::remainder(bench.solver.inputs(posture)[0] - direction, 2.0 * M_PI);
    EXPECT_NEAR(crank, 0.0, 1e-6);  // the root of the rounding
    EXPECT_FALSE(bench.solver.reach(demand(0.35 + 1e-12), start, posture, why)) << i;
    EXPECT_TRUE(bench.solver.reach(demand(0.3499), start, posture, why)) << i;
    EXPECT_FALSE(bench.solver.folded());
  }
}

TEST(Posture, AllAssembliesOfTheDirectProblemLong) {
  for (const Json& entry : platforms::numbers()["direct_kinematics"]) {
    Bench bench(platforms::legs_text(platforms::sizes(entry["mechanism"])));
    Demand demand;
    for (const Json& crank : entry["crank"]) demand.inputs.push_back(Jet::constant(crank.get<double>()));
    const std::vector<Posture> found = all_postures(bench.mechanism, demand);
    // Of four legs the list has the one assembly that was looked for.
    if (entry["crank"].size() == 3) {
      EXPECT_EQ(found.size(), entry["poses"].size());
    }
    for (const Json& pose : entry["poses"]) {
      double nearest = 1.0;
      for (const Posture& posture : found) {
        const FramePose frame = bench.solver.frame(posture);
        nearest = std::min(nearest, std::max({std::abs(frame[0] - pose[0].get<double>()),
                                              std::abs(frame[1] - pose[1].get<double>()), turned(frame[2], pose[2])}));
      }
      EXPECT_LT(nearest, 1e-10);
    }
  }
}

TEST(Posture, WorkingModesAreTwoForEachLeg) {
  Bench legs(platforms::legs_text(platforms::sizes("4-rrr")));
  EXPECT_EQ(all_postures(legs.mechanism, Bench::at(0.02, -0.03, 0.1)).size(), 16u);
  Bench slides(slide_legs());
  EXPECT_EQ(all_postures(slides.mechanism, Bench::at(0.02, 0.03, 0.1)).size(), 8u);
}

TEST(Posture, RatesAreThoseOfDifferencesAlongAPath) {
  for (const std::string& text :
       {platforms::legs_text(platforms::sizes("3-rrr"), 1, {},
                             "{x: 0.05*cos(9*t), y: 0.05*sin(9*t), angle: 0.1*sin(5*t)}"),
        test::replaced(test::mechanism("3-rpr"), "angle: $turn}", "angle: $turn + 0.05*sin(7*t)}"),
        test::mechanism("five-bar")}) {
    Bench bench(text);
    const auto inputs_at = [&](double t) {
      const auto stations = along_path(bench.mechanism, GridValues::one(t));
      return bench.solver.inputs(stations.front().posture);
    };
    const double t = 0.13, h = 5e-4;
    std::vector<double> at[5];  // for differences of fourth order
    for (int k = 0; k < 5; ++k) at[k] = inputs_at(t + (k - 2) * h);
    const auto station = along_path(bench.mechanism, GridValues::one(t)).front();
    std::vector<double> v, a;
    ASSERT_TRUE(bench.solver.rates(station.demand, station.posture, v, a));
    const Evaluation& e = bench.solver.evaluate_moving(t, station.posture, v, term_velocity);
    for (std::size_t i = 0; i < at[2].size(); ++i) {
      double f[5];
      for (int k = 0; k < 5; ++k) f[k] = std::remainder(at[k][i] - at[2][i], 2.0 * M_PI);
      const int j = bench.mechanism.platform().inputs[i];
      const double first = (8.0 * (f[3] - f[1]) - (f[4] - f[0])) / (12.0 * h);
      EXPECT_NEAR(e.coordinate_rate[static_cast<std::size_t>(j)], first, 1e-7 * (1.0 + std::abs(first)));
      double row[6], acceleration = 0.0;
      bench.mechanism.system().joints().coordinate_row(j, e, row, acceleration);
      const JointElement& joint = bench.model->joints[static_cast<std::size_t>(j)];
      const BodyId bodies[2] = {bench.model->markers[static_cast<std::size_t>(joint.marker_a)].body,
                                bench.model->markers[static_cast<std::size_t>(joint.marker_b)].body};
      for (int k = 0; k < 2; ++k) {
        for (int c = 0; c < 3 && bodies[k] != ground; ++c) {
          acceleration += row[3 * k + c] * a[static_cast<std::size_t>(3 * bodies[k] + c)];
        }
      }
      const double second = (16.0 * (f[3] + f[1]) - (f[4] + f[0])) / (12.0 * h * h);
      EXPECT_NEAR(acceleration, second, 1e-7 * (1.0 + std::abs(second)));
    }
  }
}

TEST(Workspace, BoundaryIsWhereALegIsStretched) {
  // Distance from the origin along 0, 45, ... 315 degrees to the first stretched leg; closed form.
  const double radius[8] = {0.206427763345591,
                            0.193976825928998,
                            0.264053786194432,
                            0.193976825928998,
                            0.206427763345591,
                            0.228932120958456,
                            0.19,
                            0.228932120958456};
  Bench bench(platforms::legs_text(platforms::sizes("3-rrr")));
  for (int k = 0; k < 8; ++k) {
    EXPECT_NEAR(reach_in_direction(bench.mechanism, {0.0, 0.0, 0.0}, k * M_PI / 4.0, 0.4), radius[k], 1e-9);
  }
}

TEST(Workspace, CountsCellsRegionsAndHoles) {
  Bench bench(platforms::legs_text(platforms::sizes("3-rrr")));
  const GridValues centres{{}, -0.395, 0.395, 80, false};
  const std::array<GridValues, 3> axes{centres, centres, GridValues::one(0.0)};
  for (const int threads : {1, 3}) {
    const auto stations = on_grid(bench.mechanism, axes, {true, true, true}, threads);
    EXPECT_EQ(std::ranges::count(stations, true, &Station::reachable), 1446);
    const WorkspaceShape shape = workspace_shape(bench.mechanism, stations, axes, {0, 1});
    EXPECT_NEAR(shape.size, 0.1446, 1e-12);
    EXPECT_EQ(shape.regions, 1);
    EXPECT_EQ(shape.holes, 0);
  }
  // Legs with unequal links cannot fold away: one hole of radius 0.1 - around a pin for each leg.
  Json m = platforms::sizes("3-rrr");
  m["l1"] = 0.35;
  m["l2"] = 0.25;
  m["l3"] = 0.05;
  m["l4"] = 0.2;
  Bench holes(platforms::legs_text(m));
  const auto stations = on_grid(holes.mechanism, axes, {true, true, true}, 2);
  EXPECT_EQ(workspace_shape(holes.mechanism, stations, axes, {0, 1}).holes, 3);
}

}  // namespace
}  // namespace freeplay
