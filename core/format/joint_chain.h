// JointChain: the two joints and the body that stand for a joint with play, where its type says so.
#pragma once

#include "format/draft.h"
#include "format/parameter_check.h"

namespace freeplay {

/// Makes the joint `index`, of a type with a chain, the first of its two, and adds the body and the second.
/// `coordinate`: which of them its name means, 1 or 2; 0: none. False after a report.
bool make_chain(Draft& draft, const Component& type, const CheckedParameters& parameters, int coordinate,
                const CheckedValue& entry, std::size_t index);

}  // namespace freeplay
