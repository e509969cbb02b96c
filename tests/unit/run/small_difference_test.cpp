#include "run/small_difference.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "validation/run_model.h"

namespace freeplay {
namespace {

/// Two rods that hang on each other, from these angles; what else bodies, joints and keys there are.
std::string two_rods(const std::string& upper, const std::string& lower, const std::string& simulation,
                     const std::string& bodies = "", const std::string& joints = "", const std::string& keys = "") {
  return "freeplay: 1\ngravity: [0, -9.81]\nbodies:\n"
         "  upper: {mass: 1 kg, inertia: 0.01, com: [1 m, 0], frames: {end: [1 m, 0]}}\n"
         "  lower: {mass: 1 kg, inertia: 0.01, com: [1 m, 0]}\n" +
         bodies +
         "joints:\n"
         "  pivot: {type: revolute, between: [ground, upper]}\n"
         "  knee: {type: revolute, between: [upper/end, lower]}\n" +
         joints + "initial: {joints: {pivot: " + upper + ", knee: " + lower + "}}\n" + keys + "simulation: {" +
         simulation + ", output: {interval: 10 ms}}\n";
}

struct Peak {
  double value, noise;
};
Peak peak(const test::ModelRun& run, int joint) {
  const LargestValues& largest = run.statistics().largest();
  const std::size_t place = largest.places().force(joint);
  return {largest.in_window()[place], largest.noise().of(place)};
}

TEST(SmallDifference, CoversThePeaksOfOtherAccuraciesInAChaoticPendulum) {
  const test::ModelRun exact(two_rods("60 deg", "40 deg", "end: 60 s, accuracy: 10 nm"));
  for (const char* accuracy : {"10 um", "3 um", "1 um", "0.3 um", "0.1 um"}) {
    const test::ModelRun run(two_rods("60 deg", "40 deg", std::string("end: 60 s, accuracy: ") + accuracy));
    for (const int joint : {0, 1}) {
      const Peak seen = peak(run, joint);
      EXPECT_GT(seen.noise, 0.01 * seen.value) << accuracy;
      EXPECT_LE(std::abs(seen.value - peak(exact, joint).value), seen.noise) << accuracy;
    }
  }
}

// Two runs at 1e-12 m whose first angles differ by 1e-9 rad are 6e-4 m apart after 20 s: 1e-9 m leave four digits then,
// and 3e-6 m hardly any.
TEST(SmallDifference, LeavesTheDigitsThatAnAccuracyHolds) {
  const auto noise = [](const std::string& accuracy) {
    const std::string model = test::mechanism("validation/double-pendulum");
    const Peak seen = peak(
        test::ModelRun(test::replaced(model, "end: 5 s, accuracy: 1e-12 m", "end: 20 s, accuracy: " + accuracy)), 0);
    return seen.noise / seen.value;
  };
  EXPECT_LT(noise("1 nm"), 1e-3);
  EXPECT_GT(noise("3 um"), 1e-2);
}

TEST(SmallDifference, FindsChaosInSpace) {
  const std::string body = "inertia: [0.03, 0.03, 0.001], com: [0, 0, -0.3 m], velocity: {angular: [";
  const auto run = [&](const std::string& spin) {
    return test::ModelRun(
        "freeplay: 1\nspace: spatial\ngravity: [0, 0, -9.81]\nbodies:\n"
        "  upper: {mass: 1 kg, " +
        body + spin +
        "]}, frames: {end: {position: [0, 0, -0.6 m]}}}\n"
        "  lower: {mass: 1 kg, " +
        body + spin +
        "]}, pose: {position: [0, 0, -0.6 m]}}\n"
        "joints:\n"
        "  pivot: {type: spherical, between: [ground, upper]}\n"
        "  knee: {type: spherical, between: [upper/end, lower]}\n"
        "simulation: {end: 40 s, accuracy: 10 um, output: {interval: 10 ms}}\n");
  };
  const Peak wild = peak(run("9, 1, 0"), 0), calm = peak(run("0.5, 0.1, 0"), 0);
  EXPECT_GT(wild.noise, 3e-3 * wild.value);
  EXPECT_LT(calm.noise, 1e-4 * calm.value);
}

TEST(SmallDifference, LeavesRegularMotionsAllDigits) {
  const std::string swing = "end: 60 s, accuracy: 1 um";
  const Peak small = peak(test::ModelRun(two_rods("-70 deg", "15 deg", swing)), 0);
  EXPECT_LT(small.noise, 1e-6 * small.value);
  // A spring so stiff that steps go over its swings.
  const Peak stiff =
      peak(test::ModelRun(two_rods(
               "-70 deg", "15 deg", "end: 2 s, step: 10 ms", "", "",
               "forces: {rest: {type: spring-damper, kind: linear, between: [ground, upper/end], stiffness: 1e9 N/m,"
               " free_length: 1 m}}\n")),
           0);
  EXPECT_LT(stiff.noise, 1e-6 * stiff.value);
}

TEST(SmallDifference, OfOneMechanismIsNoNoiseOfAnother) {
  const test::ModelRun run(two_rods("60 deg", "40 deg", "end: 30 s, accuracy: 10 um",
                                    "  bob: {mass: 1 kg, inertia: 0.01, com: [0.4 m, 0], pose: {angle: -60 deg}}\n",
                                    "  hinge: {type: revolute, between: [ground, bob]}\n"));
  EXPECT_GT(peak(run, 1).noise, 0.01 * peak(run, 1).value);
  EXPECT_LT(peak(run, 2).noise, 1e-6 * peak(run, 2).value);
}

}  // namespace
}  // namespace freeplay
