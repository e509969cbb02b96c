// A number of an element of force, given or by default.
#pragma once

#include <limits>
#include <string_view>

#include "model/model.h"

namespace freeplay {

/// Of an element that has parameters, in SI units; NaN where its type has none of this name.
inline double element_number(const JointElement& element, std::string_view name) {
  const auto found = element.parameters->values.find(name);
  return found == element.parameters->values.end() ? std::numeric_limits<double>::quiet_NaN() : found->second.number;
}

}  // namespace freeplay
