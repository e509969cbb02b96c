// The damping of an element of force, where it acts as one.
#pragma once

#include <string_view>

#include "model/model.h"

namespace freeplay {

/// The force that the file gives for a speed, [N s/m] or [N m s/rad]; 0 where it gives none, and where the parameter of
/// this name is another quantity, as the part by which the force of a stop grows: one whose default belongs to another
/// form of the same type does not act.
inline double given_damping(const JointElement& element) {
  constexpr std::string_view name = "damping";
  const auto found = element.parameters->values.find(name);
  if (found == element.parameters->values.end() || !found->second.given) return 0.0;
  for (const Parameter& parameter : element.parameters->component->description.parameters) {
    if (parameter.name == name && std::string_view(parameter.unit).find('N') != std::string_view::npos)
      return found->second.number;
  }
  return 0.0;
}

}  // namespace freeplay
