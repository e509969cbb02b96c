#include "run_model.h"

namespace freeplay::test {
namespace {

struct Account {
  double residual, power;  ///< largest residual [J], time integral of the drive's absolute power [J]
};

Account account(double step, double end) {
  const std::string text =
      replaced(mechanism("3-rrr"), "{interval: 0.1 ms, discard: $T/5}", "{interval: " + number(step) + "}");
  std::vector<std::string> columns = {"time", "energy.residual"};
  for (int i = 1; i <= 3; ++i) columns.push_back("driver.leg" + std::to_string(i) + ".A.power");
  const ModelRun run(text, {.set = {}, .ideal = {}, .end = end, .step = step, .integrator = {}}, columns);
  EXPECT_EQ(run.outcome().status, RunStatus::completed) << run.outcome().reason;
  Account sum{run.statistics().energy_residual(), 0.0};
  for (std::size_t i = 1; i < run.rows(); ++i) {
    double power = 0.0;
    for (std::size_t d = 2; d < columns.size(); ++d) power += run.at(i, columns[d]);
    sum.power += step * std::abs(power);
  }
  return sum;
}

// The account books what drives, forces and joints do; what the integrator loses is the residual, of second order.
TEST(ClearanceEnergy, ResidualIsSmallAndFallsWithTheStep) {
  const Account coarse = account(4e-6, 20e-3), middle = account(2e-6, 20e-3), fine = account(1e-6, 20e-3);
  record("residual_of_work_at_4_us", coarse.residual / coarse.power);
  record("residual_of_work_at_2_us", middle.residual / middle.power);
  record("residual_of_work_at_1_us", fine.residual / fine.power);
  EXPECT_LT(middle.residual, 1e-3 * middle.power);
  EXPECT_LT(fine.residual, middle.residual);
  EXPECT_LT(middle.residual, coarse.residual);
}

TEST(ClearanceEnergyLong, ResidualIsSmallOverAWholeTurn) {
  const Account middle = account(2e-6, 0.5);
  record("residual_of_work_at_2_us", middle.residual / middle.power);
  EXPECT_LT(middle.residual, 1e-3 * middle.power);
}

}  // namespace
}  // namespace freeplay::test
