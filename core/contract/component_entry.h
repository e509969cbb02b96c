// ComponentEntry: a type as `list` and `describe` show it.
#pragma once

#include <string>
#include <vector>

#include "base/json_text.h"
#include "component/registry.h"

namespace freeplay {

/// joint, contact, friction or integrator.
const char* kind_word(ComponentKind kind);

/// Fields name kind space source summary parameters formula validity references.
Json component_json(const RegisteredComponent& entry, const Registry& registry);

/// The same for what is no component: gears and applied forces (kind force), of the format table.
std::vector<Json> core_entries();

/// Everything that a model file may name as a type.
std::vector<Json> all_entries(const Registry& registry);

// A parameter of an entry in words.
std::string default_text(const Json& parameter);  ///< "required"; "-" where it may be absent
std::string range_text(const Json& parameter);    ///< "0 to 1", "> 0", "one of a, b"; "-" without a limit

}  // namespace freeplay
