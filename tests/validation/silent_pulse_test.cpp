// Pulses of force that a plugin makes of the time without saying where they begin and end.
#include <cmath>
#include <random>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "pulse_joint.h"
#include "validation/run_model.h"

namespace freeplay {
namespace {

// Neither what jumps nor what bends in a pulse is known of a joint that says nothing of its corners.
TEST(SilentPulse, EndsWhereItShouldThoughItJumps) {
  std::mt19937_64 random(21);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const double end = 1.0;
  double worst = 0.0;
  for (int i = 0; i < 240; ++i) {
    const int shape = i % 3, told = i / 3 % 2;
    const double length = std::pow(10.0, (told == 0 ? -2.9 : -4.5) + 2.0 * unit(random));
    const double accuracy = std::pow(10.0, -4.0 - 4.0 * unit(random)), a = (end - length) * unit(random);
    const double middle = shape == 2 ? 2.0 / 3.0 : 0.5, mean = shape == 1 ? 1.0 : 0.5;
    const double height = 0.3 / (mean * length * (end - a - middle * length));
    const std::string text = fmt::format(
        "freeplay: 1\n"
        "bodies: {{m: {{mass: 1, inertia: 1}}}}\n"
        "joints: {{guide: {{type: prismatic, between: [ground, m]}}}}\n"
        "forces: {{hit: {{type: pulse, between: [ground, m], height: {:.17g}, begin: {:.17g}, "
        "duration: {:.17g}, told: {}, shape: {}}}}}\n"
        "simulation: {{end: {:.17g}, accuracy: {:.17g}}}\n",
        height, a, length, told, shape, end, accuracy);
    const test::ModelRun run(text, {}, {}, test::types_with_pulses());
    const double error = std::abs(run.last("body.m.x") - 0.3);
    EXPECT_LE(error, 10.0 * accuracy) << text;
    worst = std::max(worst, error / accuracy);
  }
  test::record("largest error over accuracy", worst);
}

}  // namespace
}  // namespace freeplay
