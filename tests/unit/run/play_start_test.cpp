#include "run/play_start.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "validation/run_model.h"

namespace freeplay {
namespace {

using test::load;

constexpr double clearance = 1e-4;

/// A loose rod between two pins with play, hung up in gravity.
std::string hanger(const std::string& initial) {
  const std::string play =
      "clearance: {bearing_radius: 5 mm, radial_clearance: 0.1 mm, length: 10 mm, "
      "material: {E: 200 GPa, nu: 0.3}, contact: {law: hunt-crossley, restitution: 0.8}" +
      initial + "}";
  return "freeplay: 1\ngravity: [0, -9.81]\n"
         "bodies: {arm: {mass: 1, inertia: 0.01, com: [0.1, 0], frames: {tip: [0.2, 0]}},"
         " rod: {mass: 1, inertia: 0.01, com: [0.1, 0], frames: {tip: [0.2, 0]}}}\n"
         "joints:\n"
         "  top: {type: revolute, bearing: ground, journal: arm, " +
         play + "}\n  middle: {type: revolute, bearing: arm/tip, journal: rod, " + play +
         "}\ninitial: {joints: {top: -90 deg, middle: 0 deg}}\nsimulation: {end: 1, step: 1 ms}\n";
}

/// Eccentricities of both joints [m].
std::array<std::array<double, 2>, 2> eccentricities(const Model& model, std::uint64_t seed, std::uint64_t number) {
  System system(model);
  const Start start = assemble_in_play(system, seed, number);
  Evaluation e(system);
  EXPECT_TRUE(system.evaluate(point(start.state), term_position | term_coordinate, e));
  std::array<std::array<double, 2>, 2> out;
  for (std::size_t j = 0; j < 2; ++j) {
    const MarkerKinematics &a = e.markers[static_cast<std::size_t>(model.joints[j].marker_a)],
                           &b = e.markers[static_cast<std::size_t>(model.joints[j].marker_b)];
    for (std::size_t i = 0; i < 2; ++i) out[j][i] = b.position[i] - a.position[i];
  }
  return out;
}

double distance(const std::array<double, 2>& e) { return std::hypot(e[0], e[1]); }

TEST(PlayStart, TheFirstStartIsThatOfTheModel) {
  const auto model = load(hanger(""));
  for (const auto& e : eccentricities(*model, 1, 0)) EXPECT_LT(distance(e), 1e-12);
}

TEST(PlayStart, MovesEveryLooseBodyByAtMostAHundredthOfItsPlay) {
  const auto model = load(hanger(""));
  double farthest = 0.0, sum = 0.0;
  for (std::uint64_t number = 1; number <= 200; ++number) {
    const auto both = eccentricities(*model, 1, number);
    for (const auto& e : both) {
      EXPECT_GT(distance(e), 0.0);
      EXPECT_LE(distance(e), moved_in_play * clearance * (1.0 + 1e-9));
      farthest = std::max(farthest, distance(e));
      sum += std::pow(distance(e) / (moved_in_play * clearance), 2);
    }
    EXPECT_NE(both[0], both[1]);
  }
  EXPECT_GT(farthest, 0.95 * moved_in_play * clearance);
  EXPECT_NEAR(sum / 400.0, 0.5, 0.06);  // mean square of an even draw from the disc; 4 standard deviations
}

TEST(PlayStart, DependsOnSeedAndNumberAlone) {
  const auto model = load(hanger(""));
  const auto third = eccentricities(*model, 1, 3);
  eccentricities(*model, 1, 2);
  EXPECT_EQ(third, eccentricities(*model, 1, 3));
  EXPECT_NE(third, eccentricities(*model, 1, 2));
  EXPECT_NE(third, eccentricities(*model, 2, 3));
}

TEST(PlayStart, AJournalThatRestsInItsBearingIsMovedAlongIt) {
  const auto model = load(hanger(", initial: loaded"));
  const auto own = eccentricities(*model, 1, 0);
  double turned = 0.0;
  for (std::uint64_t number = 1; number <= 50; ++number) {
    const auto moved = eccentricities(*model, 1, number);
    for (std::size_t j = 0; j < 2; ++j) {
      EXPECT_GT(distance(moved[j]), clearance);
      EXPECT_NEAR(distance(moved[j]), distance(own[j]), 1e-9 * clearance);
      const double cross = own[j][0] * moved[j][1] - own[j][1] * moved[j][0];
      const double turn = std::abs(cross) / (distance(own[j]) * distance(moved[j]));
      EXPECT_LT(turn, moved_in_play);
      turned = std::max(turned, turn);
    }
  }
  EXPECT_GT(turned, 0.5 * moved_in_play);
}

std::vector<double> numbers_of(const Start& start) { return {start.state.block().begin(), start.state.block().end()}; }

TEST(PlayStart, IsTheSameWithoutAccount) {
  for (const std::string& text :
       {test::mechanism("slider-crank"), test::mechanism("3-rrr"), test::mechanism("4-rrr"),
        test::mechanism("pendulum"), test::mechanism("slider-in-guide"), hanger(", initial: loaded"), hanger("")}) {
    const auto model = load(text);
    for (const std::uint64_t number : {std::uint64_t{0}, std::uint64_t{2}}) {
      System one(*model), other(*model);
      const Start full = assemble_in_play(one, 1, number), bare = assemble_bare_in_play(other, 1, number);
      EXPECT_EQ(numbers_of(full), numbers_of(bare)) << text;
      EXPECT_EQ(full.facts.actual.redundant, bare.facts.actual.redundant);
      EXPECT_EQ(full.facts.actual.driver_redundant, bare.facts.actual.driver_redundant);
      EXPECT_EQ(full.facts.actual.dof, bare.facts.actual.dof);
    }
  }
}

}  // namespace
}  // namespace freeplay
