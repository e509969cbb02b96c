// The contract of components: every suite that concerns one row of a plugin's table.
#pragma once

#include "component/registry.h"
#include "contract/conditions.h"
#include "contract/finding.h"

namespace freeplay {

/// Judges the description, makes objects from sample parameters and judges each of them. A component that accepts none
/// of the samples breaks the rule "accepts-parameters". The registry holds the component and the laws that it may ask
/// for.
Findings check_component(const Component& component, const Registry& registry, const Conditions& conditions);

}  // namespace freeplay
