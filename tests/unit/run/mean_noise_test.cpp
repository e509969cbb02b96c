#include "run/mean_noise.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

/// What a mean of 64 parts is found to vary by, by what it varies by: chance of deviation 1 that lasts `lasting` parts,
/// over `course`; the mean of 40 draws.
template <class Course>
double found(const Course& course, int lasting, double events) {
  std::mt19937 random(5);
  std::normal_distribution<double> chance;
  double sum = 0.0;
  for (int draw = 0; draw < 40; ++draw) {
    std::vector<double> parts;
    double now = 0.0;
    for (int k = 0; k < 64; ++k) {
      if (k % lasting == 0) now = chance(random);
      parts.push_back(course(k) + now);
    }
    sum += noise_of_mean(parts, events);
  }
  return sum / 40.0 / std::sqrt(lasting / 64.0);
}

TEST(MeanNoise, IsTheSpreadOfPartsByTheRootOfTheirNumber) {
  EXPECT_NEAR(found([](int) { return 7.0; }, 1, 1000.0), 1.0, 0.2);
}

// Of a drive with four turns in the time, and of one with less than one.
TEST(MeanNoise, IsNoneOfWhatADriveMakesOfIt) {
  EXPECT_NEAR(found([](int k) { return 50.0 * std::sin(2.0 * M_PI * k / 16.0); }, 1, 1000.0), 1.0, 0.25);
  EXPECT_NEAR(found([](int k) { return 5.0 * std::sin(2.0 * M_PI * k / 80.0); }, 1, 1000.0), 1.0, 0.25);
}

TEST(MeanNoise, IsLargerWhereChanceLasts) {
  // Neighbours that are alike by chance would show half of it at most: the drive, or the number of impacts, says which.
  EXPECT_GT(found([](int k) { return 50.0 * std::sin(2.0 * M_PI * k / 16.0); }, 4, 1000.0), 0.55);
  EXPECT_GT(found([](int) { return 0.0; }, 4, 16.0), 0.55);
}

TEST(MeanNoise, NotesSumsAtInstantsHoweverLongStepsAre) {
  for (const double step : {0.001, 0.03}) {
    MeanNoise noise(1.0, 2.0, 1);
    std::mt19937 random(1);
    std::normal_distribution<double> chance;
    double sum = 0.0, t = 1.0;
    for (; t < 2.0; t += step) {
      if (noise.is_due(t)) noise.note(t)[0] = sum;
      sum += 3.0 * step + std::sqrt(step) * chance(random);  // deviation 1 over the whole time
    }
    EXPECT_NEAR(noise.of(0, t, sum, 1000.0), 1.0, 0.5) << step;
  }
  EXPECT_FALSE(MeanNoise(0.0, 1.0, 0).is_due(0.5));
}

}  // namespace
}  // namespace freeplay
