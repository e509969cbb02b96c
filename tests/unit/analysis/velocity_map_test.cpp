#include "analysis/velocity_map.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "analysis/inverse_dynamics.h"
#include "analysis/mobility.h"
#include "analysis/play_samples.h"
#include "analysis/station.h"
#include "unit/analysis/platforms.h"

namespace freeplay {
namespace {

using platforms::Bench;

TEST(VelocityMap, RowsAreThoseOfTheClosedForm) {
  for (const Json& entry : platforms::numbers()["velocity"]) {
    Bench bench(platforms::legs_text(platforms::sizes(entry["mechanism"]), entry["elbow"]));
    const VelocityMap map = bench.map(bench.reach(platforms::pose_of(entry["pose"])));
    const auto rows = static_cast<Eigen::Index>(entry["A"].size());
    ASSERT_EQ(map.a.rows(), rows);
    for (Eigen::Index r = 0; r < rows; ++r) {
      const Json& row = entry["A"][static_cast<std::size_t>(r)];
      for (Eigen::Index c = 0; c < 3; ++c) EXPECT_NEAR(map.a(r, c), row[static_cast<std::size_t>(c)], 1e-12);
      for (Eigen::Index c = 0; c < rows; ++c) {
        EXPECT_NEAR(map.b(r, c), r == c ? entry["b"][static_cast<std::size_t>(r)].get<double>() : 0.0, 1e-12);
      }
    }
    const Singularity s = singularity_of(map, bench.mechanism.length());
    EXPECT_NEAR(bench.mechanism.length(), platforms::sizes(entry["mechanism"])["l3"], 1e-15);
    EXPECT_NEAR(s.sigma_max, entry["singular_values_scaled"][0], 1e-12);
    EXPECT_NEAR(s.sigma_min, entry["singular_values_scaled"][2], 1e-12);
    EXPECT_NEAR(s.condition, entry["condition_scaled"], 1e-11);
    EXPECT_NEAR(s.manipulability, entry["manipulability_scaled"], 1e-12);
    EXPECT_NEAR(s.inverse_min, entry["inverse_min"], 1e-12);
    EXPECT_EQ(s.kind, SingularityKind::none);
  }
}

TEST(VelocityMap, GivesRatesOfTheCranks) {
  for (const Json& entry : platforms::numbers()["velocity"]) {
    Bench bench(platforms::legs_text(platforms::sizes(entry["mechanism"]), entry["elbow"]));
    Demand demand = platforms::pose_of(entry["pose"]);
    const Posture posture = bench.reach(demand);
    for (std::size_t i = 0; i < 3; ++i) demand.pose[i] = {demand.pose[i].value, entry["v"][i], entry["a"][i]};
    std::vector<double> v, a;
    ASSERT_TRUE(bench.solver.rates(demand, posture, v, a));
    for (std::size_t i = 0; i < entry["crank_rate"].size(); ++i) {
      const auto crank = static_cast<std::size_t>(
          bench.model->markers[static_cast<std::size_t>(bench.model->joints[3 * i].marker_b)].body);
      EXPECT_NEAR(v[3 * crank + 2], entry["crank_rate"][i], 1e-11);
      EXPECT_NEAR(a[3 * crank + 2], entry["crank_acceleration"][i], 1e-10);
    }
  }
}

// A dX = B dtheta against central differences of postures, on everything in mechanisms/ that can be a platform.
TEST(VelocityMap, IsTheDerivativeOfPosturesOfEveryMechanism) {
  struct Case {
    std::string text;
    Components kept;
  };
  const std::string four_bar = test::mechanism("four-bar") + "analysis: {frame: coupler/tip}\n";
  const std::string slider =
      test::replaced(test::mechanism("slider-crank"), "main: 0 deg", "main: 50 deg") + "analysis: {frame: slider}\n";
  for (const Case& one :
       {Case{test::mechanism("3-rrr"), {true, true, true}}, Case{test::mechanism("4-rrr"), {true, true, true}},
        Case{test::mechanism("3-rpr"), {true, true, true}}, Case{test::mechanism("five-bar"), {true, true, false}},
        Case{four_bar, {true, false, false}}, Case{four_bar, {false, false, true}},
        Case{slider, {true, false, false}}}) {
    Bench bench(one.text);
    const Posture start = bench.mechanism.start();
    const FramePose here = bench.solver.frame(start);
    const VelocityMap map = bench.map(start, one.kept);
    for (int direction = 0; direction < 3; ++direction) {
      if (!one.kept[static_cast<std::size_t>(direction)]) continue;
      constexpr double h = 1e-5;
      std::vector<double> ends[2];
      for (int side = 0; side < 2; ++side) {
        Demand demand;
        demand.given = one.kept;
        for (std::size_t i = 0; i < 3; ++i) demand.pose[i] = Jet::constant(here[i]);
        demand.pose[static_cast<std::size_t>(direction)].value += side == 0 ? -h : h;
        Posture posture;
        Unreachable why;
        ASSERT_TRUE(bench.solver.reach(demand, start, posture, why)) << one.text.substr(0, 60);
        ends[side] = bench.solver.inputs(posture);
      }
      Eigen::VectorXd rate(map.b.cols());
      for (Eigen::Index i = 0; i < rate.size(); ++i) {
        const auto k = static_cast<std::size_t>(i);
        rate[i] = std::remainder(ends[1][k] - ends[0][k], 2.0 * M_PI) / (2.0 * h);
      }
      Eigen::Index column = 0;
      for (int i = 0; i < direction; ++i) column += one.kept[static_cast<std::size_t>(i)] ? 1 : 0;
      const double size = std::max(1.0, rate.cwiseAbs().maxCoeff());
      EXPECT_LT((map.b * rate - map.a.col(column)).cwiseAbs().maxCoeff(), 1e-7 * size) << one.text.substr(0, 60);
    }
  }
}

// The virtual link of a leg lengthens its coupler: with couplers of length l2 + d and the same cranks the platform
// moves by A dX = d.
TEST(VelocityMap, PlayMovesThePlatformLikeAnotherCoupler) {
  Json m = platforms::sizes("3-rrr");
  Bench bench(platforms::legs_text(m));
  const Posture posture = bench.reach(Bench::at(0.02, -0.03, 0.1));
  const std::vector<double> cranks = bench.solver.inputs(posture);
  const VelocityMap map = bench.map(posture);
  for (std::size_t leg = 0; leg < 3; ++leg) {
    constexpr double d = 1e-5;
    FramePose ends[2];
    for (int side = 0; side < 2; ++side) {
      m["l2"] = {0.24, 0.24, 0.24};
      m["l2"][leg] = 0.24 + (side == 0 ? -d : d);
      Bench other(platforms::legs_text(m, 1, {}, "{x: 0.02, y: -0.03, angle: 0.1}"));
      Demand demand;
      for (const double crank : cranks) demand.inputs.push_back(Jet::constant(crank));
      Posture moved;
      Unreachable why;
      ASSERT_TRUE(other.solver.reach(demand, other.mechanism.start(), moved, why));
      ends[side] = other.solver.frame(moved);
    }
    Eigen::Vector3d rate;
    for (int i = 0; i < 3; ++i) {
      const auto k = static_cast<std::size_t>(i);
      rate[i] = (ends[1][k] - ends[0][k]) / (2.0 * d);
    }
    const Eigen::Vector3d errors = map.a * rate;
    for (Eigen::Index r = 0; r < 3; ++r) {
      EXPECT_NEAR(errors[r], r == static_cast<Eigen::Index>(leg) ? 1.0 : 0.0, 1e-6);
    }
    // A unit play along the coupler, in B or in C, is such a lengthening.
    const Eigen::Vector2d u = map.a.block<1, 2>(static_cast<Eigen::Index>(leg), 0).transpose();
    for (const Eigen::Index play : {static_cast<Eigen::Index>(2 * leg), static_cast<Eigen::Index>(2 * leg + 1)}) {
      EXPECT_NEAR((map.c.middleCols(2 * play, 2) * u)[static_cast<Eigen::Index>(leg)], 1.0, 1e-12);
      EXPECT_NEAR((map.c.middleCols(2 * play, 2) * Eigen::Vector2d(-u[1], u[0])).norm(), 0.0, 1e-12);
    }
  }
}

TEST(Singularity, DirectWhereTheCouplersMeetInOnePoint) {
  // cos(theta) = (l4^2 + (l2 + l3)^2 - l1^2) / (2 l4 (l2 + l3)) at the centre of the symmetric mechanism.
  const double theta = -std::acos((0.16 + 0.35 * 0.35 - 0.24 * 0.24) / (2.0 * 0.4 * 0.35));
  for (const char* name : {"3-rrr", "4-rrr"}) {
    Bench bench(platforms::legs_text(platforms::sizes(name)));
    const VelocityMap map = bench.map(bench.reach(Bench::at(0.0, 0.0, theta)));
    const Singularity s = singularity_of(map, bench.mechanism.length());
    EXPECT_LT(s.sigma_min, 1e-14);
    EXPECT_EQ(s.kind, SingularityKind::direct);
    EXPECT_FALSE(clearance_error(bench.mechanism, map));
  }
}

TEST(Singularity, InverseWhereALegIsStretched) {
  Bench bench(platforms::legs_text(platforms::sizes("3-rrr")));
  // Leg 1 at (x, 0): |A C| = 0.48.
  const double a = 7.0 * M_PI / 6.0, px = -0.29 * std::cos(a), py = -0.29 * std::sin(a);
  const double x = std::sqrt(0.48 * 0.48 - py * py) - px;
  const Posture posture = bench.reach(Bench::at(x - 1e-14, 0.0, 0.0));
  const Singularity s = singularity_of(bench.map(posture), bench.mechanism.length());
  EXPECT_LT(s.inverse_min, singular_limit);
  EXPECT_EQ(s.kind, SingularityKind::inverse);
}

// Cranks of 0.1 m keep a bar parallel: x = 0.2 + 0.1 cos theta, so (dx, 0.1 dtheta, ...) = (-s, 1, ...) and the rows of
// (A, B) span what is normal to that, however many cranks are driven.
std::string parallel_cranks(const std::string& inputs) {
  return "freeplay: 1\nbodies:\n  ground: {frames: {A1: [0, 0], A2: [0.2, 0], A3: [0.4, 0]}}\n"
         "  crank1: {mass: 0.3, inertia: 1e-3, frames: {tip: [0.1, 0]}, pose: {angle: 60 deg}}\n"
         "  crank2: {mass: 0.3, inertia: 1e-3, frames: {tip: [0.1, 0]}, pose: {position: [0.2, 0], angle: 60 deg}}\n"
         "  crank3: {mass: 0.3, inertia: 1e-3, frames: {tip: [0.1, 0]}, pose: {position: [0.4, 0], angle: 60 deg}}\n"
         "  bar: {mass: 0.9, inertia: 6e-3, frames: {B1: [0, 0], B2: [0.2, 0], B3: [0.4, 0]}, "
         "pose: {position: [0.05, 0.0866025403784]}}\njoints:\n"
         "  A1: {type: revolute, between: [ground/A1, crank1]}\n  A2: {type: revolute, between: [ground/A2, crank2]}\n"
         "  A3: {type: revolute, between: [ground/A3, crank3]}\n  B1: {type: revolute, between: [crank1/tip, bar/B1]}\n"
         "  B2: {type: revolute, between: [crank2/tip, bar/B2]}\n  B3: {type: revolute, between: [crank3/tip, "
         "bar/B3]}\n"
         "drivers: {motor: {joint: A1, kind: angle, value: 60 deg}}\nanalysis: {frame: bar/B2, joints: [" +
         inputs + "], error: {clearance: {B3: 0.1 mm}}}\nsimulation: {end: 1 s, step: 1 ms}\n";
}

TEST(Singularity, OfOneOutputDoesNotDependOnTheChoiceOfRows) {
  for (const auto& [inputs, count] : {std::pair{"A1", 1}, {"A1, A3", 2}, {"A1, A2, A3", 3}}) {
    Bench bench(parallel_cranks(inputs));
    for (const double x : {0.21, 0.25, 0.2999}) {
      Demand demand = Bench::at(x, 0.0, 0.0);
      demand.given = {true, false, false};
      const VelocityMap map = bench.map(bench.reach(demand), {true, false, false});
      const Singularity s = singularity_of(map, bench.mechanism.length());
      const double c = (x - 0.2) / 0.1, sine = 1.0 - c * c;
      EXPECT_NEAR(s.sigma_min, std::sqrt(count / (count + sine)), 1e-9) << inputs;
      EXPECT_NEAR(s.inverse_min, std::sqrt(sine / (count + sine)), 1e-9) << inputs;
      EXPECT_EQ(s.sigma_max, s.sigma_min);
    }
  }
}

TEST(Singularity, OfAnAngleAndAPositionHasRowsOfLengthOne) {
  Bench bench(test::mechanism("five-bar"));
  const Components kept{true, false, true};
  const VelocityMap map = bench.map(bench.mechanism.start(), kept);
  ASSERT_EQ(map.a.rows(), 2);
  for (Eigen::Index r = 0; r < 2; ++r) {
    EXPECT_NEAR(std::hypot(map.a(r, 0), map.a(r, 1) / bench.mechanism.length()), 1.0, 1e-12);
  }
}

TEST(Singularity, JointsThatAddNothingChangeNothing) {
  const std::string plain = platforms::legs_text(platforms::sizes("3-rrr"));
  const std::string joint = "  B0: {type: revolute, between: [crank0/tip, coupler0]}\n";
  Bench bench(plain), doubled(test::replaced(plain, joint, joint + "  B0again" + joint.substr(4)));
  const Posture posture = bench.reach(Bench::at(0.05, 0.02, 0.1));
  const VelocityMap map = bench.map(posture), twice = doubled.map(posture);
  EXPECT_EQ(map.a.rows() + 2, twice.a.rows());
  const Singularity s = singularity_of(map, bench.mechanism.length());
  const Singularity t = singularity_of(twice, doubled.mechanism.length());
  EXPECT_NEAR(s.sigma_min, t.sigma_min, 1e-12);
  EXPECT_NEAR(s.sigma_max, t.sigma_max, 1e-12);
  EXPECT_NEAR(s.inverse_min, t.inverse_min, 1e-12);
}

TEST(PlaySamples, AreNoneWhereEveryRimCannotBeTouched) {
  // Two driven cranks hold the bar, and the loose pin in the middle of its play.
  Bench bench(parallel_cranks("A1, A3"));
  Demand demand = Bench::at(0.23, 0.0, 0.0);
  demand.given = {true, false, false};
  const VelocityMap map = bench.map(bench.reach(demand));
  EXPECT_TRUE(sample_play(bench.mechanism, map, 10, 1));
  EXPECT_FALSE(sample_play(bench.mechanism, map, 10, 1, {PlayLaw::Kind::rim}));
}

TEST(Mobility, CountsFreedomsAndRedundantDrivers) {
  for (const auto& [name, freedoms, redundant] :
       {std::tuple{"3-rrr", 3, 0}, {"4-rrr", 3, 1}, {"five-bar", 2, 0}, {"3-rpr", 3, 0}}) {
    Bench bench(test::mechanism(name));
    const GeneralMobility mobility = general_mobility(bench.solver, 0.0, bench.mechanism.start());
    EXPECT_EQ(mobility.general.freedoms, freedoms) << name;
    EXPECT_EQ(mobility.general.redundant_inputs, redundant) << name;
    EXPECT_EQ(mobility.general.held, 0) << name;
    EXPECT_FALSE(mobility.special()) << name;
    EXPECT_GT(mobility.configurations, 3) << name;
  }
}

TEST(Mobility, IsSpecialWhereHeldInputsLeaveAFreedom) {
  Bench bench(test::mechanism("3-rpr"));
  const Posture centre = bench.reach(Bench::at(0.0, 0.0, 0.0));
  const GeneralMobility mobility = general_mobility(bench.solver, 0.0, centre);
  EXPECT_EQ(mobility.here.held, 1);
  EXPECT_EQ(mobility.general.held, 0);
  EXPECT_TRUE(mobility.special());
}

std::string trajectory_path(const Json& t) {
  const auto value = [&](const char* key, double fallback) {
    return t.contains(key) ? t[key].get<double>() : fallback;
  };
  const double w = 2.0 * M_PI / value("T", 0.5);
  return fmt::format(
      "{{x: \"{0:.17g}*cos({1:.17g}*t)\", y: \"{0:.17g}*sin({1:.17g}*t)\", angle: \"{2} + {3}*sin({4}*{1:.17g}*t)\"}}",
      value("R", 0.05), w, value("th0", 0.0), value("th_amp", 0.0), value("th_mult", 1.0));
}

TEST(InverseDynamics, TorquesAreThoseOfVirtualWork) {
  for (const Json& entry : platforms::numbers()["inverse_dynamics"]) {
    Bench bench(platforms::legs_text(
        platforms::sizes(entry["mechanism"]), 1, {}, trajectory_path(entry["trajectory"]),
        fmt::format("[{}, {}]", entry["gravity"][0].get<double>(), entry["gravity"][1].get<double>())));
    const Station station = along_path(bench.mechanism, GridValues::one(entry["t"])).front();
    std::vector<double> v, a;
    ASSERT_TRUE(bench.solver.rates(station.demand, station.posture, v, a));
    InverseDynamics dynamics(bench.solver);
    Efforts efforts, loaded;
    ASSERT_EQ(dynamics.solve(station.time, station.posture, v, a, 0.0, efforts), InverseDynamics::Found::yes);
    double largest = 0.0;
    for (const Json& torque : entry["torque"]) largest = std::max(largest, std::abs(torque.get<double>()));
    for (std::size_t i = 0; i < efforts.input.size(); ++i) {
      EXPECT_NEAR(efforts.input[i], entry["torque"][i], 1e-8 * largest);
    }
    if (entry.contains("force_on_platform_at_C")) {
      for (std::size_t i = 0; i < efforts.input.size(); ++i) {
        for (std::size_t c = 0; c < 2; ++c) {
          EXPECT_NEAR(efforts.wrench[3 * i + 2][c], entry["force_on_platform_at_C"][i][c], 1e-8 * 10.0);
        }
      }
    }
    const auto found = dynamics.solve(station.time, station.posture, v, a, 0.5, loaded);
    if (!entry.contains("null_torque")) {
      EXPECT_EQ(found, InverseDynamics::Found::no_preload);
      continue;
    }
    ASSERT_EQ(found, InverseDynamics::Found::yes);
    for (std::size_t i = 0; i < efforts.input.size(); ++i) {
      EXPECT_NEAR(loaded.input[i] - efforts.input[i], 0.5 * entry["null_torque"][i].get<double>(), 1e-9);
    }
  }
}

TEST(InverseDynamics, PushesLegsOfVariableLength) {
  // By absolute coordinates: positive force makes the leg longer.
  const double force[3] = {-6.16170145591126, -1.50291505355381, 7.91053515395606};
  Bench bench(test::mechanism("3-rpr"));
  const Station station = along_path(bench.mechanism, GridValues::one(0.1)).front();
  std::vector<double> v, a;
  ASSERT_TRUE(bench.solver.rates(station.demand, station.posture, v, a));
  Efforts efforts;
  ASSERT_EQ(InverseDynamics(bench.solver).solve(0.1, station.posture, v, a, 0.0, efforts), InverseDynamics::Found::yes);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(efforts.input[i], force[i], 1e-8 * 7.9);
}

}  // namespace
}  // namespace freeplay
