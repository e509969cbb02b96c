// A gear whose teeth have play: the type that runs in its place, between the two wheels.
#pragma once

#include "format/parameter_check.h"

namespace freeplay {

struct Draft;

/// The type that a gear with a block of this entry is; null without such a block, or after an error where it does not
/// work in this model.
const Component* loose_gear(const Draft& draft, const MapReader& map);

/// Makes the joint of `gear` that type, unless it is to be ideal. Reports what keeps its wheels from meeting.
void loosen(Draft& draft, const Gear& gear, const CheckedParameters& parameters, const CheckedValue& entry);

}  // namespace freeplay
