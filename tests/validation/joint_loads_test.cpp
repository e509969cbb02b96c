// Loads that joints of plugins make of the time, in runs with steps of one size: what these go over is said.
#include <algorithm>

#include <fmt/format.h>

#include "pulse_joint.h"
#include "run_model.h"

namespace freeplay::test {
namespace {

/// The element that is doubted in a run of 2 s, if any. `told` is what the joint says of its time.
std::string doubted(double duration, const char* step, int told, const char* height = "50") {
  const ModelRun run(
      fmt::format("freeplay: 1\n"
                  "bodies: {{m: {{mass: 1, inertia: 1}}}}\n"
                  "joints: {{guide: {{type: prismatic, between: [ground, m]}}}}\n"
                  "forces: {{hit: {{type: pulse, between: [ground, m], height: {}, begin: 0.70031, duration: {}, "
                  "told: {}}}}}\n"
                  "simulation: {{end: 2, step: {}}}\n",
                  height, duration, told, step),
      {}, {}, types_with_pulses());
  EXPECT_EQ(run.outcome().status, RunStatus::completed);
  const auto& doubts = run.outcome().doubts;
  const auto doubt = std::ranges::find(doubts, "unresolved-input", &TrustReason::id);
  return doubt == doubts.end() ? std::string() : doubt->message;
}

TEST(JointLoads, APulseThatFixedStepsGoOverIsDoubted) {
  EXPECT_EQ(doubted(2e-4, "1 ms", 0),
            "force 'hit' changes at t = 0.70041 s in a way that steps of 0.001 s do not show");
  EXPECT_EQ(doubted(2e-5, "1 ms", 1),
            "force 'hit' changes at t = 0.70032 s in a way that steps of 0.001 s do not show");
  EXPECT_EQ(doubted(2e-6, "1 ms", 2), "force 'hit' has corners 2e-06 s apart, closer than the step of 0.001 s");
}

TEST(JointLoads, APulseThatFixedStepsShowIsNotDoubted) {
  for (const int told : {0, 1, 2}) {
    EXPECT_EQ(doubted(2e-2, "1 ms", told), "") << told;
    EXPECT_EQ(doubted(2e-4, "0.02 ms", told), "") << told;
  }
  EXPECT_EQ(doubted(2e-4, "1 ms", 0, "0"), "");  // of no height
}

}  // namespace
}  // namespace freeplay::test
