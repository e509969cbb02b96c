#include "run/peak_noise.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "validation/run_model.h"

namespace freeplay {
namespace {

/// A puck in a ring, from 0 to 32 s without anything discarded: parts of 1 s.
std::unique_ptr<Model> ring() {
  return test::load(
      "freeplay: 1\nbodies: {puck: {mass: 1, inertia: 1}}\n"
      "joints: {ring: {type: revolute, bearing: ground, journal: puck, clearance: {bearing_radius: 5 mm,"
      " radial_clearance: 0.1 mm, length: 10 mm, material: {E: 200 GPa, nu: 0.3},"
      " contact: {law: hunt-crossley, restitution: 0.8}}}}\nsimulation: {end: 32, step: 1 ms}\n");
}

/// Events of the ring: index 0 begins and 1 ends a contact; the first field is the speed.
void impact(PeakNoise& noise, double approach, double separation) {
  const double begin[] = {approach, 0, 0, 0, 0, 0, 0}, end[] = {separation, 0, 0, 0, 0, 0, 0};
  noise.event(0, 0, begin);
  noise.event(0, 1, end);
}

PeakNoise after_impacts(const Model& model, int driven) {
  PeakNoise noise(model, 1);
  for (int i = 0; i <= driven; ++i) impact(noise, 1.0, 0.8);
  return noise;
}

/// One value in each part, in order.
void see(PeakNoise& noise, const std::vector<double>& parts) {
  for (std::size_t i = 0; i < parts.size(); ++i) noise.see(static_cast<double>(i) + 0.5, {&parts[i], 1});
}

std::vector<double> exponential(unsigned seed, double scale) {
  std::mt19937_64 random(seed);
  std::vector<double> parts;
  for (int i = 0; i < 32; ++i) {
    parts.push_back(10.0 - scale * std::log(static_cast<double>(random() >> 11) * 0x1p-53 + 0x1p-54));
  }
  return parts;
}

TEST(PeakNoise, IsZeroBeforeAnImpactThatLetsDifferencesGrow) {
  const auto model = ring();
  PeakNoise noise = after_impacts(*model, 0);
  see(noise, exponential(1, 1.0));
  EXPECT_EQ(0.0, noise.of(0));
}

TEST(PeakNoise, IsZeroWithoutContacts) {
  const auto model = test::load(
      "freeplay: 1\nbodies: {rod: {mass: 1, inertia: 1}}\njoints: {pin: {type: revolute, between: [ground, rod]}}\n"
      "simulation: {end: 32, step: 1 ms}\n");
  PeakNoise noise(*model, 1);
  see(noise, exponential(1, 1.0));
  EXPECT_EQ(0.0, noise.of(0));
}

TEST(PeakNoise, CountsImpactsThatComeFasterThanTheBodyLeft) {
  const auto model = ring();
  PeakNoise settling(*model, 1), driven(*model, 1);
  for (double speed = 1.0; speed > 0.1; speed *= 0.8) impact(settling, speed, 0.8 * speed);
  EXPECT_EQ(0, settling.growing_impacts());
  for (int i = 0; i < 5; ++i) impact(driven, 1.0, 0.8);
  EXPECT_EQ(4, driven.growing_impacts());
}

// The scale of an exponential tail, from the eight largest of 32: its mean over many draws is that scale.
TEST(PeakNoise, IsAboutTheScaleOfWhatChanceGives) {
  const auto model = ring();
  double sum = 0.0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    PeakNoise noise = after_impacts(*model, 20);
    see(noise, exponential(seed, 2.0));
    sum += noise.of(0) / 200.0;
  }
  EXPECT_GT(sum, 1.4 * 2.0);
  EXPECT_LT(sum, 2.2 * 2.0);
}

TEST(PeakNoise, CoversThePeaksOfOtherRuns) {
  const auto model = ring();
  int covered = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    const std::vector<double> mine = exponential(seed, 2.0), other = exponential(seed + 1000, 2.0);
    PeakNoise noise = after_impacts(*model, 20);
    see(noise, mine);
    const double difference = *std::ranges::max_element(mine) - *std::ranges::max_element(other);
    if (std::abs(difference) <= noise.of(0)) ++covered;
  }
  EXPECT_GT(covered, 130);
}

TEST(PeakNoise, GrowsFromOneImpactToTheNext) {
  const auto model = ring();
  double last = 0.0;
  for (int driven = 1; driven <= 7; ++driven) {
    PeakNoise noise = after_impacts(*model, driven);
    see(noise, exponential(1, 1.0));
    EXPECT_GT(noise.of(0), last);
    last = noise.of(0);
  }
  PeakNoise more = after_impacts(*model, 100);
  see(more, exponential(1, 1.0));
  EXPECT_EQ(last, more.of(0));
}

TEST(PeakNoise, IsThatOfTheTimeOfThePeak) {
  const auto model = ring();
  PeakNoise noise(*model, 1);
  const double first = 100.0;
  noise.see(0.5, {&first, 1});
  for (int i = 0; i < 30; ++i) impact(noise, 1.0, 0.8);
  for (int part = 1; part < 32; ++part) {
    const double later = 50.0 + part;
    noise.see(part + 0.5, {&later, 1});
  }
  EXPECT_EQ(0.0, noise.of(0));
}

TEST(PeakNoise, IsSmallWhereTheSamePeakComesAgainAndAgain) {
  const auto model = ring();
  PeakNoise noise = after_impacts(*model, 20);
  std::vector<double> parts(32, 3.0);
  parts[3] = 50.0, parts[9] = 50.0005, parts[15] = 50.001, parts[21] = 49.9995, parts[27] = 49.999;
  see(noise, parts);
  EXPECT_NEAR(noise.of(0), 0.002, 1e-9);
}

TEST(PeakNoise, IsNoSmallerWhereThreePeaksAreTheSameByChance) {
  const auto model = ring();
  PeakNoise noise = after_impacts(*model, 20);
  std::vector<double> parts(32, 3.0);
  parts[3] = 50.0, parts[13] = 50.001, parts[23] = 49.999, parts[27] = 31.0;
  see(noise, parts);
  EXPECT_GT(noise.of(0), 5.0);
}

}  // namespace
}  // namespace freeplay
