// ParameterWords: the values of a block, for messages.
#pragma once

#include <string>

#include "component/parameter_block.h"

namespace freeplay {

/// "gap = 0.01 m, contact = my-law (K = 3.16e+09)": what was given and what has a default, in the order of the table,
/// SI.
std::string words_of(const ParameterBlock& block);

}  // namespace freeplay
