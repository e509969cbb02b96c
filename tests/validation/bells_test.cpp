// Loads without corners, of which no rule says how fast they change: all of their bells count, and are met.
#include <cmath>

#include <fmt/format.h>

#include "run_model.h"

namespace freeplay::test {
namespace {

/// A mass of 1 kg on a guide along x for 2 s.
ModelRun under(const char* value, double accuracy, const char* integrator = "") {
  BuildOptions options;
  if (*integrator != '\0') options.integrator = integrator;
  return ModelRun(fmt::format("freeplay: 1\n"
                              "bodies: {{m: {{mass: 1, inertia: 1}}}}\n"
                              "joints: {{guide: {{type: prismatic, between: [ground, m]}}}}\n"
                              "forces: {{hit: {{type: force, at: m, value: ['{}', 0]}}}}\n"
                              "simulation: {{end: 2, accuracy: {:.17g}}}\n",
                              value, accuracy),
                  options);
}

/// Where f takes a mass of 1 kg from rest, by Simpson's rule.
template <class Function>
double way_under(Function f, double end) {
  const int parts = 2'000'000;
  const double h = end / parts;
  double sum = 0.0;
  for (int k = 0; k <= parts; ++k) sum += (k == 0 || k == parts ? 1 : 2 + 2 * (k % 2)) * f(h * k) * (end - h * k);
  return sum * h / 3.0;
}

// Errors beside bells have the same sign, bell after bell; the last is far narrower than an output interval.
TEST(Bells, TrainsOfBellsWithoutCornersKeepTheAccuracy) {
  const auto square = [](double x) { return x * x; };
  for (const char* integrator : {"", "verner7"}) {
    const auto error = [&](const char* value, double accuracy, auto f) {
      const ModelRun run = under(value, accuracy, integrator);
      return std::abs(run.last("body.m.x") - way_under(f, 2.0)) / accuracy;
    };
    EXPECT_LT(error("10/(1 + 400*sin(50*t)^2)", 1e-4,
                    [&](double t) { return 10.0 / (1.0 + 400.0 * square(std::sin(50.0 * t))); }),
              4.0);
    EXPECT_LT(error("10*exp(-200*sin(20*t)^2)", 1e-5,
                    [&](double t) { return 10.0 * std::exp(-200.0 * square(std::sin(20.0 * t))); }),
              4.0);
    EXPECT_LT(error("exp(-(sin(151.295*t)/0.0112)^2)", 1.2e-6,
                    [&](double t) { return std::exp(-square(std::sin(151.295 * t) / 0.0112)); }),
              4.0);
  }
}

// Where the angle jumps, spans of time are halved down to neighbouring numbers and no further.
TEST(Bells, OncePerTurnOfAnAngleAreMet) {
  const ModelRun run = under("100*exp(-((atan2(sin(40*pi*t), cos(40*pi*t)) - 1)/0.1)^2)", 1e-6);
  const auto force = [](double t) {
    const double turn = 40.0 * M_PI * t, away = (std::atan2(std::sin(turn), std::cos(turn)) - 1.0) / 0.1;
    return 100.0 * std::exp(-away * away);
  };
  EXPECT_LT(std::abs(run.last("body.m.x") - way_under(force, 2.0)), 1e-5);
}

// What is too short to be looked for is said.
TEST(Bells, AChangeBelowAMillionthOfTheRunIsDoubted) {
  const auto doubts = [](const char* value) {
    const ModelRun run = under(value, 1e-6);
    return std::ranges::count(run.outcome().doubts, "unresolved-input", &TrustReason::id);
  };
  EXPECT_EQ(doubts("1e6/(1 + ((t - 0.70031)/1e-8)^2)"), 1);
  EXPECT_EQ(doubts("1e3/(1 + ((t - 0.70031)/1e-5)^2)"), 0);
  EXPECT_EQ(doubts("1000*smooth(t, 0.5, 0.50000001)*(1 - smooth(t, 0.50000001, 0.50000002))"), 0);
}

}  // namespace
}  // namespace freeplay::test
