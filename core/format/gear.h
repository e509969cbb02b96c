// Gear: an element of the core that ties the coordinates of two joints together.
#pragma once

#include "format/draft.h"

namespace freeplay {

inline constexpr const char* gear_word = "gear";

/// Makes `element` a gear whose row the core writes itself. What it couples is read by add_gears().
void make_gear(JointElement& element);

/// Reads the gears of a part; the joints of all parts are known.
void add_gears(Draft& draft, const Part& part);

}  // namespace freeplay
