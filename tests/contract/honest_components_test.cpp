// Honest components of unusual sizes and kinds break no rule, whatever the seed.
#include "honest_components.h"

#include <gtest/gtest.h>

#include "allocation_counter.h"
#include "contract/component_contract.h"
#include "contract/rules.h"
#include "findings_text.h"
#include "type_name.h"

namespace freeplay::test {
namespace {

const Registry& honest_types() {
  static const Registry all = honest_registry();
  return all;
}

class HonestComponentLong : public testing::TestWithParam<const Component*> {};

TEST_P(HonestComponentLong, BreaksNoRule) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const Findings findings = check_component(*GetParam(), honest_types(), {.seed = seed, .allocations = &allocations});
    EXPECT_GT(findings.all().size(), 8u);
    EXPECT_TRUE(findings.held()) << "seed " << seed << "\n" << broken_rules(findings);
    for (const Finding& finding : findings.all()) {
      EXPECT_FALSE(rule_meaning(GetParam()->kind, finding.rule).empty()) << finding.rule;
    }
  }
}

std::vector<const Component*> honest() {
  std::vector<const Component*> found;
  for (const RegisteredComponent& entry : honest_types().components()) {
    if (entry.library == "honest") found.push_back(entry.component);
  }
  return found;
}

INSTANTIATE_TEST_SUITE_P(Every, HonestComponentLong, testing::ValuesIn(honest()), type_name);

TEST(Rules, OfAnotherKindAreNotExplained) {
  EXPECT_TRUE(rule_meaning(ComponentKind::joint, "monotone").empty());
  EXPECT_TRUE(rule_meaning(ComponentKind::contact_law, "no-such-rule").empty());
}

}  // namespace
}  // namespace freeplay::test
