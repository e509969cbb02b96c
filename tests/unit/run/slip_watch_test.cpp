// Friction that is smoothed over a speed far above every slip: `vs: 5` for 5 mm/s.
#include <string>

#include "validation/run_model.h"

namespace freeplay {
namespace {

using test::ModelRun;

const TrustReason* smoothed(const ModelRun& run) {
  for (const TrustReason& doubt : run.outcome().doubts) {
    if (doubt.id == "law-range" && doubt.message.find("smoothed") != std::string::npos) return &doubt;
  }
  return nullptr;
}

ModelRun slide(const std::string& smoothing, const std::string& settings) {
  return ModelRun(
      "freeplay: 1\ngravity: [0, 0]\nbodies: {block: {mass: 1, inertia: 1e-3}}\n"
      "joints: {slide: {type: prismatic, between: [ground, block]}}\n"
      "forces: {rub: {type: joint-friction, between: [ground, block], friction: 0.5, vs: " +
      smoothing + "}}\ninitial: {speeds: {slide: 0.2}}\nsimulation: {end: 0.1 s, output: {interval: 1 ms}, " +
      settings + "}\n");
}

// A ring that hangs on a pin and turns on it at 2 rad/s, 20 mm/s of slip.
ModelRun turn(const std::string& smoothing) {
  return ModelRun(
      "freeplay: 1\ngravity: [0, -9.81]\nbodies: {ring: {mass: 1, inertia: 0.01, velocity: {angular: 2}}}\n"
      "joints:\n  pin:\n    type: revolute\n    between: [ground, ring]\n"
      "    clearance: {bearing_radius: 10 mm, radial_clearance: 0.1 mm, initial: loaded,\n"
      "                contact: {law: hertz, K: 1e9}, friction: {law: coulomb-tanh, mu: 0.1, vs: " +
      smoothing + "}}\nsimulation: {end: 20 ms, step: 20 us, output: {interval: 1 ms}}\n");
}

TEST(SlipWatch, DoubtsFrictionThatIsSmoothedFarAboveEverySlip) {
  for (const char* settings : {"step: 0.1 ms", "accuracy: 1 um"}) {
    const ModelRun run = slide("5 m/s", settings);
    ASSERT_NE(smoothed(run), nullptr) << settings;
    EXPECT_NEAR(smoothed(run)->value, 0.2, 1e-3);
    EXPECT_EQ(smoothed(run)->limit, 0.5);
    EXPECT_EQ(smoothed(slide("5 mm/s", settings)), nullptr);
    EXPECT_EQ(smoothed(slide("1 m/s", settings)), nullptr);  // a fifth of its size
  }
}

TEST(SlipWatch, LooksAtTheFrictionOfLooseJoints) {
  ASSERT_NE(smoothed(turn("5 m/s")), nullptr);
  EXPECT_NEAR(smoothed(turn("5 m/s"))->value, 0.02, 0.005);
  EXPECT_EQ(smoothed(turn("5 mm/s")), nullptr);
}

// What is at rest creeps, and at a speed that is no unit mistake.
TEST(SlipWatch, LeavesCreepingAlone) { EXPECT_EQ(smoothed(slide("10 mm/s", "step: 0.1 ms")), nullptr); }

}  // namespace
}  // namespace freeplay
