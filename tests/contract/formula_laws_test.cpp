// Laws that formulas give keep the contract of laws, and are those that they copy.
#include <cmath>

#include <gtest/gtest.h>

#include "allocation_counter.h"
#include "component/instances.h"
#include "contract/law_contract.h"
#include "contract/sample_parameters.h"
#include "findings_text.h"
#include "format/parameter_tree.h"
#include "format/table_variables.h"
#include "model/written_formula.h"

namespace freeplay::test::formula_laws {
namespace {

using Texts = std::map<std::string, std::string>;
using Numbers = std::map<std::string, double>;

const Registry& types() {
  static const Registry all = Registry::with_builtins();
  return all;
}

/// What a model file would say of a law.
ParameterBlock block_of(ComponentKind kind, const char* law, const Texts& formulas, const Numbers& numbers = {}) {
  ParameterBlock block;
  block.component = types().find(kind, law);
  for (const Parameter& p : block.component->description.parameters) {
    ParameterValue& value = block.values[p.name];
    if (p.kind == ParameterKind::number) value.number = p.default_value;
    if (const auto number = numbers.find(p.name); number != numbers.end()) {
      value.given = true;
      value.number = number->second;
    }
    const auto text = formulas.find(p.name);
    if (text == formulas.end()) continue;
    TableVariables variables;
    for (const VariableRow& row : variables_of(p)) variables.add(row.name, parse_unit(row.unit).dimension);
    value.given = true;
    set_formula(value, Expression::compile(text->second, EmptyScope(), false, variables), {"model.yaml", 3, 10}, true);
  }
  return block;
}

struct Contact {
  explicit Contact(const Texts& formulas, const char* law = "expression", const Numbers& numbers = {}) {
    const ParameterBlock block = block_of(ComponentKind::contact_law, law, formulas, numbers);
    ref = instances.create_contact_law(block, sample_contact_pair(), fault);
    twin = instances.create_contact_law(block, sample_contact_pair(), fault);
  }
  Instances instances;
  CreationFault fault;
  ContactLawRef ref, twin;
};

struct Friction {
  explicit Friction(const Texts& formulas, const char* law = "expression", const Numbers& numbers = {}) {
    const ParameterBlock block = block_of(ComponentKind::friction_law, law, formulas, numbers);
    ref = instances.create_friction_law(block, fault);
    twin = instances.create_friction_law(block, fault);
  }
  Instances instances;
  CreationFault fault;
  FrictionLawRef ref, twin;
};

const Conditions formula_conditions{.seed = 1, .allocations = &allocations};

class FormulaContactLaw : public testing::TestWithParam<const char*> {};
TEST_P(FormulaContactLaw, KeepsTheContract) {
  const Contact law(Texts{{"force", GetParam()}});
  ASSERT_EQ(law.fault.text, "");
  const Findings findings = check_contact_law({law.ref, law.twin, 1e-4, true}, formula_conditions);
  EXPECT_TRUE(findings.held()) << broken_rules(findings);
}
INSTANTIATE_TEST_SUITE_P(Laws, FormulaContactLaw,
                         testing::Values("1e9 N/m^1.5*delta^1.5*(1 + 0.1425*rate/v0)", "1e6 N/m*delta + 50 N*s/m*rate",
                                         "1e6 N/m*delta + 4e6 N/m*max(0, delta - 3 um)",
                                         "if(delta < 1 um, 0, 2e9 N/m^1.5*(delta - 1 um)^1.5)",
                                         "1e5 N/m*delta*if(rate > 0, 1, 0.6)",
                                         "30 N*tanh(delta/(5 um))*(1 + 0.2*rate/v0)", "1e3 N*(exp(delta/(1 mm)) - 1)"));

class FormulaFrictionLaw : public testing::TestWithParam<const char*> {};
TEST_P(FormulaFrictionLaw, KeepsTheContract) {
  const Friction law(Texts{{"coefficient", GetParam()}});
  ASSERT_EQ(law.fault.text, "");
  const Findings findings = check_friction_law({law.ref, law.twin}, formula_conditions);
  EXPECT_TRUE(findings.held()) << broken_rules(findings);
}
INSTANTIATE_TEST_SUITE_P(Laws, FormulaFrictionLaw,
                         testing::Values("0.2*tanh(vt/(1 mm/s))", "0.2*max(-1, min(1, vt/(1 mm/s)))",
                                         "(0.1 + 0.1*exp(-(vt/(0.1 m/s))^2))*tanh(vt/(1 mm/s)) + 0.01 s/m*vt",
                                         "0.3*tanh(vt/(1 mm/s))/(1 + fn/(100 N))^0.3"));

TEST(FormulaLaws, AreThoseThatTheyCopy) {
  const Contact built_in({}, "lankarani-nikravesh", {{"K", 5e9}, {"restitution", 0.9}});
  const Contact copy(Texts{{"force", "5e9 N/m^1.5*delta^1.5*(1 + (0.1425/v0)*rate)"}});
  for (const double delta : {1e-12, 3e-9, 2e-7, 4e-6, 3e-5}) {
    for (const double v0 : {0.0, 1e-3, 0.3}) {
      for (const double rate : {-2.0, -0.1, 0.0, 0.2}) {
        const ContactForce want = built_in.ref.evaluate({delta, rate, v0}), got = copy.ref.evaluate({delta, rate, v0});
        // The factor of the loss may be a small difference of large terms.
        const double terms = v0 > 0.0 ? 1.0 + 0.1425 * std::abs(rate) / v0 : 1.0, rounding = 1e-15 * terms;
        const double slope = 1.5 * want.elastic / delta;
        EXPECT_NEAR(got.normal, want.normal, rounding * want.elastic);
        EXPECT_NEAR(got.d_penetration, want.d_penetration, rounding * slope);
        EXPECT_NEAR(got.d_rate, want.d_rate, rounding * want.d_rate);
        EXPECT_NEAR(got.elastic, want.elastic, rounding * want.elastic);
        EXPECT_NEAR(got.potential, want.potential, 1e-10 * want.potential) << delta;
      }
    }
  }
  const Friction tanh_law({}, "coulomb-tanh", {{"mu", 0.2}, {"vs", 1e-3}});
  const Friction same(Texts{{"coefficient", "0.2*tanh(vt/(1 mm/s))"}});
  for (const double slip : {-2.0, -3e-4, 0.0, 1e-5, 1e-3}) {
    const FrictionForce want = tanh_law.ref.evaluate({25.0, slip, {}}, {}),
                        got = same.ref.evaluate({25.0, slip, {}}, {});
    EXPECT_NEAR(got.tangential, want.tangential, 1e-15 * std::abs(want.tangential));
    EXPECT_NEAR(got.d_slip, want.d_slip, 1e-14 * std::abs(want.d_slip) + 1e-11);
    EXPECT_NEAR(got.d_normal, want.d_normal, 1e-15 * std::abs(want.d_normal));
  }
}

TEST(FormulaLaws, StoreTheIntegralOfTheirForce) {
  // Two springs, the second from 3 um on; and a soft layer whose force is in closed form.
  const Contact stops(Texts{{"force", "1e6 N/m*delta + 4e6 N/m*max(0, delta - 3 um)"}});
  const Contact layer(Texts{{"force", "1e3 N*(exp(delta/(1 mm)) - 1)"}});
  for (const double x : {1e-7, 2.9e-6, 3.1e-6, 8e-5, 2e-3}) {
    const double deep = std::max(0.0, x - 3e-6), closed = 5e5 * x * x + 2e6 * deep * deep;
    EXPECT_NEAR(stops.ref.evaluate({x, 0.0, 0.1}).potential, closed, 1e-10 * closed) << x;
    const double u = x / 1e-3, series = u * u * (0.5 + u * (1.0 / 6.0 + u * (1.0 / 24.0 + u / 120.0)));
    const double stored = u < 1e-2 ? series : std::expm1(u) - u;
    EXPECT_NEAR(layer.ref.evaluate({x, 0.0, 0.1}).potential, stored, 1e-10 * stored) << x;
  }
}

TEST(FormulaLaws, KnowWhereTheyHaveKinks) {
  const Contact stops(Texts{{"force", "1e6 N/m*delta + 4e6 N/m*max(0, delta - 3 um)"}});
  ASSERT_EQ(stops.ref.switches(), 1);
  double before = 0.0, after = 0.0;
  stops.ref.decide({2.9e-6, 0.1, 0.1}, {&before, 1});
  stops.ref.decide({3.1e-6, 0.1, 0.1}, {&after, 1});
  EXPECT_LT(before * after, 0.0);
  EXPECT_NEAR(std::abs(before), 1e-7, 1e-12);
  const Friction ramp(Texts{{"coefficient", "0.2*max(-1, min(1, vt/(1 mm/s)))"}});
  EXPECT_EQ(ramp.ref.switches(), 2);
}

TEST(FormulaLaws, AreRefusedWhereTheyMakeNoSense) {
  const auto refused = [](const auto& law) { return law.fault.path + " " + law.fault.id; };
  EXPECT_EQ(refused(Friction(Texts{{"coefficient", "0.2"}})), "coefficient out-of-range");
  EXPECT_EQ(refused(Friction(Texts{{"coefficient", "0.2*sign(vt)"}})), "coefficient out-of-range");
  EXPECT_EQ(refused(Contact(Texts{{"force", "1e6 N/m*delta*(v0/(1 m/s))^0.2"}})), " missing-key");
  EXPECT_EQ(refused(Contact(Texts{{"force", "1e6 N/m*delta"}, {"energy", "4e5 N/m*delta^2"}})),
            "energy conflicting-keys");
  EXPECT_EQ(refused(Contact(Texts{{"force", "1e6 N/m*delta"}, {"energy", "1e-9 J*log(delta/(1 um))"}})),
            "energy bad-expression");
  EXPECT_EQ(refused(Contact(Texts{{"force", "1e6 N/m*delta"}, {"energy", "5e5 N/m*delta^2"}})), " ");
  EXPECT_EQ(refused(Contact(Texts{{"force", "1e6 N/m*delta*(v0/(1 m/s))^0.2"}, {"energy", "3e5 N/m*delta^2"}})), " ");
}

TEST(FormulaLaws, SayWhereTheyHaveNoValue) {
  const Contact law(Texts{{"force", "1e3 N*sqrt((20 um - delta)/(1 m))"}});
  try {
    law.ref.evaluate({3e-5, 0.0, 0.1});
    ADD_FAILURE() << "it has a value";
  } catch (const BadParameter& e) {
    EXPECT_STREQ(e.id(), "bad-expression");
    EXPECT_STREQ(e.what(), "model.yaml:3:16: square root of a negative number");
  }
}

}  // namespace
}  // namespace freeplay::test::formula_laws
