// ChainState: the end of a point as text, from which the next point of its chain begins.
#pragma once

#include <string>
#include <string_view>

#include "assembly/warm_start.h"

namespace freeplay {

/// Hexadecimal digits alone; every bit is kept.
std::string chain_text(const EndedMotion& motion);

/// Throws Error{input} "state-damaged" for what is no such text.
EndedMotion chain_motion(std::string_view text);

}  // namespace freeplay
