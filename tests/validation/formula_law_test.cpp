// Laws and springs that formulas give: runs against those of the built-in twins, orders, energy, closed forms.
#include "puck.h"

namespace freeplay::test::formula_law {
namespace {

constexpr const char* built_in = "{law: lankarani-nikravesh, K: 5e9, restitution: 0.9}";
constexpr const char* formula = "{law: expression, force: \"5e9 N/m^1.5*delta^1.5*(1 + (0.1425/v0)*rate)\"}";

/// A slider-crank whose wrist has play, up to a time at which its impacts have not yet magnified roundings: after 3 ms
/// they have by 1e6.
std::string slider_crank(const std::string& contact, const std::string& friction, const std::string& simulation) {
  std::string text = replaced(mechanism("slider-crank"), "{law: lankarani-nikravesh, restitution: 0.9}", contact);
  if (!friction.empty())
    text = replaced(text, "contact: " + contact, "contact: " + contact + "\n      friction: " + friction);
  return replaced(text, "simulation: {end: 24 ms, step: 1 us, output: {interval: 20 us, discard: 12 ms}}",
                  "simulation: {" + simulation + ", output: {interval: 20 us}}");
}

/// Largest difference of a column over its largest value.
double difference(const ModelRun& one, const ModelRun& other, const std::string& column) {
  double apart = 0.0, largest = 0.0;
  for (std::size_t row = 0; row < std::min(one.rows(), other.rows()); ++row) {
    apart = std::max(apart, std::abs(one.at(row, column) - other.at(row, column)));
    largest = std::max(largest, std::abs(other.at(row, column)));
  }
  return apart / largest;
}

class FormulaLawRun : public ::testing::TestWithParam<const char*> {};
TEST_P(FormulaLawRun, IsThatOfTheLawWhichItCopies) {
  const std::string simulation = GetParam();
  const ModelRun one(slider_crank(formula, "{law: expression, coefficient: \"0.1*tanh(vt/(1 mm/s))\"}", simulation));
  const ModelRun other(slider_crank(built_in, "{law: coulomb-tanh, mu: 0.1}", simulation));
  ASSERT_EQ(one.outcome().exit_code, 0) << one.outcome().reason;
  ASSERT_EQ(one.rows(), other.rows());
  EXPECT_EQ(one.outcome().steps, other.outcome().steps);
  EXPECT_GT(contacts(one).size(), 0u);
  for (const char* column : {"body.slider.x", "joint.wrist.ey", "joint.wrist.fn"}) {
    record(column, difference(one, other, column));
    EXPECT_LT(difference(one, other, column), 1e-9) << column;
  }
  EXPECT_NEAR(one.last("energy.dissipated"), other.last("energy.dissipated"), 1e-9 * other.last("energy.dissipated"));
  EXPECT_LT(std::abs(one.last("energy.residual")), 1e-3 * one.last("energy.dissipated"));
}
INSTANTIATE_TEST_SUITE_P(Methods, FormulaLawRun,
                         ::testing::Values("end: 0.85 ms, step: 0.5 us, integrator: bathe",
                                           "end: 0.85 ms, accuracy: 10 nm, integrator: dopri5"));

}  // namespace
}  // namespace freeplay::test::formula_law
