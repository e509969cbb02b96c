#include "run_model.h"

namespace freeplay::test {
namespace {

const std::vector<std::string>& positions() {
  static const std::vector<std::string> names = {"body.crank.x",   "body.crank.y",   "body.crank.angle",
                                                 "body.coupler.x", "body.coupler.y", "body.coupler.angle",
                                                 "body.rocker.x",  "body.rocker.y",  "body.rocker.angle"};
  return names;
}
const std::vector<std::string>& velocities() {
  static const std::vector<std::string> names = {"body.crank.vx",   "body.crank.vy",   "body.crank.omega",
                                                 "body.coupler.vx", "body.coupler.vy", "body.coupler.omega",
                                                 "body.rocker.vx",  "body.rocker.vy",  "body.rocker.omega"};
  return names;
}
const std::vector<std::string>& forces() {
  static const std::vector<std::string> names = {"joint.A.fx", "joint.A.fy", "joint.B.fx", "joint.B.fy",
                                                 "joint.C.fx", "joint.C.fy", "joint.D.fx", "joint.D.fy"};
  return names;
}

std::string driven_by_torque() {
  const std::string text = replaced(mechanism("four-bar"), "{joint: A, kind: velocity, value: $speed}",
                                    "{joint: A, kind: torque, value: \"0.3*cos(5*t)\"}");
  return replaced(replaced(text, "parameters: {speed: 60 rpm}\n", ""), "simulation: {end: 2 s, step: 1 ms}",
                  "simulation: {end: 1 s, output: {interval: 50 ms}}");
}
ModelRun run_with(double step) {
  return ModelRun(driven_by_torque(), {.set = {}, .ideal = {}, .end = {}, .step = step, .integrator = {}});
}

double largest_difference(const ModelRun& a, const ModelRun& b, const std::vector<std::string>& names) {
  double largest = 0.0;
  for (std::size_t i = 1; i < a.rows(); ++i) {
    for (const std::string& name : names) largest = std::max(largest, std::abs(a.at(i, name) - b.at(i, name)));
  }
  return largest;
}

// The reference is a step eight times finer than the finest one tried: it shifts an order by 0.02.
TEST(FourBar, DrivenByATorqueErrorsAreOfSecondOrder) {
  const ModelRun reference = run_with(0.01 / 128);
  const struct {
    const char* name;
    const std::vector<std::string>& channels;
  } groups[] = {{"q", positions()}, {"v", velocities()}, {"force", forces()}};
  std::vector<std::vector<double>> errors(3);
  for (int i = 0; i < 5; ++i) {
    const ModelRun run = run_with(0.01 / (1 << i));
    ASSERT_EQ(run.rows(), reference.rows());
    for (std::size_t g = 0; g < 3; ++g) errors[g].push_back(largest_difference(run, reference, groups[g].channels));
  }
  for (std::size_t g = 0; g < 3; ++g) {
    for (std::size_t i = 1; i < errors[g].size(); ++i) {
      const double observed = order(errors[g][i - 1], errors[g][i]);
      EXPECT_GE(observed, 1.8) << groups[g].name << " halving " << i;
      EXPECT_LE(observed, 2.3) << groups[g].name << " halving " << i;
      record(std::string("order_") + groups[g].name, observed);
    }
    record(std::string("finest_error_") + groups[g].name, errors[g].back());
  }
}

// At constant crank speed nothing is left to integrate: positions are those of the closed form whatever the step.
TEST(FourBar, DrivenAtConstantSpeedPositionsAreTheClosedForm) {
  const std::string text =
      replaced(mechanism("four-bar"), "{end: 2 s, step: 1 ms}", "{end: 2 s, step: 10 ms, output: {interval: 10 ms}}");
  const ModelRun run(text);
  double worst = 0.0;
  for (std::size_t i = 0; i < run.rows(); ++i) {
    const double crank = M_PI / 3.0 + 2.0 * M_PI * run.at(i, "time");
    const double bx = 0.1 * std::cos(crank), by = 0.1 * std::sin(crank);
    // Circle of 0.3 m about B, of 0.25 m about D = (0.4, 0); the branch above the line B-D.
    const double dx = 0.4 - bx, dy = -by, distance = std::hypot(dx, dy);
    const double along = (distance * distance + 0.09 - 0.0625) / (2.0 * distance);
    const double across = std::sqrt(0.09 - along * along);
    const double cx = bx + (along * dx - across * dy) / distance, cy = by + (along * dy + across * dx) / distance;
    worst = std::max({worst, std::abs(run.at(i, "body.coupler.x") - 0.5 * (bx + cx)),
                      std::abs(run.at(i, "body.coupler.y") - 0.5 * (by + cy)),
                      std::abs(run.at(i, "body.rocker.x") - 0.5 * (0.4 + cx)),
                      std::abs(run.at(i, "body.rocker.y") - 0.5 * cy)});
  }
  record("worst_difference", worst);
  EXPECT_LE(worst, 1e-11);  // stages end at 1e-10 of 0.4 m, in fact at rounding
}

// Torque of the motor in closed form: power of the drive is the rate of kinetic energy (no gravity, no loss).
TEST(FourBar, DrivenAtConstantSpeedPowerIsTheRateOfEnergy) {
  const std::string text =
      replaced(mechanism("four-bar"), "{end: 2 s, step: 1 ms}", "{end: 1 s, step: 1 ms, output: {interval: 1 ms}}");
  const ModelRun run(text);
  double worst = 0.0, largest = 0.0;
  for (std::size_t i = 2; i + 2 < run.rows(); ++i) {
    const auto energy = [&](std::size_t row) { return run.at(row, "energy.kinetic"); };
    const double rate = (8.0 * (energy(i + 1) - energy(i - 1)) - (energy(i + 2) - energy(i - 2))) / 12.0e-3;
    worst = std::max(worst, std::abs(rate - run.at(i, "driver.motor.power")));
    largest = std::max(largest, std::abs(rate));
  }
  record("worst_of_largest_power", worst / largest);
  EXPECT_LE(worst, 1e-6 * largest);  // differences of fourth order over 1 ms
}

}  // namespace
}  // namespace freeplay::test
