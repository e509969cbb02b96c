#include <array>
#include <cmath>

#include "joint_probe.h"

namespace freeplay::test {
namespace {

const Component& row() { return joint_row("spring-damper"); }

ParameterStub spring(int kind, std::map<std::string, double> numbers) {
  ParameterStub stub(row());
  stub.words["kind"] = kind;
  stub.numbers = std::move(numbers);
  return stub;
}

struct Applied {
  std::array<double, 12> wrench{};
  double potential = 0.0;
};

/// What the host does: the coordinate in the turn nearest to `last`.
double counted(const JointInstance& joint, const JointInput& in, double last) {
  CoordinateRow row{};
  joint.call(&abi::JointTable::coordinate, &in, &row);
  return row.value + 2.0 * M_PI * std::round((last - row.value) / (2.0 * M_PI));
}

Applied apply(const JointInstance& joint, const MarkerKinematics& a, const MarkerKinematics& b, double last = 0.0,
              std::vector<double>* derivatives = nullptr) {
  JointInput in = input(0.0, a, b, {}, {});
  in.coordinate = counted(joint, in, last);
  JointForces out{};
  if (derivatives != nullptr) {
    derivatives->assign(12 * 24, 0.0);
    out.derivatives = {derivatives->data(), derivatives->size()};
  }
  joint.call(&abi::JointTable::apply, &in, &out);
  Applied applied;
  for (std::size_t i = 0; i < 6; ++i) {
    applied.wrench[i] = out.wrench_a[i];
    applied.wrench[6 + i] = out.wrench_b[i];
  }
  applied.potential = out.potential;
  return applied;
}

TEST(SpringDamper, PullsTheEndsTogether) {
  const JointInstance joint(
      row(), spring(0, {{"stiffness", 100.0}, {"damping", 2.0}, {"free_length", 0.25}, {"preload", 3.0}}));
  // Along (0.6, 0.8), 0.5 m apart, parting at 0.6 * 1 + 0.8 * 2 = 2.2 m/s: 25 + 4.4 + 3 = 32.4 N.
  const Applied f = apply(joint, planar_marker(0, 0, 0.3), planar_marker(0.3, 0.4, 1.0, 1.0, 2.0, 5.0));
  EXPECT_NEAR(f.wrench[6], -32.4 * 0.6, 1e-13);
  EXPECT_NEAR(f.wrench[7], -32.4 * 0.8, 1e-13);
  EXPECT_NEAR(f.wrench[0], 32.4 * 0.6, 1e-13);
  EXPECT_NEAR(f.potential, 0.5 * 100.0 * 0.0625 + 3.0 * 0.25, 1e-13);
}

TEST(SpringDamper, HasNoForceWithoutADirection) {
  const JointInstance joint(row(), spring(0, {{"stiffness", 100.0}, {"free_length", 0.25}}));
  const MarkerKinematics a = planar_marker(1, 2, 0);
  EXPECT_EQ(apply(joint, a, a).wrench, (std::array<double, 12>{}));
  EXPECT_NEAR(apply(joint, a, a).potential, 0.5 * 100.0 * 0.0625, 1e-13);
}

TEST(SpringDamper, TurnsTheFramesTogetherAndCountsTurns) {
  const JointInstance joint(row(),
                            spring(1, {{"stiffness", 5.0}, {"damping", 0.5}, {"free_angle", 0.2}, {"preload", 0.1}}));
  // The last accepted angle is near 2 pi: 0.7 means 2 pi + 0.7.
  const Applied f = apply(joint, planar_marker(0, 0, 0.3, 0, 0, 1.0), planar_marker(1, 1, 1.0, 0, 0, 3.0), 6.0);
  const double torque = 5.0 * (2.0 * M_PI + 0.7 - 0.2) + 0.5 * 2.0 + 0.1;
  EXPECT_NEAR(f.wrench[11], -torque, 1e-12);
  EXPECT_NEAR(f.wrench[5], torque, 1e-12);
  EXPECT_EQ(f.wrench[6], 0.0);
}

TEST(SpringDamper, ForceIsTheSlopeOfWhatItStores) {
  const JointInstance joint(row(), spring(0, {{"stiffness", 100.0}, {"free_length", 0.25}, {"preload", 3.0}}));
  const double step = 1e-6;
  const auto stored = [&](double x) {
    return apply(joint, planar_marker(0, 0, 0), planar_marker(x, 0.4, 0)).potential;
  };
  const double slope = (stored(0.3 + step) - stored(0.3 - step)) / (2.0 * step);
  EXPECT_NEAR(apply(joint, planar_marker(0, 0, 0), planar_marker(0.3, 0.4, 0)).wrench[6], -slope, 1e-7);
}

void expect_derivatives(const JointInstance& joint, double last) {
  const double x[12] = {0.3, -0.2, 0.7, 0.5, 1.1, 2.3, 0.9, 0.4, 1.6, -0.8, 0.3, -1.7};  // a, b: pose, twist
  const auto at = [&](std::size_t moved, double step) {
    double y[12];
    for (std::size_t i = 0; i < 12; ++i) y[i] = x[i] + (i == moved ? step : 0.0);
    return apply(joint, planar_marker(y[0], y[1], y[2], y[3], y[4], y[5]),
                 planar_marker(y[6], y[7], y[8], y[9], y[10], y[11]), last)
        .wrench;
  };
  std::vector<double> table;
  apply(joint, planar_marker(x[0], x[1], x[2], x[3], x[4], x[5]), planar_marker(x[6], x[7], x[8], x[9], x[10], x[11]),
        last, &table);
  const std::size_t columns[12] = {0, 1, 5, 12, 13, 17, 6, 7, 11, 18, 19, 23};
  for (std::size_t i = 0; i < 12; ++i) {
    const auto after = at(i, 1e-6), before = at(i, -1e-6);
    for (std::size_t r = 0; r < 12; ++r) {
      EXPECT_NEAR(table[24 * r + columns[i]], (after[r] - before[r]) / 2e-6, 1e-6) << r << " by " << columns[i];
    }
  }
}

TEST(SpringDamper, DerivativesAreThoseOfTheForce) {
  expect_derivatives(
      JointInstance(row(),
                    spring(0, {{"stiffness", 100.0}, {"damping", 7.0}, {"free_length", 0.25}, {"preload", 3.0}})),
      0.0);
  expect_derivatives(JointInstance(row(), spring(1, {{"stiffness", 5.0}, {"damping", 0.5}})), 0.9);
}

/// s(x) = 40 x + 300 x^3 and d(v, x) = (2 + x) v |v|.
constexpr abi::FormulaTable cubic{
    sizeof(abi::FormulaTable),
    [](const void*, Span<const double> x, double* value, Span<double> slopes, Message*) noexcept {
      *value = (40.0 + 300.0 * x[0] * x[0]) * x[0];
      if (!slopes.empty()) slopes[0] = 40.0 + 900.0 * x[0] * x[0];
      return Status::ok;
    },
    [](const void*) noexcept { return std::int32_t{0}; },
    [](const void*, Span<const double>, Span<double>) noexcept {}};
constexpr abi::FormulaTable quadratic{
    sizeof(abi::FormulaTable),
    [](const void*, Span<const double> x, double* value, Span<double> slopes, Message*) noexcept {
      *value = (2.0 + x[1]) * x[0] * std::abs(x[0]);
      if (!slopes.empty()) slopes[1] = x[0] * std::abs(x[0]), slopes[0] = 2.0 * (2.0 + x[1]) * std::abs(x[0]);
      return Status::ok;
    },
    [](const void*) noexcept { return std::int32_t{1}; },
    [](const void*, Span<const double> x, Span<double> g) noexcept { g[0] = x[0]; }};

ParameterStub with_formulas(int kind, std::map<std::string, double> numbers) {
  ParameterStub stub = spring(kind, std::move(numbers));
  stub.formulas["spring"] = Formula(cubic, nullptr);
  stub.formulas["damper"] = Formula(quadratic, nullptr);
  return stub;
}

TEST(SpringDamper, AddsWhatFormulasPull) {
  const JointInstance joint(row(), with_formulas(0, {{"stiffness", 100.0}, {"damping", 2.0}, {"free_length", 0.25}}));
  const Applied f = apply(joint, planar_marker(0, 0, 0.3), planar_marker(0.3, 0.4, 1.0, 1.0, 2.0, 5.0));
  const double x = 0.25, v = 2.2, pull = 100.0 * x + 2.0 * v + 40.0 * x + 300.0 * x * x * x + (2.0 + x) * v * v;
  EXPECT_NEAR(f.wrench[6], -pull * 0.6, 1e-12);
  EXPECT_NEAR(f.wrench[7], -pull * 0.8, 1e-12);
  EXPECT_NEAR(f.potential, 70.0 * x * x + 75.0 * x * x * x * x, 1e-9);
  const Applied pressed = apply(joint, planar_marker(0, 0, 0), planar_marker(0.1, 0, 0));
  EXPECT_NEAR(pressed.potential, 70.0 * 0.0225 + 75.0 * 0.15 * 0.15 * 0.0225, 1e-9);
  for (const int kind : {0, 1}) {
    expect_derivatives(JointInstance(row(), with_formulas(kind, {{"stiffness", 5.0}, {"damping", 0.5}})), 0.9);
  }
}

TEST(SpringDamper, TellsTheKinksOfItsFormulas) {
  const JointInstance joint(row(), with_formulas(0, {}));
  JointLayout layout;
  joint.call(&abi::JointTable::declare, &layout);
  ASSERT_EQ(layout.kinks, 1);
  const MarkerKinematics a = planar_marker(0, 0, 0), b = planar_marker(0.3, 0.4, 0, 1.0, 2.0);
  const JointInput in = input(0.0, a, b, {}, {});
  double g = 0.0;
  joint.call(&abi::JointTable::kinks, &in, Span<double>(&g, 1));
  EXPECT_NEAR(g, 2.2, 1e-14);
}

TEST(SpringDamper, RefusesTheFreePositionOfTheOtherKind) {
  EXPECT_EQ(bad_parameter_id([] { JointInstance(row(), spring(0, {{"free_angle", 0.1}})); }), "conflicting-keys");
  EXPECT_EQ(bad_parameter_id([] { JointInstance(row(), spring(1, {{"free_length", 0.1}})); }), "conflicting-keys");
}

}  // namespace
}  // namespace freeplay::test
