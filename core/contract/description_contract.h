// The contract of descriptions: the table row that a component is published with.
#pragma once

#include "contract/finding.h"
#include "freeplay/plugin.h"

namespace freeplay {

/// All rules for one row:
///
///   name                    lower-case words joined by hyphens
///   space                   of a joint: planar, spatial or both
///   summary                 says something, as do those of the parameters
///   parameter-names         words joined by underscores, paths joined by dots; no two alike, none that the model
///                           file reads itself
///   parameter-bounds        a minimum below the maximum
///   parameter-defaults      within the bounds; of a choice the index of a word
///   parameter-choices       every choice has words, no two alike
///   parameter-units         are units of the model format; exponents name other numbers of the table
Findings check_description(const Component& component);

/// Names of events and channels are words, units are units, no two of one joint are alike, and no channel has the name
/// of a column that joints of this layout have anyway, such as fx.
Findings check_joint_names(const JointLayout& joint);

}  // namespace freeplay
