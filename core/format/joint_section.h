// The section `joints`.
#pragma once

#include "format/draft.h"

namespace freeplay {

/// Adds the joints of a part; all frames are known. A joint with play is created together with its ideal twin.
void add_joints(Draft& draft, const Part& part);

/// Reads an entry of `forces` whose type is no force of the core: a joint without constraint rows is one, too.
void add_force_joint(Draft& draft, const Part& part, const CheckedValue& entry);

/// Throws Error{usage} when an `--ideal` pattern matched no joint with play. Call after the joints of all parts, and
/// only if nothing was wrong with them.
void require_ideal_matches(const Draft& draft);

}  // namespace freeplay
