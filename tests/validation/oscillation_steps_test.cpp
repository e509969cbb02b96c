// Steps of one size that do not resolve an oscillation are doubted, whatever the integrator makes of it.
#include <fmt/format.h>

#include "run_model.h"

namespace freeplay::test {
namespace {

/// How many steps of 1 ms the doubts of a run count in a period; 0: it has none.
double counted(const std::string& text) {
  const ModelRun run(text);
  const std::vector<TrustReason>& doubts = run.outcome().doubts;
  const auto found = std::ranges::find(doubts, "oscillation-steps", &TrustReason::id);
  return found == doubts.end() ? 0.0 : found->value;
}

/// A mass of 1 kg on a spring with which it swings once in so many steps.
std::string swinging(double steps, const char* integrator) {
  const double w = 2.0 * M_PI / (1e-3 * steps);
  return fmt::format(
      "freeplay: 1\n"
      "bodies: {{m: {{mass: 1, inertia: 1}}}}\n"
      "joints: {{guide: {{type: prismatic, between: [ground, m]}}}}\n"
      "forces: {{pull: {{type: force, at: m, value: ['-{:.17g} N/m*body.m.x', 0]}}}}\n"
      "initial: {{joints: {{guide: 0.1}}}}\n"
      "simulation: {{end: 1 s, step: 1 ms, integrator: {}}}\n",
      w * w, integrator);
}

TEST(OscillationSteps, TooFewOfThemAreCounted) {
  for (const char* integrator : {"bathe", "newmark", "hht", "generalized-alpha"}) {
    for (const double steps : {5.0, 8.0}) {
      EXPECT_NEAR(counted(swinging(steps, integrator)), steps, 0.15 * steps) << integrator;
    }
    for (const double steps : {2.0, 3.0}) {
      const double seen = counted(swinging(steps, integrator));
      EXPECT_TRUE(seen >= 1.9 && seen < 4.0) << integrator << " " << seen;
    }
    for (const double steps : {12.0, 20.0, 50.0}) EXPECT_EQ(counted(swinging(steps, integrator)), 0.0) << integrator;
  }
}

// A millimetre of swing on a carriage that goes half a metre.
std::string carried(double steps, double swing) {
  const double w = 2.0 * M_PI / (1e-3 * steps);
  return fmt::format(
      "freeplay: 1\n"
      "bodies: {{cart: {{mass: 10, inertia: 1}}, m: {{mass: 1, inertia: 1}}}}\n"
      "joints: {{a: {{type: prismatic, between: [ground, cart]}}, b: {{type: prismatic, between: [cart, m]}}}}\n"
      "drivers: {{d: {{joint: a, kind: position, value: '0.5*sin(2*t)'}}}}\n"
      "forces: {{s: {{type: spring-damper, between: [cart, m], stiffness: {:.17g}}}}}\n"
      "initial: {{joints: {{b: {:.17g}}}, speeds: {{b: 0}}}}\n"
      "simulation: {{end: 2 s, step: 1 ms, integrator: newmark}}\n",
      w * w, swing);
}

TEST(OscillationSteps, CountWhereTheMotionCarriesEnergy) {
  EXPECT_NEAR(counted(carried(6.0, 1e-3)), 6.0, 0.6);
  EXPECT_EQ(counted(carried(30.0, 1e-3)), 0.0);
  EXPECT_EQ(counted(carried(6.0, 1e-6)), 0.0);
}

TEST(OscillationSteps, AreNoneOfImpactsAndSticking) {
  EXPECT_EQ(counted("freeplay: 1\n"
                    "bodies: {m: {mass: 1, inertia: 1}}\n"
                    "joints: {guide: {type: prismatic, between: [ground, m]}}\n"
                    "forces: {f: {type: joint-friction, between: [ground, m], friction: 3}}\n"
                    "initial: {joints: {guide: 0}, speeds: {guide: 1}}\n"
                    "simulation: {end: 2 s, step: 1 ms}\n"),
            0.0);
  EXPECT_EQ(counted(mechanism("slider-crank")), 0.0);
}

TEST(OscillationSteps, AreNoneOfAMechanismThatItsDriverMovesAlone) {
  EXPECT_EQ(counted(replaced(mechanism("four-bar"), "step: 1 ms}", "step: 40 ms, output: {interval: 40 ms}}")), 0.0);
}

}  // namespace
}  // namespace freeplay::test
