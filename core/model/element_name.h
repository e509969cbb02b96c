// How messages name an element of the model: by its section of the file, and its name.
#pragma once

#include <string>

#include "model/model.h"

namespace freeplay {

/// "joint", or "force" for an entry of `forces`.
inline const char* section_of(const JointElement& element) { return element.is_force ? "force" : "joint"; }
/// As "joint 'pin'", or "force 'spring'" for an entry of `forces`.
[[gnu::cold]] std::string written_name(const JointElement& element);

}  // namespace freeplay
