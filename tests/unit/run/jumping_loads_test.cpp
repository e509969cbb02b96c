// Loads that jump, or have corners close together: what steps that end there make of them, and what others do.
#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "validation/run_model.h"

namespace freeplay {
namespace {

constexpr double pi = std::numbers::pi;

test::ModelRun pushed_by(const std::string& load, const std::string& simulation) {
  return test::ModelRun(
      fmt::format("freeplay: 1\n"
                  "bodies: {{b: {{mass: 1, inertia: 0.01}}}}\n"
                  "joints: {{g: {{type: prismatic, between: [ground, b]}}}}\n"
                  "forces: {{f: {{type: force, at: b, value: ['{}', 0]}}}}\n"
                  "simulation: {{{}}}\n",
                  load, simulation));
}

// Ten triangles of straight lines, 80 us long and 80 N high; the slope of asin has no bound, that of the load has.
TEST(JumpingLoads, StraightLinesBetweenCornersThatAreFoundAreNotDoubted) {
  const double half = (pi / 2.0 - 1.57) / 20.0, impulse = 1e5 * 20.0 * half * half;
  double way = 0.0;
  for (int k = 0; k < 10; ++k) way += impulse * (3.0 - (pi / 2.0 + 2.0 * pi * k) / 20.0);
  for (const char* integrator : {"dopri5", "verner6", "bathe"}) {
    const auto run =
        pushed_by("1e5*max(0, asin(sin(20*t)) - 1.57)",
                  fmt::format("end: 3, accuracy: 1 um, integrator: {}, output: {{interval: 10 ms}}", integrator));
    EXPECT_TRUE(run.outcome().doubts.empty()) << integrator << ": " << run.outcome().doubts.front().message;
    EXPECT_NEAR(run.last("joint.g.position"), way, 3e-6) << integrator;
  }
}

/// By how much steps are off, as their verdict says; 0 where it says nothing.
double off(const std::string& load, const std::string& simulation) {
  const auto run = pushed_by(load, simulation);
  for (const TrustReason& doubt : run.outcome().doubts) {
    if (doubt.message.find("jumps inside") != std::string::npos) return doubt.value;
  }
  return 0.0;
}

// From -30 N to 30 N in no time, and back by ramps.
TEST(JumpingLoads, StepsOfOneSizeThatGoOverManyJumpsAreDoubted) {
  const std::string load = "30*sign(sin(77*t))*smooth(cos(77*t),0.99,0.995)";
  EXPECT_GT(off(load, "end: 3, step: 0.25 ms, integrator: generalized-alpha, output: {interval: 60 ms}"), 0.2);
  EXPECT_EQ(off(load, "end: 3, step: 5 us, integrator: generalized-alpha, output: {interval: 60 ms}"), 0.0);
  EXPECT_EQ(off(load, "end: 3, accuracy: 1 um, output: {interval: 60 ms}"), 0.0);
}

// Jumps up and down that steps end at, or that are off by as much as each other.
TEST(JumpingLoads, StepsThatEndAtJumpsOrAreOffByTheSameAtEachAreNot) {
  EXPECT_EQ(off("10*sign(sin(100*pi*t))", "end: 1, step: 0.1 ms"), 0.0);
  EXPECT_EQ(off("10*sign(sin(100*pi*(t-0.00003)))", "end: 1, step: 0.1 ms"), 0.0);
  EXPECT_EQ(off("if(t < 0.50003, 0, 10)", "end: 1, step: 0.1 ms"), 0.0);
}

}  // namespace
}  // namespace freeplay
