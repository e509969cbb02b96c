// What repeats in time or along a way acts in every period, those before its first point included.
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "validation/run_model.h"

namespace freeplay {
namespace {

constexpr const char* methods[] = {"dopri5", "verner7", "bathe", "generalized-alpha"};

/// A mass of 1 kg on a rail; each pulse of 2 kN over 60 us, the middle of one at 0.30003 s, gives it 0.06 m/s.
test::ModelRun pushed(double start, double end, const char* integrator) {
  return test::ModelRun(fmt::format(
      "freeplay: 1\n"
      "bodies: {{b: {{mass: 1, inertia: 0.01}}}}\n"
      "joints: {{g: {{type: prismatic, between: [ground, b]}}}}\n"
      "drivers: {{d: {{joint: g, kind: force, table: {{points: [[0.2, 0], [0.3, 0], [0.30003, 2000], [0.30006, 0], "
      "[0.45, 0]], interpolation: linear, outside: repeat}}}}}}\n"
      "simulation: {{start: {}, end: {}, accuracy: 1 um, integrator: {}, output: {{interval: 0.05}}}}\n",
      start, end, integrator));
}

TEST(RepeatedInputs, PulsesOfATableActBeforeItsFirstPoint) {
  for (const char* integrator : methods) {
    EXPECT_NEAR(pushed(0.0, 0.5, integrator).last("joint.g.speed"), 0.12, 1e-6) << integrator;
    EXPECT_NEAR(pushed(-1.0, 0.1, integrator).last("joint.g.speed"), 0.3, 1e-6) << integrator;
  }
}

}  // namespace
}  // namespace freeplay
