// Declared: whether what a joint or an integrator declares can be used.
#pragma once

#include <string>

#include "freeplay/integrator.h"
#include "freeplay/joint.h"

namespace freeplay {

/// What is wrong with a declaration, for a message: sizes that are negative or beyond any use, rows that the space does
/// not have, names that are missing. Empty when nothing is.
std::string declaration_fault(const JointLayout& layout);
std::string declaration_fault(const IntegratorLayout& layout);

}  // namespace freeplay
