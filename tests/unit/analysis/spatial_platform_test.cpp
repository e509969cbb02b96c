// Platforms in space: poses, freedoms, and errors by clearance, against formulas written down here.
#include <random>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "analysis/mobility.h"
#include "analysis/play_samples.h"
#include "platforms.h"

namespace freeplay {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Six = Eigen::Matrix<double, 6, 1>;
using platforms::Bench;

Matrix3d turned(double roll, double pitch, double yaw) {
  return (Eigen::AngleAxisd(yaw, Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch, Vector3d::UnitY()) *
          Eigen::AngleAxisd(roll, Vector3d::UnitX()))
      .toRotationMatrix();
}
std::string text(const Vector3d& v) { return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v[0], v[1], v[2]); }

/// Six legs from B_k on the ground to P_k on the platform; a universal joint below, a slide, a ball above.
struct Stewart {
  std::array<Vector3d, 6> base, top;
  std::array<double, 6> play{};
  double backlash = 0.0;
  static constexpr double height = 0.6, rod = 0.3;

  Stewart() {
    for (std::size_t k = 0; k < 6; ++k) {
      const double side = k % 2 == 0 ? 1.0 : -1.0, third = 2.0 * M_PI / 3.0 * std::floor(static_cast<double>(k) / 2.0);
      base[k] = 0.5 * Vector3d(std::cos(third + side * 0.9), std::sin(third + side * 0.9), 0.02 * side);
      top[k] = Vector3d(0.25 * std::cos(third + side * 0.25), 0.2 * std::sin(third + side * 0.25), -0.03);
    }
  }

  std::string model(const char* lower = "universal", const std::string& between = "") const {
    std::string bodies =
        fmt::format("  platform: {{mass: 5, inertia: [0.1, 0.12, 0.2], pose: {{position: [0, 0, {}]}}}}\n", height);
    std::string frames, joints, drivers;
    for (std::size_t k = 0; k < 6; ++k) {
      const Vector3d leg = top[k] + height * Vector3d::UnitZ() - base[k], u = leg.normalized();
      const std::string rpy = fmt::format("rpy: [0, {:.17g}, {:.17g}]", -std::asin(u[2]), std::atan2(u[1], u[0]));
      bodies += fmt::format(
          "  low{}: {{mass: 0.8, inertia: [1e-4, 0.01, 0.01], com: [0.15, 0, 0], pose: {{position: {}, {}}}}}\n", k,
          text(base[k]), rpy);
      bodies += fmt::format(
          "  rod{}: {{mass: 0.5, inertia: [1e-4, 0.008, 0.008], com: [0.15, 0, 0], frames: {{end: [{}, 0, 0]}}, "
          "pose: {{position: {}, {}}}}}\n",
          k, rod, text(base[k] + leg - rod * u), rpy);
      frames += fmt::format("  ground/B{0}: {{position: {1}, rpy: [0, 0, {3:.17g}]}}\n  platform/P{0}: {2}\n", k,
                            text(base[k]), text(top[k]), std::atan2(u[1], u[0]));
      const std::string clearance =
          play[k] > 0.0
              ? fmt::format(
                    ", clearance: {{radial_clearance: {}, bearing_radius: 10 mm, contact: {{law: hertz, K: 1e9}}}}",
                    play[k])
              : "";
      joints += fmt::format(
          "  U{0}: {{type: {1}, between: [ground/B{0}, low{0}]}}\n"
          "  L{0}: {{type: prismatic, between: [low{0}, rod{0}]}}\n"
          "  S{0}: {{type: spherical, between: [rod{0}/end, platform/P{0}]{2}}}\n",
          k, lower, clearance);
      drivers += fmt::format("  D{0}: {{joint: L{0}, kind: position, value: {1:.17g}}}\n", k, leg.norm() - rod);
    }
    return "freeplay: 1\nspace: spatial\ngravity: [0, 0, -9.81]\nbodies:\n" + bodies + "frames:\n" + frames +
           "joints:\n" + joints + "drivers:\n" + drivers + between +
           fmt::format("analysis: {{frame: platform, error: {{input: {}}}}}\n", backlash);
  }

  Vector3d leg(std::size_t k, const Six& pose) const {
    return pose.head<3>() + turned(pose[3], pose[4], pose[5]) * top[k] - base[k];
  }
  /// dl_k = u_k . (dp + dtheta x b_k): rows [u_k, b_k x u_k].
  Eigen::Matrix<double, 6, 6> jacobian(const Six& pose) const {
    Eigen::Matrix<double, 6, 6> out;
    for (std::size_t k = 0; k < 6; ++k) {
      const Vector3d u = leg(k, pose).normalized(), b = turned(pose[3], pose[4], pose[5]) * top[k];
      out.row(static_cast<Eigen::Index>(k)) << u.transpose(), b.cross(u).transpose();
    }
    return out;
  }
};

Demand at(const Six& pose) {
  Demand demand;
  for (std::size_t i = 0; i < 6; ++i) {
    demand.given[i] = true;
    demand.pose[i] = Jet::constant(pose[static_cast<Eigen::Index>(i)]);
  }
  return demand;
}
const std::array<Six, 4>& poses() {
  static const std::array<Six, 4> all = [] {
    std::array<Six, 4> out;
    out[0] << 0.0, 0.0, 0.6, 0.0, 0.0, 0.0;
    out[1] << 0.03, -0.02, 0.63, 0.1, -0.05, 0.2;
    out[2] << -0.05, 0.04, 0.55, -0.2, 0.15, -0.3;
    out[3] << 0.0, 0.02, 0.7, 0.0, 0.25, 0.1;
    return out;
  }();
  return all;
}
VelocityMap whole_map(Bench& bench, const Posture& posture) { return bench.map(posture, bench.mechanism.form().all()); }

TEST(SpatialPlatform, LegLengthsOfAStewartPlatformAreThoseOfItsPose) {
  const Stewart stewart;
  for (const char* lower : {"universal", "spherical"}) {
    Bench bench(stewart.model(lower));
    for (const Six& pose : poses()) {
      const Posture posture = bench.reach(at(pose));
      const std::vector<double> inputs = bench.solver.inputs(posture);
      for (std::size_t k = 0; k < 6; ++k) {
        EXPECT_NEAR(inputs[k], stewart.leg(k, pose).norm() - Stewart::rod, 1e-10) << lower;
      }
      const FramePose frame = bench.solver.frame(posture);
      for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(frame[i], pose[static_cast<Eigen::Index>(i)], 1e-12);
    }
  }
}

// The direct problem, and the way back.
TEST(SpatialPlatform, LegLengthsLeadToThePoseThatHasThem) {
  const Stewart stewart;
  Bench bench(stewart.model());
  for (const Six& pose : poses()) {
    Demand demand;
    for (std::size_t k = 0; k < 6; ++k) {
      demand.inputs.push_back(Jet::constant(stewart.leg(k, pose).norm() - Stewart::rod));
    }
    const FramePose frame = bench.solver.frame(bench.reach(demand));
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(frame[i], pose[static_cast<Eigen::Index>(i)], 1e-9);
  }
}

// Where roll and yaw turn about one axis the numbers of the pose are not unique, but the pose is.
TEST(SpatialPlatform, ReachesAPitchOfAQuarterTurn) {
  Bench bench(
      "freeplay: 1\nspace: spatial\n"
      "bodies:\n  a: {mass: 1, inertia: [1, 1, 1]}\n  b: {mass: 1, inertia: [1, 1, 1]}\n  c: {mass: 1, inertia: [1, 1, "
      "1]}\n"
      "joints:\n  A: {type: revolute, between: [ground, a]}\n  B: {type: revolute, between: [a, b], axis: [0, 1, 0]}\n"
      "  C: {type: revolute, between: [b, c], axis: [1, 0, 0]}\n"
      "analysis: {frame: c, joints: [A, B, C]}\ninitial: {joints: {A: 0.1, B: 0.2, C: 0.3}}\n");
  Demand demand;
  for (std::size_t i = 3; i < 6; ++i) demand.given[i] = true;
  demand.pose[3] = Jet::constant(0.4), demand.pose[4] = Jet::constant(0.5 * M_PI), demand.pose[5] = Jet::constant(0.9);
  // A redundant demand of nothing else: three turns on three axes that meet.
  const FramePose frame = bench.solver.frame(bench.reach(demand));
  EXPECT_LT((turned(frame[3], frame[4], frame[5]) - turned(0.4, 0.5 * M_PI, 0.9)).norm(), 1e-8);
}

TEST(SpatialPlatform, CountsFreedomsByRank) {
  const Stewart stewart;
  for (const auto& [lower, spins] : {std::pair{"universal", 0}, {"spherical", 6}}) {
    Bench bench(stewart.model(lower));
    const GeneralMobility mobility = general_mobility(bench.solver, 0.0, bench.mechanism.start());
    EXPECT_EQ(mobility.general.freedoms, 6 + spins);
    EXPECT_EQ(mobility.general.platform, 6);
    EXPECT_EQ(mobility.general.platform_held, 0);
    EXPECT_EQ(mobility.idle(), spins);
    EXPECT_EQ(mobility.general.redundant_rows, 0);
    EXPECT_FALSE(mobility.special());
  }
}

// A leg feels only what lies along it, so that its play and its driver's error add up; the errors fill the image of a
// box.
TEST(SpatialPlatform, ErrorsOfAStewartPlatformAreThoseOfItsLegLengths) {
  Stewart stewart;
  stewart.play = {1e-4, 2e-4, 0.5e-4, 1e-4, 3e-4, 1.5e-4};
  stewart.backlash = 4e-5;
  for (const char* lower : {"universal", "spherical"}) {
    Bench bench(stewart.model(lower));
    for (const Six& pose : poses()) {
      const auto error = clearance_error(bench.mechanism, whole_map(bench, bench.reach(at(pose))));
      ASSERT_TRUE(error);
      const MatrixXd inverse = MatrixXd(stewart.jacobian(pose)).inverse();
      Six widths;
      for (std::size_t k = 0; k < 6; ++k) widths[static_cast<Eigen::Index>(k)] = stewart.play[k] + stewart.backlash;
      for (Eigen::Index i = 0; i < 6; ++i) {
        const double expected = inverse.row(i).cwiseAbs().dot(widths);
        EXPECT_NEAR(error->exact.change[static_cast<std::size_t>(i)], expected, 1e-9 * expected);
      }
      double position = 0.0, turn = 0.0;
      for (unsigned corner = 0; corner < 64; ++corner) {
        Six d = widths;
        for (unsigned k = 0; k < 6; ++k) {
          if (corner >> k & 1u) d[k] = -d[k];
        }
        const Six x = inverse * d;
        position = std::max(position, x.head<3>().norm());
        turn = std::max(turn, x.tail<3>().norm());
      }
      EXPECT_NEAR(error->exact.position, position, 1e-9 * position);
      EXPECT_NEAR(error->exact.dangle, turn, 1e-9 * turn);
      EXPECT_NEAR(error->exact.worst.head<3>().norm(), position, 1e-9 * position);
      double shares = 0.0;
      for (std::size_t k = 0; k < 6; ++k) {
        shares += error->sensitivity[k] * stewart.play[k] + error->sensitivity[6 + k] * stewart.backlash;
      }
      EXPECT_NEAR(shares, position, 1e-9 * position);
    }
  }
}

TEST(SpatialPlatformLong, SamplesStayWithinTheBoundAndComeNearIt) {
  Stewart stewart;
  stewart.play = {1e-4, 2e-4, 0.5e-4, 1e-4, 3e-4, 1.5e-4};
  stewart.backlash = 4e-5;
  Bench bench(stewart.model());
  const VelocityMap map = whole_map(bench, bench.reach(at(poses()[1])));
  const auto error = clearance_error(bench.mechanism, map);
  ASSERT_TRUE(error);
  for (const auto kind : {PlayLaw::Kind::uniform, PlayLaw::Kind::rim, PlayLaw::Kind::normal}) {
    const PlayLaw law{kind, 0.5};
    const auto samples = sample_play(bench.mechanism, map, 200'000, 7, law);
    const auto variances = least_squares_play(bench.mechanism, map, law);
    ASSERT_TRUE(samples && variances);
    EXPECT_LE(samples->max_position, error->exact.position);
    EXPECT_LE(samples->max_dangle, error->exact.dangle);
    EXPECT_GE(samples->max_position, 0.6 * error->exact.position);
    EXPECT_NEAR(samples->rms_position, variances->rms_position, 5e-3 * variances->rms_position);  // 2/sqrt(samples)
    EXPECT_NEAR(samples->rms_dangle, variances->rms_dangle, 5e-3 * variances->rms_dangle);
  }
  // Balls drawn here and the formula of the legs: never beyond, and with all play along the legs nearly there.
  std::mt19937_64 engine(3);
  const auto uniform = [&] { return 2.0 * static_cast<double>(engine() >> 11) * 0x1.0p-53 - 1.0; };
  const MatrixXd inverse = MatrixXd(stewart.jacobian(poses()[1])).inverse();
  Six most = Six::Zero();
  for (int i = 0; i < 300'000; ++i) {
    Six d;
    for (std::size_t k = 0; k < 6; ++k) {
      const Vector3d u = stewart.leg(k, poses()[1]).normalized();
      Vector3d delta(uniform(), uniform(), uniform());
      if (i % 2 == 0) delta = (delta[0] < 0.0 ? -1.0 : 1.0) * u + 0.05 * delta;
      if (delta.norm() > 1.0) delta.normalize();
      const double driver = i % 2 == 0 ? std::copysign(1.0, delta.dot(u)) : uniform();
      d[static_cast<Eigen::Index>(k)] = stewart.play[k] * delta.dot(u) + stewart.backlash * driver;
    }
    const Six x = inverse * d;
    EXPECT_LE(x.head<3>().norm(), error->exact.position * (1.0 + 1e-12));
    most = most.cwiseMax(x.cwiseAbs());
  }
  for (Eigen::Index i = 0; i < 6; ++i) {
    const double bound = error->exact.change[static_cast<std::size_t>(i)];
    EXPECT_LE(most[i], bound * (1.0 + 1e-12));
    EXPECT_GE(most[i], 0.99 * bound);
  }
}

// Legs that are changed in earnest move the platform as the first order says, up to the second.
TEST(SpatialPlatform, FirstOrderAgreesWithLegsThatAreChanged) {
  const Stewart stewart;
  Bench bench(stewart.model());
  const Six& pose = poses()[2];
  const MatrixXd inverse = MatrixXd(stewart.jacobian(pose)).inverse();
  const VelocityMap map = whole_map(bench, bench.reach(at(pose)));
  const MatrixXd by_input = map.a.inverse() * map.b;
  EXPECT_LT((by_input - inverse).norm(), 1e-9 * inverse.norm());
  const double step = 1e-4;
  for (std::size_t k = 0; k < 6; ++k) {
    Six ends[2];
    for (const int side : {0, 1}) {
      Demand demand;
      for (std::size_t i = 0; i < 6; ++i) {
        const double change = i == k ? (side == 0 ? -step : step) : 0.0;
        demand.inputs.push_back(Jet::constant(stewart.leg(i, pose).norm() - Stewart::rod + change));
      }
      const FramePose frame = bench.solver.frame(bench.reach(demand));
      ends[side] = Eigen::Map<const Six>(frame.data());
    }
    Six change;
    change.head<3>() = (ends[1] - ends[0]).head<3>() / (2.0 * step);
    const Matrix3d turn =
        turned(ends[1][3], ends[1][4], ends[1][5]) * turned(ends[0][3], ends[0][4], ends[0][5]).transpose();
    const Eigen::AngleAxisd angle(turn);
    change.tail<3>() = angle.angle() * angle.axis() / (2.0 * step);
    const Six expected = inverse.col(static_cast<Eigen::Index>(k));
    EXPECT_LT((change - expected).norm(), 1e-5 * expected.norm());  // second differences, (step/size)^2
  }
}

// A body on a bearing of length L with radial play c and axial play a, kept from turning by a rod of a slide: shift
// (e+ + e-)/2 across and e_z along the axis, tilt (e+ - e-)/L.
TEST(SpatialPlatformLong, PlayOfABearingWithLengthShiftsAndTilts) {
  const double c = 1e-4, a = 3e-4, length = 0.05, arm = 0.2, input = 2e-4;
  const auto model = [&](double height) {
    return fmt::format(
        "freeplay: 1\nspace: spatial\n"
        "bodies:\n  wheel: {{mass: 1, inertia: [1e-3, 1e-3, 1e-3], frames: {{tip: [{1}, 0, 0], high: [0, 0, {0}]}}}}\n"
        "  slide: {{mass: 1, inertia: [1e-3, 1e-3, 1e-3], pose: {{position: [{1}, -0.3, 0]}}}}\n"
        "frames: {{ground/rail: {{position: [{1}, -0.3, 0], rpy: [0, 0, 90 deg]}}}}\n"
        "joints:\n  B: {{type: revolute, between: [ground, wheel], clearance: {{radial_clearance: {2}, bearing_radius: "
        "10 mm, "
        "length: {3}, axial_clearance: {4}, contact: {{law: hertz, K: 1e9}}}}}}\n"
        "  R: {{type: prismatic, between: [ground/rail, slide]}}\n"
        "  D: {{type: distance, between: [slide, wheel/tip], length: 0.3}}\n"
        "drivers: {{push: {{joint: R, kind: position, value: 0}}}}\n"
        "analysis: {{frame: wheel/high, error: {{input: {5}}}}}\n",
        height, arm, c, length, a, input);
  };
  for (const double height : {0.0, 0.01, 0.3}) {
    Bench bench(model(height));
    ASSERT_EQ(bench.mechanism.plays().size(), 3u);
    const auto error = clearance_error(bench.mechanism, whole_map(bench, bench.mechanism.start()));
    ASSERT_TRUE(error);
    const double shift = c * (std::abs(0.5 + height / length) + std::abs(0.5 - height / length));
    const double expected[6] = {shift, shift, a, 2.0 * c / length, 2.0 * c / length, (c + input) / arm};
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(error->exact.change[i], expected[i], 1e-9 * expected[i]) << i;
    EXPECT_NEAR(error->exact.position, std::hypot(shift, a), 1e-7 * shift);
  }
}

// Play goes with the bearing, however that stands in the world.
TEST(SpatialPlatform, PlayOfABearingIsAlongItsOwnAxes) {
  const auto model = [](const std::string& turn) {
    return "freeplay: 1\nspace: spatial\n"
           "bodies:\n  seat: {mass: 1, inertia: [1, 1, 1], pose: {rpy: " +
           turn +
           "}, frames: {rail: {position: [0.2, -0.3, 0], rpy: [0, 0, 90 deg]}}}\n"
           "  wheel: {mass: 1, inertia: [1, 1, 1], frames: {tip: [0.2, 0, 0], far: [0.1, 0.05, 0.3]}, pose: {rpy: " +
           turn +
           "}}\n"
           "  slide: {mass: 1, inertia: [1, 1, 1]}\n"
           "frames: {ground/base: {rpy: " +
           turn +
           "}}\n"
           "joints:\n  F: {type: fixed, between: [ground/base, seat]}\n"
           "  B: {type: revolute, between: [seat, wheel], clearance: {radial_clearance: 0.1 mm, bearing_radius: 10 mm, "
           "length: 50 mm, "
           "axial_clearance: 0.7 mm, contact: {law: hertz, K: 1e9}}}\n"
           "  R: {type: prismatic, between: [seat/rail, slide]}\n"
           "  D: {type: distance, between: [slide, wheel/tip], length: 0.3}\n"
           "drivers: {push: {joint: R, kind: position, value: 0}}\n"
           "initial: {joints: {B: 0}}\n"
           "analysis: {frame: wheel/far}\n";
  };
  Bench straight(model("[0, 0, 0]")), turned_by(model("[0.4, -0.7, 1.1]"));
  const auto first = clearance_error(straight.mechanism, whole_map(straight, straight.mechanism.start()));
  const auto second = clearance_error(turned_by.mechanism, whole_map(turned_by, turned_by.mechanism.start()));
  ASSERT_TRUE(first && second);
  EXPECT_NEAR(first->exact.position, second->exact.position, 2e-7 * first->exact.position);
  EXPECT_NEAR(first->exact.dangle, second->exact.dangle, 2e-7 * first->exact.dangle);
  const Vector3d expected = turned(0.4, -0.7, 1.1) * first->exact.worst.head<3>();
  EXPECT_NEAR(std::abs(expected.dot(second->exact.worst.head<3>())), expected.squaredNorm(),
              1e-6 * expected.squaredNorm());
}

// h is the distance of support of balls and segments; the farthest point of each is known.
TEST(FeasibleSet, FarthestPointsOfKnownSetsInSpace) {
  const auto set = [](double radius, const Vector3d& half) {
    return [radius, half](const Vector3d& n, Vector3d& p) {
      const double along = n.dot(half);
      p = radius * n + (along < 0.0 ? -half : half);
      return radius + std::abs(along);
    };
  };
  Vector3d direction;
  for (const Vector3d& half : {Vector3d(0.3, -0.5, 0.2), Vector3d(0.0, 0.0, 1.0), Vector3d(1e-3, 2.0, -1.0)}) {
    EXPECT_NEAR(farthest(set(0.1, half), direction), 0.1 + half.norm(), 1e-12);
    EXPECT_NEAR(std::abs(direction.dot(half.normalized())), 1.0, 1e-12);
  }
  // A ball is as far in all directions: nothing but the bound is left to say so.
  const double ball = farthest(set(1.0, Vector3d::Zero()), direction);
  EXPECT_GE(ball, 1.0);
  EXPECT_LE(ball, 1.0 + 1e-4);
}

TEST(SpatialPlatform, WorkingModesAreRefusedAtTheirPlace) {
  const Stewart stewart;
  const std::string model = test::replaced(stewart.model(), "frame: platform,", "frame: platform, elbow: 1,");
  const auto text = [&] {
    try {
      test::load(model);
    } catch (const std::exception& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  }();
  EXPECT_NE(text.find("work in planar models only [type-space]"), std::string::npos) << text;
}

}  // namespace
}  // namespace freeplay
