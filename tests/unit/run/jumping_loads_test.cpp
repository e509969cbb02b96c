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

}  // namespace
}  // namespace freeplay
