#include "run/reach.h"

#include <cmath>

#include <gtest/gtest.h>

#include "validation/run_model.h"

namespace freeplay {
namespace {

constexpr const char* chain = R"(freeplay: 1
name: chain
bodies:
  ground: {frames: {A: [1, 0]}}
  b: {mass: 1 kg, inertia: 1, com: [0.2, 0], frames: {tip: [0.5, 0]}}
  a: {mass: 1 kg, inertia: 1, com: [1, 0], frames: {tip: [2, 0]}}
  free: {mass: 1 kg, inertia: 1}
  slider: {mass: 1 kg, inertia: 1}
joints:
  B: {type: revolute, between: [a/tip, b]PLAY}
  A: {type: revolute, between: [ground/A, a]}
  S: {type: prismatic, between: [ground, slider]}
simulation: {end: 1 s, step: 1 ms}
)";

TEST(Reach, IsTheSumOfLengthsAlongTheChain) {
  const auto model = test::load(test::replaced(chain, "PLAY", ""));
  const std::vector<double> far = reach(*model);
  EXPECT_NEAR(far[0], 1.0 + 2.0 + 0.2, 1e-12);
  EXPECT_NEAR(far[1], 1.0 + 1.0, 1e-12);
  EXPECT_TRUE(std::isinf(far[2])) << "nothing holds it";
  EXPECT_TRUE(std::isinf(far[3])) << "it slides as far as it likes";
}

// A nut goes along its screw as it turns; a ball holds its origin however it turns.
TEST(Reach, SetsNoLimitToWhatSlidesAsItTurns) {
  const auto model = test::load(R"(freeplay: 1
space: spatial
bodies:
  nut: {mass: 1 kg, inertia: [1, 1, 1], com: [0.01, 0, 0]}
  hung: {mass: 1 kg, inertia: [1, 1, 1], com: [0.2, 0, 0]}
  turned: {mass: 1 kg, inertia: [1, 1, 1], com: [0.1, 0, 0]}
  sleeve: {mass: 1 kg, inertia: [1, 1, 1]}
joints:
  S: {type: screw, between: [ground, nut], lead: 5 mm}
  B: {type: spherical, between: [ground, hung]}
  R: {type: revolute, between: [ground, turned]}
  C: {type: cylindrical, between: [ground, sleeve]}
simulation: {end: 1 s, step: 1 ms}
)");
  const std::vector<double> far = reach(*model);
  EXPECT_TRUE(std::isinf(far[0]));
  EXPECT_NEAR(far[1], 0.2, 1e-12);
  EXPECT_NEAR(far[2], 0.1, 1e-12);
  EXPECT_TRUE(std::isinf(far[3]));
}

TEST(Reach, CountsTenTimesTheClearanceOfPlayWithoutRadii) {
  const auto model =
      test::load(test::replaced(chain, "PLAY", ", clearance: {radial_clearance: 0.01, contact: {law: hertz, K: 1e8}}"));
  EXPECT_NEAR(reach(*model)[0], 1.0 + 2.0 + 0.1 + 0.2, 1e-12);
}

}  // namespace
}  // namespace freeplay
