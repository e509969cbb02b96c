#include "run/peak_noise.h"

#include <algorithm>
#include <array>
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
void impact(PeakNoise& noise, double approach, double separation, int joint = 0) {
  const double begin[] = {approach, 0, 0, 0, 0, 0, 0}, end[] = {separation, 0, 0, 0, 0, 0, 0};
  noise.event(joint, 0, begin);
  noise.event(joint, 1, end);
}

PeakNoise noise_of(const Model& model) {
  const Channels channels(model);
  return {model, PeakValues(model, channels)};
}

PeakNoise after_impacts(const Model& model, int driven) {
  PeakNoise noise = noise_of(model);
  for (int i = 0; i <= driven; ++i) impact(noise, 1.0, 0.8);
  return noise;
}

/// Where the force of the ring stands after the speed of the puck, and how many values there are.
constexpr std::size_t ring_force = 1, ring_values = 6;

/// The force in the part of the time that begins at t.
void see(PeakNoise& noise, double t, double value) {
  std::array<double, ring_values> all{};
  all[ring_force] = value;
  noise.see(t + 0.5, all);
}

/// One force in each part, in order.
void see(PeakNoise& noise, const std::vector<double>& parts) {
  for (std::size_t i = 0; i < parts.size(); ++i) see(noise, static_cast<double>(i), parts[i]);
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
  EXPECT_EQ(0.0, noise.of(ring_force));
}

TEST(PeakNoise, IsZeroWithoutContacts) {
  const auto model = test::load(
      "freeplay: 1\nbodies: {rod: {mass: 1, inertia: 1}}\njoints: {pin: {type: revolute, between: [ground, rod]}}\n"
      "simulation: {end: 32, step: 1 ms}\n");
  PeakNoise noise = noise_of(*model);
  see(noise, exponential(1, 1.0));
  EXPECT_EQ(0.0, noise.of(ring_force));
}

TEST(PeakNoise, CountsImpactsThatComeFasterThanTheBodyLeft) {
  const auto model = ring();
  PeakNoise settling = noise_of(*model), driven = noise_of(*model);
  for (double speed = 1.0; speed > 0.1; speed *= 0.8) impact(settling, speed, 0.8 * speed);
  EXPECT_EQ(0, settling.growing_impacts());
  for (int i = 0; i < 5; ++i) impact(driven, 1.0, 0.8);
  EXPECT_EQ(4, driven.growing_impacts());
}

// Three times the scale of an exponential tail, from its largest values that are separate bursts.
TEST(PeakNoise, IsAboutTheScaleOfWhatChanceGives) {
  const auto model = ring();
  double sum = 0.0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    PeakNoise noise = after_impacts(*model, 20);
    see(noise, exponential(seed, 2.0));
    sum += noise.of(ring_force) / 200.0;
  }
  EXPECT_GT(sum, 2.8 * 2.0);
  EXPECT_LT(sum, 4.2 * 2.0);
}

TEST(PeakNoise, CoversThePeaksOfOtherRuns) {
  const auto model = ring();
  int covered = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    const std::vector<double> mine = exponential(seed, 2.0), other = exponential(seed + 1000, 2.0);
    PeakNoise noise = after_impacts(*model, 20);
    see(noise, mine);
    const double difference = *std::ranges::max_element(mine) - *std::ranges::max_element(other);
    if (std::abs(difference) <= noise.of(ring_force)) ++covered;
  }
  EXPECT_GT(covered, 165);
}

TEST(PeakNoise, GrowsFromOneImpactToTheNext) {
  const auto model = ring();
  double last = 0.0;
  for (int driven = 1; driven <= 6; ++driven) {
    PeakNoise noise = after_impacts(*model, driven);
    see(noise, exponential(1, 1.0));
    EXPECT_GT(noise.of(ring_force), last);
    last = noise.of(ring_force);
  }
  PeakNoise more = after_impacts(*model, 100);
  see(more, exponential(1, 1.0));
  EXPECT_EQ(last, more.of(ring_force));
}

TEST(PeakNoise, IsThatOfTheTimeOfThePeak) {
  const auto model = ring();
  PeakNoise noise = noise_of(*model);
  see(noise, 0.0, 100.0);
  for (int i = 0; i < 30; ++i) impact(noise, 1.0, 0.8);
  for (int part = 1; part < 32; ++part) see(noise, part, part % 2 == 0 ? 50.0 : 30.0);
  EXPECT_EQ(0.0, noise.of(ring_force));
}

// The peak comes before anything has grown, and the largest behind it, of few, is not much smaller.
TEST(PeakNoise, ReachesToWhatMayComeLater) {
  const auto model = ring();
  PeakNoise noise = noise_of(*model);
  see(noise, 0.0, 100.0);
  for (int i = 0; i < 30; ++i) impact(noise, 1.0, 0.8);
  for (int part = 1; part < 32; ++part) see(noise, part, part == 9 ? 90.0 : part == 20 ? 40.0 : 10.0);
  EXPECT_GT(noise.of(ring_force), 40.0);
  PeakNoise alone = noise_of(*model);
  see(alone, 0.0, 100.0);
  for (int i = 0; i < 30; ++i) impact(alone, 1.0, 0.8);
  for (int part = 1; part < 32; ++part) see(alone, part, part == 9 ? 80.0 : 0.0);
  EXPECT_NEAR(alone.of(ring_force), 20.0, 1e-9);
}

// A burst lasts for several parts: what stands beside it is not another one.
TEST(PeakNoise, IsNoSmallerWhereOneBurstLasts) {
  const auto model = ring();
  PeakNoise noise = after_impacts(*model, 20);
  std::vector<double> parts(32, 3.0);
  parts[9] = 20.0;
  for (int i = 0; i < 5; ++i) parts[static_cast<std::size_t>(20 + i)] = 50.0 - 2.0 * i;
  see(noise, parts);
  EXPECT_GT(noise.of(ring_force), 30.0);
}

// Then its power of ten is all that is known.
TEST(PeakNoise, IsThePeakAtMost) {
  const auto model = ring();
  PeakNoise noise = after_impacts(*model, 20);
  std::vector<double> parts(32, 3.0);
  parts[4] = 50.0, parts[8] = 100.0, parts[12] = 200.0, parts[16] = 300.0, parts[20] = 500.0;
  see(noise, parts);
  EXPECT_EQ(noise.of(ring_force), 500.0);
}

// Another start may settle to a motion a little beside.
TEST(PeakNoise, IsAHundredthWhereTheSamePeakComesAgainAndAgain) {
  const auto model = ring();
  PeakNoise noise = after_impacts(*model, 20);
  std::vector<double> parts(32, 3.0);
  parts[3] = 50.0, parts[9] = 50.0005, parts[15] = 50.001, parts[21] = 49.9995, parts[27] = 49.999;
  see(noise, parts);
  EXPECT_NEAR(noise.of(ring_force), 0.5, 1e-4);
}

TEST(PeakNoise, IsNoSmallerWhereThreePeaksAreTheSameByChance) {
  const auto model = ring();
  PeakNoise noise = after_impacts(*model, 20);
  std::vector<double> parts(32, 3.0);
  parts[3] = 50.0, parts[13] = 50.001, parts[23] = 49.999, parts[27] = 31.0;
  see(noise, parts);
  EXPECT_GT(noise.of(ring_force), 5.0);
}

/// Two pucks in rings, held together by `between` or not, one of which is pushed.
std::unique_ptr<Model> two_rings(const std::string& between) {
  const std::string ring =
      ", clearance: {bearing_radius: 5 mm, radial_clearance: 0.1 mm, length: 10 mm, material: {E: 200 GPa, nu: 0.3},"
      " contact: {law: hunt-crossley, restitution: 0.8}}}\n";
  return test::load(
      "freeplay: 1\nbodies: {a: {mass: 1, inertia: 1}, b: {mass: 1, inertia: 1}}\njoints:\n"
      "  ring: {type: revolute, bearing: ground, journal: a" +
      ring + "  other: {type: revolute, bearing: ground, journal: b" + ring +
      "forces:\n  push: {type: force, at: a, value: ['sin(t)', 0]}\n" + between +
      "simulation: {end: 32, step: 1 ms}\n");
}

/// The noise of the first ring, the second and the push, after 20 impacts in one ring or both.
std::array<double, 3> noise_of_both(const Model& model, int touching, const std::vector<double>& first,
                                    const std::vector<double>& second) {
  const Channels channels(model);
  const PeakValues places(model, channels);
  PeakNoise noise(model, places);
  for (int i = 0; i <= 20; ++i) {
    for (int joint = 0; joint < touching; ++joint) impact(noise, 1.0, 0.8, joint);
  }
  const std::array<std::size_t, 3> at{places.force(0), places.force(1), places.applied_force(0)};
  std::vector<double> all(places.size());
  for (std::size_t part = 0; part < 32; ++part) {
    all[at[0]] = all[at[2]] = first[part], all[at[1]] = second[part];
    noise.see(static_cast<double>(part) + 0.5, all);
  }
  return {noise.of(at[0]), noise.of(at[1]), noise.of(at[2])};
}
const char* const held_by_spring =
    "  spring: {type: spring-damper, between: [a, b], stiffness: 1 N/m, free_length: 1 m}\n";

// Five peaks may agree to a hundredth by chance: a motion that repeats has them in all that can touch.
TEST(PeakNoise, IsNoSmallerWhereOneJointAloneHasTheSamePeaks) {
  std::vector<double> same(32, 30.0);
  for (std::size_t part = 2; part < 32; part += 6) same[part] = 50.0 + 0.01 * static_cast<double>(part);
  const std::vector<double> by_chance = exponential(1, 2.0);
  EXPECT_GT(noise_of_both(*two_rings(held_by_spring), 2, same, by_chance)[0], 5.0);
  EXPECT_LT(noise_of_both(*two_rings(held_by_spring), 2, same, same)[0], 0.6);
  EXPECT_LT(noise_of_both(*two_rings(""), 2, same, by_chance)[0], 0.6);
}

TEST(PeakNoise, IsThatOfBodiesThatHangTogether) {
  const std::vector<double> by_chance = exponential(1, 2.0);
  EXPECT_GT(noise_of_both(*two_rings(held_by_spring), 1, by_chance, by_chance)[1], 0.5);
  EXPECT_EQ(noise_of_both(*two_rings(""), 1, by_chance, by_chance)[1], 0.0);
}

TEST(PeakNoise, IsZeroOfALoadThatTheModelGives) {
  const std::vector<double> by_chance = exponential(1, 2.0);
  EXPECT_EQ(noise_of_both(*two_rings(""), 2, by_chance, by_chance)[2], 0.0);
}

}  // namespace
}  // namespace freeplay
