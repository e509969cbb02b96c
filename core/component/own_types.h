// OwnTypes: whether a component and its laws come with the program, so that no plugin is to blame for what they say.
#pragma once

#include <algorithm>

#include "component/instances.h"
#include "component/parameter_block.h"

namespace freeplay {

/// Whether neither `component` nor one of the laws that `parameters` (may be null) hold comes from a plugin.
inline bool is_built_in(const Instances& instances, const Component& component, const ParameterBlock* parameters) {
  for (const RegisteredLibrary& library : instances.libraries()) {
    if (library.path == "built-in") continue;
    const auto& components = library.table->components();
    if (std::ranges::any_of(components, [&](const Component& row) { return &row == &component; })) return false;
  }
  if (parameters == nullptr) return true;
  return std::ranges::all_of(parameters->values, [&](const auto& entry) {
    const ParameterBlock* law = entry.second.law.get();
    return law == nullptr || is_built_in(instances, *law->component, law);
  });
}

}  // namespace freeplay
