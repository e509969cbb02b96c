// What repeats in time or along a way acts in every period, those before its first point included.
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "validation/run_model.h"

namespace freeplay {
namespace {

constexpr const char* methods[] = {"dopri5", "verner7", "bathe", "generalized-alpha"};

bool is_doubted(const Outcome& outcome) { return !outcome.doubts.empty(); }

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

/// The mass runs along the line from a point that a spring ties it to; the spring has `points`, which repeat.
test::ModelRun tied(const std::string& points, double speed, double end, const std::string& simulation) {
  return test::ModelRun(fmt::format(
      "freeplay: 1\n"
      "bodies: {{b: {{mass: 1, inertia: 0.01}}}}\n"
      "joints: {{g: {{type: prismatic, between: [ground, b]}}}}\n"
      "frames: {{ground/k: [10, 0]}}\n"
      "initial: {{speeds: {{g: {}}}}}\n"
      "forces: {{s: {{type: spring-damper, between: [ground/k, b], free_length: 10, spring: {{interpolation: linear, "
      "ends: periodic, points: {}}}}}}}\n"
      "simulation: {{end: {}, {}, output: {{interval: 0.05}}}}\n",
      speed, points, end, simulation));
}

// A triangle of 1 kN and 0.2 mm in each metre stores 0.1 J. The stretch is -x. No step ends at points that repeat.
TEST(RepeatedInputs, NarrowPartsOfASpringActAndStoreTheirEnergyInEveryPeriodOfBothSides) {
  const std::string points = "[[0, 0], [0.2, 0], [0.2001, 1000], [0.2002, 0], [1, 0]]";
  for (const double speed : {3.0, -3.0}) {
    for (const char* integrator : methods) {
      const auto run = tied(points, speed, 1.0, std::string("accuracy: 1 um, integrator: ") + integrator);
      ASSERT_EQ(run.outcome().exit_code, 0) << run.outcome().reason;
      const double gained = speed > 0.0 ? 0.3 : -0.3;
      EXPECT_NEAR(std::abs(run.last("joint.g.speed")), std::sqrt(9.0 + 2.0 * gained), 2e-5) << integrator << speed;
      EXPECT_NEAR(run.last("energy.potential"), -gained, 1e-9) << integrator << speed;
      EXPECT_FALSE(is_doubted(run.outcome())) << integrator << speed;
    }
  }
}

// Of a mean that is not zero the energy grows from period to period.
TEST(RepeatedInputs, ASpringWithAMeanStoresMoreInEachPeriod) {
  const std::string points = "[[0, 2], [0.3, 4], [0.7, 1], [1, 2]]";
  const auto run = tied(points, -5.0, 1.0, "accuracy: 1 um");
  const double x = -run.last("joint.g.position"), whole = std::floor(x), part = x - whole;
  ASSERT_GT(whole, 2.0);
  const auto line = [](double u, double from, double length, double a, double b) {
    const double s = std::clamp((u - from) / length, 0.0, 1.0);
    return length * s * (a + 0.5 * s * (b - a));
  };
  const double within =
      line(part, 0.0, 0.3, 2.0, 4.0) + line(part, 0.3, 0.4, 4.0, 1.0) + line(part, 0.7, 0.3, 1.0, 2.0);
  const double stored = whole * (0.9 + 1.0 + 0.45) + within;
  EXPECT_NEAR(run.last("energy.potential"), stored, 1e-9);
  EXPECT_NEAR(run.last("joint.g.speed"), -std::sqrt(25.0 - 2.0 * stored), 5e-5);
}

}  // namespace
}  // namespace freeplay
