// Random play against moments in closed form, integrals and draws that close by chance.
#include "analysis/play_samples.h"

#include <array>
#include <cmath>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "unit/analysis/platforms.h"

namespace freeplay {
namespace {

using platforms::Bench;

const PlayLaw laws[] = {{PlayLaw::Kind::uniform},     {PlayLaw::Kind::rim},          {PlayLaw::Kind::normal},
                        {PlayLaw::Kind::normal, 0.7}, {PlayLaw::Kind::normal, 0.05}, {PlayLaw::Kind::normal, 900.0}};

/// Mean of r^2 / 2 over the disc, or of x^2 over the interval, for a density exp(-r^2 / 2 sigma^2): midpoint rule.
double integrated_variance(double sigma, int size) {
  constexpr int pieces = 100'000;
  double mass = 0.0, moment = 0.0;
  for (int i = 0; i < pieces; ++i) {
    const double r = (i + 0.5) / pieces;
    const double weight = std::exp(-0.5 * r * r / (sigma * sigma)) * (size == 2 ? r : 1.0);
    mass += weight;
    moment += weight * r * r;
  }
  return moment / mass / size;
}

TEST(PlayLaw, VarianceIsTheIntegralOfItsDensity) {
  for (const int size : {1, 2}) {
    for (const double sigma : {0.05, 1.0 / 3.0, 0.7, 2.0, 900.0}) {
      EXPECT_NEAR(variance({PlayLaw::Kind::normal, sigma}, size), integrated_variance(sigma, size), 1e-9);
    }
    EXPECT_NEAR(variance({PlayLaw::Kind::uniform}, size), integrated_variance(1e9, size), 1e-9);
  }
  EXPECT_EQ(variance({PlayLaw::Kind::rim}, 2), 0.5);  // of a cosine
}

TEST(PlayLaw, DrawsHaveTheVarianceAndStayInBounds) {
  for (const PlayLaw& law : laws) {
    RandomDraws random(3);
    double disc = 0.0, interval = 0.0, cross = 0.0;
    constexpr int count = 200'000;
    for (int i = 0; i < count; ++i) {
      double y[2], x[1];
      draw(law, random, y);
      draw(law, random, x);
      EXPECT_LE(std::hypot(y[0], y[1]), 1.0 + 1e-15);
      EXPECT_LE(std::abs(x[0]), 1.0);
      if (law.kind == PlayLaw::Kind::rim) {
        EXPECT_NEAR(std::hypot(y[0], y[1]), 1.0, 1e-15);
      }
      disc += y[0] * y[0] / count;
      cross += y[0] * y[1] / count;
      interval += x[0] * x[0] / count;
    }
    // Fourth moments are at most thrice the squared variance: 4 standard deviations.
    const double width = 4.0 * std::sqrt(2.0 / count);
    EXPECT_NEAR(disc, variance(law, 2), width * variance(law, 2));
    EXPECT_NEAR(interval, variance(law, 1), width * variance(law, 1));
    EXPECT_NEAR(cross, 0.0, width * variance(law, 2));
  }
}

// One play acts along the coupler of its leg: dX = A^-1 e_0 (u . delta), so the position errs by a number of the law.
TEST(PlaySamples, OfOneJointHaveItsLawsMoments) {
  std::string text = platforms::legs_text(platforms::sizes("3-rrr"), 1, {1e-4, 0.0, 0.0});
  for (const char* other : {"B1: 0.0001", "B2: 0.0001"})
    text = test::replaced(text, other, std::string(other, 4) + "0");
  Bench bench(text);
  const VelocityMap map = bench.map(bench.reach(Bench::at(0.02, -0.03, 0.1)));
  const double lever = Eigen::Matrix3d(map.a).inverse().col(0).head<2>().norm();
  const double turn = std::abs(Eigen::Matrix3d(map.a).inverse()(2, 0));
  for (const PlayLaw& law : laws) {
    constexpr int count = 100'000;
    const auto samples = sample_play(bench.mechanism, map, count, 11, law);
    const double exact = 1e-4 * lever * std::sqrt(variance(law, 2));
    EXPECT_NEAR(samples->rms_position, exact, 2.0 * std::sqrt(2.0 / count) * exact);
    EXPECT_NEAR(samples->rms_dangle * lever, samples->rms_position * turn, 1e-12 * exact);
    EXPECT_LE(samples->max_position, 1e-4 * lever * (1.0 + 1e-12));
    if (law.kind == PlayLaw::Kind::rim) {
      EXPECT_GT(samples->max_position, 1e-4 * lever * (1.0 - 1e-6));
    }
  }
}

TEST(PlaySamplesLong, HaveTheVarianceOfTheirLaw) {
  Bench bench(platforms::legs_text(platforms::sizes("3-rrr"), 1, {1e-4, 5e-5, 1e-4}));
  const VelocityMap map = bench.map(bench.reach(Bench::at(0.02, -0.03, 0.1)));
  for (const PlayLaw& law : laws) {
    const auto samples = sample_play(bench.mechanism, map, 400'000, 2, law);
    const auto exact = least_squares_play(bench.mechanism, map, law);
    // Of normal sums an rms of N samples has the relative standard deviation 1 / sqrt(2 N); four of them.
    const double width = 4.0 / std::sqrt(2.0 * 400'000);
    EXPECT_NEAR(samples->rms_position, exact->rms_position, width * exact->rms_position);
    EXPECT_NEAR(samples->rms_dangle, exact->rms_dangle, width * exact->rms_dangle);
  }
}

// With redundancy: independent plays are drawn, and those that happen to close nearly are kept.
TEST(PlaySamplesLong, OfARedundantMechanismAreThoseThatClose) {
  Bench bench(platforms::legs_text(platforms::sizes("4-rrr"), 1, {1e-4, 6e-5, 1e-4}));
  const VelocityMap map = bench.map(bench.reach(Bench::at(0.06, -0.03, 0.1)));
  const auto error = clearance_error(bench.mechanism, map);
  const Eigen::MatrixXd inverse = *pseudo_inverse(map, bench.mechanism.length());
  const std::vector<Generator> generators = generators_of(bench.mechanism, map);
  const Eigen::VectorXd closure = Eigen::FullPivLU<Eigen::MatrixXd>(map.a.transpose()).kernel().col(0).normalized();
  // By number of a play: dx, dy, dangle and the gap of the closure. Plain arrays, for tests are not optimised.
  std::vector<std::array<double, 4>> images;
  for (const Generator& generator : generators) {
    for (Eigen::Index c = 0; c < generator.columns.cols(); ++c) {
      const Eigen::VectorXd d = generator.size * generator.columns.col(c);
      const Eigen::Vector3d x = inverse * d;
      images.push_back({x[0], x[1], x[2], closure.dot(d)});
    }
  }
  for (const PlayLaw& law : {PlayLaw{PlayLaw::Kind::rim}, {PlayLaw::Kind::normal, 0.5}}) {
    RandomDraws random(5);
    double squared = 0.0, turned = 0.0;
    int kept = 0;
    for (int i = 0; i < 1'000'000; ++i) {
      double sum[4] = {};
      std::size_t place = 0;
      for (const Generator& generator : generators) {
        double y[2];
        const auto size = static_cast<std::size_t>(generator.columns.cols());
        draw(law, random, {y, size});
        for (std::size_t c = 0; c < size; ++c, ++place) {
          for (std::size_t k = 0; k < 4; ++k) sum[k] += images[place][k] * y[c];
        }
      }
      if (std::abs(sum[3]) > 3e-6) continue;
      squared += sum[0] * sum[0] + sum[1] * sum[1];
      turned += sum[2] * sum[2];
      ++kept;
    }
    ASSERT_GT(kept, 10'000);
    const auto samples = sample_play(bench.mechanism, map, 100'000, 1, law);
    // 1 / sqrt(2 N) is 0.4 % of the draws that are kept; neighbours in the chain resemble each other.
    EXPECT_NEAR(samples->rms_position, std::sqrt(squared / kept), 0.015 * samples->rms_position) << kept;
    EXPECT_NEAR(samples->rms_dangle, std::sqrt(turned / kept), 0.015 * samples->rms_dangle) << kept;
    const auto again = sample_play(bench.mechanism, map, 1000, 1, law);
    EXPECT_EQ(again->rms_position, sample_play(bench.mechanism, map, 1000, 1, law)->rms_position);
    EXPECT_LE(samples->max_position, error->exact.position);
    EXPECT_LE(samples->max_dangle, error->exact.dangle);
  }
}

TEST(PlaySamples, StayWhereOtherJointsHoldALooseOne) {
  // A single loose joint, in a redundant leg: it must be where the others have it.
  std::string text = platforms::legs_text(platforms::sizes("4-rrr"), 1, {1e-4, 0.0, 0.0});
  for (const char* other : {"B1: 0.0001", "B2: 0.0001", "B3: 0.0001"}) {
    text = test::replaced(text, other, std::string(other, 4) + "0");
  }
  Bench bench(text);
  const VelocityMap map = bench.map(bench.reach(Bench::at(0.06, -0.03, 0.1)));
  // The rim is touched across the coupler alone, where nothing moves.
  const auto rim = sample_play(bench.mechanism, map, 100, 1, {PlayLaw::Kind::rim});
  ASSERT_TRUE(rim);
  EXPECT_LT(rim->max_position, 1e-15);
  const auto uniform = sample_play(bench.mechanism, map, 100, 1);
  EXPECT_LT(uniform->max_position, 1e-15);
}

}  // namespace
}  // namespace freeplay
