#include "minimal_coordinates.h"
#include "run_model.h"

namespace freeplay::test {
namespace {

// Window of an order of two, measured between halvings with the largest error over fixed instants: what terms of higher
// order leave at these steps.
constexpr double lowest_order = 1.8, highest_order = 2.3;

struct Errors {
  double q = 0.0, v = 0.0, force = 0.0;  ///< largest over instants and components [m, rad; per s; N]
};
void widen(double& largest, double difference) { largest = std::max(largest, std::abs(difference)); }

void expect_orders(const std::vector<Errors>& errors) {
  for (std::size_t i = 1; i < errors.size(); ++i) {
    const double q = order(errors[i - 1].q, errors[i].q), v = order(errors[i - 1].v, errors[i].v);
    const double force = order(errors[i - 1].force, errors[i].force);
    for (const double observed : {q, v, force}) {
      EXPECT_GE(observed, lowest_order) << "halving " << i;
      EXPECT_LE(observed, highest_order) << "halving " << i;
    }
    if (i + 1 < errors.size()) continue;
    record("order_q", q);
    record("order_v", v);
    record("order_force", force);
  }
}

std::string simulation(double end, double step, double interval, const std::string& integrator) {
  return "simulation: {end: " + number(end) + ", step: " + number(step) + ", integrator: {type: bathe" + integrator +
         "}, output: {interval: " + number(interval) + "}}\n";
}

/// Error of a row of body `name`, a uniform rod of 1 m.
struct RodRow {
  long double x, y, angle, vx, vy, rate;
};
void compare(const ModelRun& run, std::size_t row, const std::string& name, const RodRow& want, Errors& errors) {
  const auto off = [&](const char* quantity, long double value) {
    return run.at(row, "body." + name + "." + quantity) - static_cast<double>(value);
  };
  widen(errors.q, off("x", want.x));
  widen(errors.q, off("y", want.y));
  widen(errors.q, std::remainder(off("angle", want.angle), 2.0 * M_PI));
  widen(errors.v, off("vx", want.vx));
  widen(errors.v, off("vy", want.vy));
  widen(errors.v, off("omega", want.rate));
}

// --- one rod ---------------------------------------------------------------------------------------------------------

Errors rod_errors(double step, const std::string& integrator) {
  std::string text = mechanism("pendulum");
  text = replaced(text, "simulation: {end: 2 s, step: 1 ms}\n", simulation(1.0, step, 0.04, integrator));
  const ModelRun run(text);
  EXPECT_EQ(run.rows(), 26u);
  static const auto reference = RodChain<1>::integrate({0.0L}, 0.04, 25);
  Errors errors;
  for (std::size_t i = 1; i < run.rows(); ++i) {
    const long double q = reference[i].angle[0], w = reference[i].rate[0], a = reference[i].acceleration[0];
    const long double c = std::cos(q), s = std::sin(q);
    compare(run, i, "rod", {0.5L * c, 0.5L * s, q, -0.5L * s * w, 0.5L * c * w, w}, errors);
    // Force on the rod: mass times acceleration less weight.
    widen(errors.force, run.at(i, "joint.pivot.fx") - static_cast<double>(0.5L * (-s * a - c * w * w)));
    widen(errors.force, run.at(i, "joint.pivot.fy") - static_cast<double>(0.5L * (c * a - s * w * w) + 9.81L));
  }
  return errors;
}

struct ErrorTable {
  const char* name;
  const char* integrator;
  double q[5], v[5], force[5];
};
class RodPendulum : public ::testing::TestWithParam<ErrorTable> {};

// Errors at steps of 0.04 s halved four times, by a small planar kernel of its own (full Newton, velocity projection
// and post-solve), against DOP853 in minimal coordinates, rtol 1e-13. The factor of 1.5 leaves room for another Newton
// iteration, not for another method.
TEST_P(RodPendulum, ErrorsAndOrdersEqualThoseOfTheMethod) {
  const ErrorTable& table = GetParam();
  std::vector<Errors> errors;
  double step = 0.04, worst = 1.0;
  for (std::size_t i = 0; i < 5; ++i, step *= 0.5) {
    errors.push_back(rod_errors(step, table.integrator));
    const double ratios[] = {errors[i].q / table.q[i], errors[i].v / table.v[i], errors[i].force / table.force[i]};
    for (const double ratio : ratios) {
      worst = std::max({worst, ratio, 1.0 / ratio});
      EXPECT_LT(ratio, 1.5) << "step " << step;
      EXPECT_GT(ratio, 1.0 / 1.5) << "step " << step;
    }
  }
  record("largest_ratio_to_the_table", worst);
  expect_orders(errors);
}
void PrintTo(const ErrorTable& table, std::ostream* out) { *out << table.name; }

INSTANTIATE_TEST_SUITE_P(Splits, RodPendulum,
                         ::testing::Values(ErrorTable{"half",
                                                      ", split: 0.5",
                                                      {0.0092229, 0.0022849, 0.00056732, 0.00014127, 3.5242e-05},
                                                      {0.033748, 0.0087198, 0.0022124, 0.00055698, 0.00013971},
                                                      {0.17097, 0.043075, 0.01078, 0.0026945, 0.00067347}},
                                           ErrorTable{"optimal",
                                                      ", split: optimal",
                                                      {0.0090225, 0.0022354, 0.00055505, 0.00013821, 3.4481e-05},
                                                      {0.03299, 0.0085278, 0.0021642, 0.00054489, 0.00013669},
                                                      {0.1672, 0.042147, 0.010551, 0.0026376, 0.0006593}}),
                         [](const auto& made) { return std::string(made.param.name); });

// DOP853 in minimal coordinates, rtol 1e-13, at 1 s.
TEST(RodChainReference, OneRodEqualsAnIndependentIntegration) {
  const auto end = RodChain<1>::integrate({0.0L}, 0.04, 25).back();
  EXPECT_NEAR(static_cast<double>(end.angle[0]), -3.133418044829, 1e-11);
  EXPECT_NEAR(static_cast<double>(end.rate[0]), 0.4904855312988, 1e-11);
  EXPECT_NEAR(static_cast<double>(end.acceleration[0]), 14.7145083435, 1e-9);
}

// --- two rods --------------------------------------------------------------------------------------------------------

constexpr const char* two_rods =
    "freeplay: 1\ngravity: [0, -9.81]\n"
    "bodies:\n"
    "  upper: {mass: 1, inertia: 1/12, com: [0.5, 0], frames: {tip: [1, 0]}}\n"
    "  lower: {mass: 1, inertia: 1/12, com: [0.5, 0]}\n"
    "joints:\n"
    "  first: {type: revolute, between: [ground, upper]}\n"
    "  second: {type: revolute, between: [upper/tip, lower]}\n";

// DOP853, rtol 3e-14.
TEST(RodChainReference, TwoRodsEqualAnIndependentIntegration) {
  const auto all = RodChain<2>::integrate({0.0L, 0.0L}, 1.0, 2);
  EXPECT_NEAR(static_cast<double>(all[1].angle[0]), -2.77851256499, 1e-10);
  EXPECT_NEAR(static_cast<double>(all[1].angle[1]), -2.38518734989, 1e-10);
  EXPECT_NEAR(static_cast<double>(all[1].rate[0]), -3.40651753297, 1e-10);
  EXPECT_NEAR(static_cast<double>(all[1].rate[1]), -0.516045472105, 1e-10);
  EXPECT_NEAR(static_cast<double>(all[2].angle[1]), -1.16343425188, 1e-10);
}

Errors double_rod_errors(double step) {
  const ModelRun run(two_rods + std::string("initial: {joints: {first: 0, second: 0}}\n") +
                     simulation(1.0, step, 0.05, ""));
  static const auto reference = RodChain<2>::integrate({0.0L, 0.0L}, 0.05, 20);
  EXPECT_EQ(run.rows(), reference.size());
  Errors errors;
  for (std::size_t i = 1; i < run.rows(); ++i) {
    const auto& [q, w, a] = reference[i];
    // A point at r along a rod that starts at p.
    struct Point {
      long double x = 0, y = 0, vx = 0, vy = 0, ax = 0, ay = 0;
    };
    const auto along = [&q = q, &w = w, &a = a](const Point& p, std::size_t rod, long double r) {
      const long double c = r * std::cos(q[rod]), s = r * std::sin(q[rod]), rate = w[rod], second = a[rod];
      return Point{p.x + c,
                   p.y + s,
                   p.vx - s * rate,
                   p.vy + c * rate,
                   p.ax - s * second - c * rate * rate,
                   p.ay + c * second - s * rate * rate};
    };
    const Point upper = along({}, 0, 0.5L), tip = along({}, 0, 1.0L), lower = along(tip, 1, 0.5L);
    compare(run, i, "upper", {upper.x, upper.y, q[0], upper.vx, upper.vy, w[0]}, errors);
    compare(run, i, "lower", {lower.x, lower.y, q[1], lower.vx, lower.vy, w[1]}, errors);
    widen(errors.force, run.at(i, "joint.second.fx") - static_cast<double>(lower.ax));
    widen(errors.force, run.at(i, "joint.second.fy") - static_cast<double>(lower.ay + 9.81L));
    widen(errors.force, run.at(i, "joint.first.fx") - static_cast<double>(lower.ax + upper.ax));
    widen(errors.force, run.at(i, "joint.first.fy") - static_cast<double>(lower.ay + upper.ay + 2.0L * 9.81L));
  }
  return errors;
}

TEST(DoubleRodPendulum, ErrorsAreOfSecondOrder) {
  std::vector<Errors> errors;
  double step = 0.005;
  for (int i = 0; i < 5; ++i, step *= 0.5) errors.push_back(double_rod_errors(step));
  record("error_q_at_5_ms", errors[0].q);
  record("error_q_of_finest", errors[4].q);
  expect_orders(errors);
}

// --- long runs -------------------------------------------------------------------------------------------------------

struct EnergyTable {
  const char* name;
  std::string text;
  double step;
  double change[4];  ///< after 500, 1000, 2000, 3000 steps [J]
};
class PendulumEnergy : public ::testing::TestWithParam<EnergyTable> {};

// Change of energy by a small planar kernel of its own with the same method; 2 % is what other rounding may leave after
// thousands of steps.
TEST_P(PendulumEnergy, NeverGrowsOverThousandsOfSteps) {
  const EnergyTable& table = GetParam();
  const ModelRun run(table.text + simulation(3000 * table.step, table.step, table.step, ""), {},
                     {"time", "energy.residual"});
  ASSERT_EQ(run.outcome().steps, 3000);
  const std::size_t after[] = {500, 1000, 2000, 3000};
  for (std::size_t i = 0; i < 4; ++i) {
    const double change = run.at(after[i], "energy.residual");
    record("change_after_" + std::to_string(after[i]), change);
    EXPECT_NEAR(change, table.change[i], 0.02 * std::abs(table.change[i])) << after[i] << " steps";
  }
  double highest = 0.0;
  for (std::size_t i = 0; i < run.rows(); ++i) highest = std::max(highest, run.at(i, "energy.residual"));
  record("highest_change", highest);
  EXPECT_LE(highest, 1e-12);  // never above the start, to rounding of 10 J
}
void PrintTo(const EnergyTable& table, std::ostream* out) { *out << table.name; }

std::string rod_text() { return replaced(mechanism("pendulum"), "simulation: {end: 2 s, step: 1 ms}\n", ""); }
INSTANTIATE_TEST_SUITE_P(
    Pendulums, PendulumEnergy,
    ::testing::Values(EnergyTable{"rod", rod_text(), 0.02, {-0.010815, -0.017649, -0.033915, -0.043387}},
                      EnergyTable{
                          "double",
                          two_rods + std::string("initial: {joints: {first: -0.5707963267948966, second: 0}}\n"),
                          0.01,
                          {-0.00059288, -0.0012775, -0.0024589, -0.0055712}}),
    [](const auto& made) { return std::string(made.param.name); });

}  // namespace
}  // namespace freeplay::test
