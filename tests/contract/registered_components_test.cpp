// Every registered component keeps the contract of its kind.
#include <algorithm>
#include <string_view>

#include <gtest/gtest.h>

#include "allocation_counter.h"
#include "base/address_sanitizer.h"
#include "component/registry.h"
#include "contract/component_contract.h"
#include "contract/rules.h"
#include "type_name.h"

namespace freeplay::test {
namespace {

const Registry& registry() {
  static const Registry all = Registry::with_builtins();
  return all;
}

class ComponentContract : public testing::TestWithParam<const Component*> {};

TEST_P(ComponentContract, Holds) {
  // Which law presses makes other numbers, but touches no other memory.
  const Findings findings =
      check_component(*GetParam(), registry(),
                      {.seed = 20, .allocations = &allocations, .other_laws = FREEPLAY_ADDRESS_SANITIZER == 0});
  EXPECT_GT(findings.all().size(), 8u) << "hardly a rule was examined";
  for (const Finding& finding : findings.all()) {
    EXPECT_TRUE(finding.held) << finding.rule << ": " << finding.detail;
    EXPECT_FALSE(rule_meaning(GetParam()->kind, finding.rule).empty()) << finding.rule << " is not explained";
  }
}

struct Seeded {
  const char* name;
  std::uint64_t seed;
};
void PrintTo(const Seeded& s, std::ostream* out) { *out << s.name << " with the seed " << s.seed; }
class ComponentContractOfSeed : public testing::TestWithParam<Seeded> {};

// States in which slopes drown in the force, a touch has few steps, or friction is stiff against a light body.
TEST_P(ComponentContractOfSeed, Holds) {
  const auto& all = registry().components();
  const auto found = std::ranges::find_if(all, [](const RegisteredComponent& entry) {
    return entry.component->kind == ComponentKind::joint &&
           std::string_view(entry.component->description.name) == GetParam().name;
  });
  ASSERT_NE(found, all.end());
  const Findings findings =
      check_component(*found->component, registry(), {.seed = GetParam().seed, .allocations = &allocations});
  for (const Finding& finding : findings.all()) EXPECT_TRUE(finding.held) << finding.rule << ": " << finding.detail;
}

INSTANTIATE_TEST_SUITE_P(Long, ComponentContractOfSeed,
                         testing::Values(Seeded{"prismatic-clearance", 3}, Seeded{"point-on-line-clearance", 4},
                                         Seeded{"point-on-line-clearance", 8}));

std::vector<const Component*> of_kind(ComponentKind kind) {
  std::vector<const Component*> found;
  for (const RegisteredComponent& entry : registry().components()) {
    if (entry.component->kind == kind) found.push_back(entry.component);
  }
  return found;
}

INSTANTIATE_TEST_SUITE_P(Joint, ComponentContract, testing::ValuesIn(of_kind(ComponentKind::joint)), type_name);
INSTANTIATE_TEST_SUITE_P(ContactLaw, ComponentContract, testing::ValuesIn(of_kind(ComponentKind::contact_law)),
                         type_name);
INSTANTIATE_TEST_SUITE_P(FrictionLaw, ComponentContract, testing::ValuesIn(of_kind(ComponentKind::friction_law)),
                         type_name);
INSTANTIATE_TEST_SUITE_P(Integrator, ComponentContract, testing::ValuesIn(of_kind(ComponentKind::integrator)),
                         type_name);

}  // namespace
}  // namespace freeplay::test
