#include "analysis/clearance_error.h"

#include <random>

#include <gtest/gtest.h>

#include "analysis/play_samples.h"
#include "analysis/station.h"
#include "unit/analysis/platforms.h"

namespace freeplay {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using platforms::Bench;

void expect_bound(const WorstCase& got, const Json& want) {
  const double values[4] = {got.position, got.dangle, got.change[0], got.change[1]};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(values[i], want[i], 1e-9 * want[i].get<double>()) << i;
}

TEST(ClearanceError, BothBoundsAreThoseOfVerticesAndPrograms) {
  for (const Json& entry : platforms::numbers()["error"]) {
    Bench bench(platforms::legs_text(platforms::sizes(entry["mechanism"]), entry["elbow"],
                                     {entry["clearance_B"], entry["clearance_C"], entry["backlash"]}));
    const VelocityMap map = bench.map(bench.reach(platforms::pose_of(entry["pose"])));
    const auto error = clearance_error(bench.mechanism, map);
    ASSERT_TRUE(error);
    expect_bound(error->exact, entry["exact"]);
    expect_bound(error->least_squares, entry["least_squares"]);
    if (entry.contains("rms")) {
      const auto rms = least_squares_play(bench.mechanism, map);
      EXPECT_NEAR(rms->rms_position, entry["rms"][0], 1e-13);
      EXPECT_NEAR(rms->rms_dangle, entry["rms"][1], 1e-12);
    }
  }
}

TEST(ClearanceError, SharesOfTheJointsAddUpToTheWorstError) {
  for (const Json& entry : platforms::numbers()["error"]) {
    Bench bench(platforms::legs_text(platforms::sizes(entry["mechanism"]), entry["elbow"],
                                     {entry["clearance_B"], entry["clearance_C"], entry["backlash"]}));
    const auto error = clearance_error(bench.mechanism, bench.map(bench.reach(platforms::pose_of(entry["pose"]))));
    const std::size_t legs = bench.mechanism.platform().inputs.size();
    double sum = 0.0;
    for (std::size_t leg = 0; leg < legs; ++leg) {
      const double share = entry["clearance_B"].get<double>() * error->sensitivity[2 * leg] +
                           entry["clearance_C"].get<double>() * error->sensitivity[2 * leg + 1] +
                           entry["backlash"].get<double>() * error->sensitivity[2 * legs + leg];
      if (entry.contains("share")) {
        EXPECT_NEAR(share, entry["share"][leg], 1e-9 * error->exact.position);
      }
      sum += share;
    }
    EXPECT_NEAR(sum, error->exact.position, 1e-12 * sum);
  }
}

TEST(ClearanceError, SensitivityIsTheDerivativeByThePlayLong) {
  for (const char* name : {"3-rpr", "five-bar"}) {
    const auto at = [&](const std::string& joint, double change) {
      Bench bench(test::mechanism(name));
      const Posture posture = bench.mechanism.start();
      const VelocityMap map = bench.map(posture);
      std::vector<Generator> generators = generators_of(bench.mechanism, map);
      for (std::size_t p = 0; p < bench.mechanism.plays().size(); ++p) {
        const int j = bench.mechanism.plays()[p].joint;
        if (bench.model->joints[static_cast<std::size_t>(j)].name == joint) generators[p].size += change;
      }
      return exact_worst_case(map.a, generators).position;
    };
    Bench bench(test::mechanism(name));
    const auto error = clearance_error(bench.mechanism, bench.map(bench.mechanism.start()));
    ASSERT_TRUE(error);
    for (std::size_t p = 0; p < bench.mechanism.plays().size(); ++p) {
      const std::string joint = bench.model->joints[static_cast<std::size_t>(bench.mechanism.plays()[p].joint)].name;
      constexpr double h = 1e-8;
      EXPECT_NEAR((at(joint, h) - at(joint, -h)) / (2.0 * h), error->sensitivity[p], 1e-6) << joint;
    }
  }
}

TEST(ClearanceError, HoldsForJointsThatPushInTwoDirections) {
  // Four-bar and five-bar, by sum of c_k |G_k^T n| over the inverse constraint Jacobian, scan and refinement.
  struct Case {
    std::string text;
    std::vector<double> inputs;
    double position, dx, dy, dangle;
  };
  const std::string four_bar = test::replaced(
      test::replaced(test::mechanism("four-bar"), "tip: [0.3, 0]", "tip: [0.3, 0], P: [0.15, 0.08]"), "simulation:",
      "analysis: {frame: coupler/P, error: {clearance: {B: 0.1 mm, C: 0.1 mm, D: 0.1 mm}}}\nsimulation:");
  for (const Case& one : {Case{four_bar,
                               {1.0471975511966},
                               0.000192070226025067,
                               0.00019102129823358,
                               0.000133670465647548,
                               0.00101144347484835},
                          Case{test::mechanism("five-bar"),
                               {1.9, 1.1},
                               0.000253479893352514,
                               0.000187289065157101,
                               0.000247049034764378,
                               0.0015505534956769}}) {
    Bench bench(one.text);
    Demand demand;
    for (const double input : one.inputs) demand.inputs.push_back(Jet::constant(input));
    const auto error = clearance_error(bench.mechanism, bench.map(bench.reach(demand)));
    ASSERT_TRUE(error);
    EXPECT_NEAR(error->exact.position, one.position, 1e-10 * one.position);
    EXPECT_NEAR(error->exact.change[0], one.dx, 1e-9 * one.dx);
    EXPECT_NEAR(error->exact.change[1], one.dy, 1e-9 * one.dy);
    EXPECT_NEAR(error->exact.dangle, one.dangle, 1e-9 * one.dangle);
  }
}

TEST(ClearanceError, LargestOverAGridIsTheKnownOne) {
  // 61 x 61 poses within +-0.15 m: reachable points, exact and least-squares position, exact orientation.
  struct Case {
    const char* name;
    long reachable;
    double exact, least_squares, orientation;
  };
  for (const Case& one : {Case{"3-rrr", 3683, 0.000896697820368297, 0.000896697820368296, 0.00788214845841926},
                          Case{"4-rrr", 3609, 0.000333977798999676, 0.000335234678063989, 0.00292226153463916}}) {
    Bench bench(platforms::legs_text(platforms::sizes(one.name)));
    const GridValues axis{{}, -0.15, 0.15, 61, false};
    const std::array<GridValues, 3> axes{axis, axis, GridValues::one(0.0)};
    const auto stations = on_grid(bench.mechanism, axes, {true, true, true}, 2);
    long reachable = 0;
    double exact = 0.0, least_squares = 0.0, orientation = 0.0;
    for (const Station& station : stations) {
      if (!station.reachable) continue;
      ++reachable;
      const auto error = clearance_error(bench.mechanism, bench.map(station.posture));
      if (!error) continue;
      EXPECT_GE(error->least_squares.position, error->exact.position * (1.0 - 1e-12));
      exact = std::max(exact, error->exact.position);
      least_squares = std::max(least_squares, error->least_squares.position);
      orientation = std::max(orientation, error->exact.dangle);
    }
    EXPECT_EQ(reachable, one.reachable);
    EXPECT_NEAR(exact, one.exact, 1e-9 * exact);
    EXPECT_NEAR(least_squares, one.least_squares, 1e-9 * least_squares);
    EXPECT_NEAR(orientation, one.orientation, 1e-9 * orientation);
  }
}

// The links of every joint at their ends along the couplers, in random signs; the fourth leg must close. A million
// draws for each mechanism.
TEST(ClearanceError, NoFeasibleSampleExceedsItAndSomeComeNear) {
  for (const char* name : {"3-rrr", "4-rrr"}) {
    Bench bench(platforms::legs_text(platforms::sizes(name)));
    const VelocityMap map = bench.map(bench.reach(Bench::at(0.05, 0.05, 0.0)));
    const auto error = clearance_error(bench.mechanism, map);
    ASSERT_TRUE(error);
    const int legs = static_cast<int>(map.a.rows());
    // Three legs err as they like; any leg may be the one that follows. Plain arrays, for tests are not optimised.
    double inverse[4][3][3], rows[4][3];
    for (int follower = 0; follower < 4; ++follower) {
      Eigen::Matrix3d three;
      for (int leg = 0, row = 0; leg < legs && row < 3; ++leg) {
        if (leg == follower && legs == 4) continue;
        three.row(row++) = map.a.row(leg);
      }
      const Eigen::Matrix3d inverted = three.inverse();
      for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) inverse[follower][i][k] = inverted(i, k);
      }
    }
    for (int leg = 0; leg < legs; ++leg) {
      for (int k = 0; k < 3; ++k) rows[leg][k] = map.a(leg, k);
    }
    std::mt19937_64 engine(7);
    double farthest = 0.0, turn = 0.0;
    for (int i = 0; i < 1'000'000; ++i) {
      const unsigned long long bits = engine();
      const int follower = static_cast<int>(bits & 3);
      double d[3], x[3] = {};
      for (int k = 0; k < 3; ++k) {
        const double share = 2.0 * static_cast<double>(bits >> (4 + 18 * k) & 0x3ffff) / 262143.0 - 1.0;
        d[k] = 2e-4 * (bits >> (58 + k) & 1 ? std::copysign(1.0, share) : share);
      }
      for (int r = 0; r < 3; ++r) {
        for (int k = 0; k < 3; ++k) x[r] += inverse[follower][r][k] * d[k];
      }
      if (legs == 4) {
        const double* row = rows[follower];
        if (std::abs(row[0] * x[0] + row[1] * x[1] + row[2] * x[2]) > 2e-4) continue;
      }
      farthest = std::max(farthest, x[0] * x[0] + x[1] * x[1]);
      turn = std::max(turn, std::abs(x[2]));
    }
    farthest = std::sqrt(farthest);
    EXPECT_LE(farthest, error->exact.position * (1.0 + 1e-12));
    EXPECT_GE(farthest, error->exact.position * 0.99);
    EXPECT_LE(turn, error->exact.dangle * (1.0 + 1e-12));
    EXPECT_GE(turn, error->exact.dangle * 0.99);
  }
}

TEST(ClearanceError, AnotherLegNeverMakesItLarger) {
  std::mt19937_64 engine(11);
  const auto uniform = [&] { return 2.0 * static_cast<double>(engine() >> 11) * 0x1.0p-53 - 1.0; };
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<Generator> generators;
    MatrixXd a(6, 3);
    double last = std::numeric_limits<double>::infinity();
    for (Eigen::Index r = 0; r < 6; ++r) {
      const double angle = M_PI * uniform();
      a.row(r) << std::cos(angle), std::sin(angle), 0.1 * uniform();
    }
    for (Eigen::Index rows = 3; rows <= 6; ++rows) {
      generators.clear();
      for (Eigen::Index r = 0; r < rows; ++r) {
        Generator generator{MatrixXd::Zero(rows, 1), 1e-4 * static_cast<double>(r + 1)};
        generator.columns(r, 0) = 1.0;
        generators.push_back(generator);
      }
      const double position = exact_worst_case(a.topRows(rows), generators).position;
      EXPECT_LE(position, last * (1.0 + 1e-9));
      last = position;
    }
  }
}

/// Columns of the same space, each of length 1 and square to all others (Gram and Schmidt, twice for the rounding).
MatrixXd orthonormal(MatrixXd columns) {
  for (Eigen::Index c = 0; c < columns.cols(); ++c) {
    for (int pass = 0; pass < 2; ++pass) {
      for (Eigen::Index b = 0; b < c; ++b) columns.col(c) -= columns.col(b).dot(columns.col(c)) * columns.col(b);
    }
    columns.col(c).normalize();
  }
  return columns;
}

// The same set told by rows that are turned into each other: no row has a generator of its own any more, and the dual
// is minimised where vertices were tried.
TEST(FeasibleSet, DualAgreesWithVerticesLong) {
  std::mt19937_64 engine(5);
  const auto uniform = [&] { return 2.0 * static_cast<double>(engine() >> 11) * 0x1.0p-53 - 1.0; };
  for (const Eigen::Index rows : std::initializer_list<Eigen::Index>{4, 5, 6}) {
    for (int trial = 0; trial < 12; ++trial) {
      MatrixXd a(rows, 3), random(rows, rows);
      for (Eigen::Index r = 0; r < rows; ++r) {
        const double angle = M_PI * uniform();
        a.row(r) << std::cos(angle), std::sin(angle), 0.1 * uniform();
        for (Eigen::Index c = 0; c < rows; ++c) random(r, c) = uniform();
      }
      const MatrixXd turn = orthonormal(random);
      std::vector<Generator> plain, turned;
      for (Eigen::Index r = 0; r < rows; ++r) {
        Generator generator{MatrixXd::Zero(rows, 1), 1e-4 * (1.5 + uniform())};
        generator.columns(r, 0) = 1.0;
        plain.push_back(generator);
        generator.columns = turn * generator.columns;
        turned.push_back(generator);
      }
      const WorstCase vertices = exact_worst_case(a, plain), dual = exact_worst_case(turn * a, turned);
      EXPECT_NEAR(dual.position, vertices.position, 1e-9 * vertices.position);
      EXPECT_NEAR(dual.change[0], vertices.change[0], 1e-9 * vertices.change[0]);
      EXPECT_NEAR(dual.change[1], vertices.change[1], 1e-9 * vertices.change[1]);
      EXPECT_NEAR(dual.dangle, vertices.dangle, 1e-9 * vertices.dangle);
    }
  }
}

// |y + l t| <= g and |y - l t| <= g leave the rhombus that two independent ends make.
TEST(PlayHull, OfTwoEndsOfASliderIsTheSumOfTheirPlays) {
  constexpr double gap = 2e-4, half = 0.05;
  const double bounds[] = {gap, 0.0, 1.0, 0.0, 0.0, 0.0, half, gap, 0.0, 1.0, 0.0, 0.0, 0.0, -half};
  const BoundedPlay play = bounded_play(bounds, gap);
  ASSERT_EQ(play.twist.size(), 2u);
  ASSERT_EQ(play.hull.vertices.cols(), 2);
  for (Eigen::Index v = 0; v < 2; ++v) {
    double shift = 0.0, turn = 0.0;
    for (Eigen::Index k = 0; k < 2; ++k) {
      shift += gap * play.twist[static_cast<std::size_t>(k)][1] * play.hull.vertices(k, v);
      turn += gap * play.twist[static_cast<std::size_t>(k)][5] * play.hull.vertices(k, v);
    }
    EXPECT_NEAR(std::abs(shift) / gap + half * std::abs(turn) / gap, 1.0, 1e-12);
    EXPECT_NEAR(std::abs(shift) * std::abs(turn), 0.0, 1e-18);
  }
  EXPECT_NEAR(play.hull.gauge(play.hull.vertices.col(0)), 1.0, 1e-12);
}

// A sum of segments p_k has the corners sum +-p_k: both are the same set, whichever way it is given, also where
// redundant rows are minimised over.
TEST(PlayHull, CornersAreWorthTheSegmentsThatTheyAreTheSumOf) {
  std::mt19937_64 engine(3);
  const auto uniform = [&] { return 2.0 * static_cast<double>(engine() >> 11) * 0x1.0p-53 - 1.0; };
  PlayHull square{MatrixXd::Identity(2, 2), MatrixXd(2, 2)};
  square.vertices << 1.0, 1.0, 1.0, -1.0;
  for (const Eigen::Index rows : std::initializer_list<Eigen::Index>{3, 5, 6}) {
    for (int trial = 0; trial < 8; ++trial) {
      MatrixXd a(rows, 3);
      std::vector<Generator> segments, corners;
      for (Eigen::Index r = 0; r < rows; ++r) {
        const double angle = M_PI * uniform();
        a.row(r) << std::cos(angle), std::sin(angle), 0.1 * uniform();
      }
      for (int k = 0; k < 3; ++k) {
        MatrixXd columns(rows, 2);
        for (Eigen::Index r = 0; r < rows; ++r) columns.row(r) << uniform(), uniform();
        const double size = 1e-4 * (1.5 + uniform());
        corners.push_back({columns, size, &square});
        for (Eigen::Index c = 0; c < 2; ++c) segments.push_back({columns.col(c), size});
      }
      const Generator disc{MatrixXd::Random(rows, 2), 1e-4};
      corners.push_back(disc);
      segments.push_back(disc);
      const WorstCase one = exact_worst_case(a, corners), other = exact_worst_case(a, segments);
      EXPECT_NEAR(one.position, other.position, 1e-8 * other.position) << rows;
      EXPECT_GE(one.position, other.position * (1.0 - 1e-9)) << rows;
      EXPECT_NEAR(one.dangle, other.dangle, 1e-8 * other.dangle) << rows;
      EXPECT_GE(one.dangle, other.dangle * (1.0 - 1e-9)) << rows;
      EXPECT_NEAR(one.change[0], other.change[0], 1e-8 * other.change[0]) << rows;
      EXPECT_GE(one.change[0], other.change[0] * (1.0 - 1e-9)) << rows;
    }
  }
}

TEST(FeasibleSet, FarthestPointsOfKnownSets) {
  // A disc of radius r and a segment of half length s along a: r + s, along a.
  const Vector2d a = Vector2d(3.0, 4.0) / 5.0;
  Vector2d direction;
  const auto disc_and_segment = [&](const Vector2d& n, Vector2d& p) {
    const double along = a.dot(n);
    p = 0.3 * n + 0.2 * (along < 0.0 ? -1.0 : 1.0) * a;
    return 0.3 + 0.2 * std::abs(along);
  };
  EXPECT_NEAR(farthest(disc_and_segment, direction), 0.5, 1e-15);
  EXPECT_NEAR(std::abs(direction.dot(a)), 1.0, 1e-12);
  // Two crossed ellipses: half axes 1 and 0.01 along x, 0.99 and 0.02 along y. h is 1.01 along x and 1.0 along y, and
  // in between sqrt(c^2 + 1e-4 s^2) + sqrt(0.9801 s^2 + 4e-4 c^2), largest by a scan of a million directions.
  const auto ellipses = [](const Vector2d& n, Vector2d& p) {
    const double one = std::hypot(n[0], 0.01 * n[1]), two = std::hypot(0.02 * n[0], 0.99 * n[1]);
    p = Vector2d(n[0] / one + 4e-4 * n[0] / two, 1e-4 * n[1] / one + 0.9801 * n[1] / two);
    return one + two;
  };
  double scan = 0.0;
  Vector2d p;
  for (int i = 0; i < 1'000'000; ++i) {
    const double angle = M_PI * i / 1e6;
    scan = std::max(scan, ellipses({std::cos(angle), std::sin(angle)}, p));
  }
  EXPECT_NEAR(farthest(ellipses, direction), scan, 1e-11);
  EXPECT_GE(farthest(ellipses, direction), scan);
}

TEST(PlaySamplesLong, StayWithinTheExactWorstCase) {
  for (const char* name : {"3-rrr", "4-rrr"}) {
    Bench bench(platforms::legs_text(platforms::sizes(name), 1, {1e-4, 5e-5, 1e-4}));
    const VelocityMap map = bench.map(bench.reach(Bench::at(0.02, -0.03, 0.1)));
    const auto error = clearance_error(bench.mechanism, map);
    const auto samples = sample_play(bench.mechanism, map, 200'000, 1);
    ASSERT_TRUE(samples);
    EXPECT_LE(samples->max_position, error->exact.position);
    EXPECT_LE(samples->max_dangle, error->exact.dangle);
    EXPECT_GT(samples->max_position, 0.6 * error->exact.position);
    const auto again = sample_play(bench.mechanism, map, 200'000, 1);
    EXPECT_EQ(samples->rms_position, again->rms_position);
  }
}

}  // namespace
}  // namespace freeplay
