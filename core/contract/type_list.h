// TypeList: what types there are, and what each is.
#pragma once

#include <string>

#include "base/json_text.h"
#include "component/registry.h"

namespace freeplay {

/// Throws Error{usage} "unknown-name" unless it is empty or joints, laws, forces, integrators, plugins or channels.
void require_listed(const std::string& kind);

/// Entries of the types of a kind (but channels), or of all and of the plugins where it is empty.
Json type_entries(const Registry& registry, const std::string& kind);

/// All types of this name, which is unique within a kind only, with their channels. Throws Error{usage} "unknown-name".
Json described_types(const Registry& registry, const std::string& name);

}  // namespace freeplay
