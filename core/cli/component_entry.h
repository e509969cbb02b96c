// ComponentEntry: a type as `list` and `describe` show it.
#pragma once

#include <string>

#include "component/registry.h"
#include "io/json_text.h"

namespace freeplay {

/// joint, contact, friction or integrator.
const char* kind_word(ComponentKind kind);

/// planar, spatial or both.
const char* space_word(Space space);

/// One parameter in words.
struct ParameterText {
  std::string default_value;  ///< "required", "-" where it may be absent
  std::string range;          ///< "0 to 1", "> 0", "one of a, b"; "-" without a limit
};
ParameterText parameter_text(const Parameter& parameter, const Registry& registry);

/// Fields name kind space source summary parameters formula validity references.
Json component_json(const RegisteredComponent& entry);

}  // namespace freeplay
