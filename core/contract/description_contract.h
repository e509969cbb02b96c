// The contract of descriptions: the table row that a component is published with.
#pragma once

#include "contract/finding.h"
#include "freeplay/plugin.h"

namespace freeplay {

/// All rules for one row:
///
///   name                    lower-case words joined by hyphens
///   summary                 says something, as do those of the parameters
///   parameter-names         words joined by underscores, paths joined by dots; no two alike
///   parameter-bounds        a minimum below the maximum
///   parameter-defaults      within the bounds; of a choice the index of a word
///   parameter-choices       every choice has words, no two alike
///   parameter-units         are units of the model format; exponents name other numbers of the table
Findings check_description(const Component& component);

/// Names of events and channels are words, units are units, and no two of one joint are alike.
struct JointNames {
  Span<const Event> events;
  Span<const Channel> channels;
};
Findings check_joint_names(const JointNames& names);

}  // namespace freeplay
