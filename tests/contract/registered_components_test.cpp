// Every registered component keeps the contract of its kind.
#include <gtest/gtest.h>

#include "allocation_counter.h"
#include "component/registry.h"
#include "contract/component_contract.h"
#include "contract/rules.h"

namespace freeplay::test {
namespace {

const Registry& registry() {
  static const Registry all = Registry::with_builtins();
  return all;
}

class ComponentContract : public testing::TestWithParam<const Component*> {};

TEST_P(ComponentContract, Holds) {
  const Findings findings = check_component(*GetParam(), registry(), {.seed = 20, .allocations = &allocations});
  EXPECT_GT(findings.all().size(), 8u) << "hardly a rule was examined";
  for (const Finding& finding : findings.all()) {
    EXPECT_TRUE(finding.held) << finding.rule << ": " << finding.detail;
    EXPECT_FALSE(rule_meaning(GetParam()->kind, finding.rule).empty()) << finding.rule << " is not explained";
  }
}

std::vector<const Component*> of_kind(ComponentKind kind) {
  std::vector<const Component*> found;
  for (const RegisteredComponent& entry : registry().components()) {
    if (entry.component->kind == kind) found.push_back(entry.component);
  }
  return found;
}

std::string test_name(const testing::TestParamInfo<const Component*>& info) {
  std::string name = info.param->description.name;
  for (char& c : name) {
    if (c == '-') c = '_';
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(Joint, ComponentContract, testing::ValuesIn(of_kind(ComponentKind::joint)), test_name);
INSTANTIATE_TEST_SUITE_P(ContactLaw, ComponentContract, testing::ValuesIn(of_kind(ComponentKind::contact_law)),
                         test_name);
INSTANTIATE_TEST_SUITE_P(FrictionLaw, ComponentContract, testing::ValuesIn(of_kind(ComponentKind::friction_law)),
                         test_name);
INSTANTIATE_TEST_SUITE_P(Integrator, ComponentContract, testing::ValuesIn(of_kind(ComponentKind::integrator)),
                         test_name);

}  // namespace
}  // namespace freeplay::test
