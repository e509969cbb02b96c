// The section `joints`.
#pragma once

#include "format/draft.h"
#include "format/parameter_check.h"

namespace freeplay {

/// Adds the joints of a part; all frames are known. A joint with play is created together with its ideal twin.
void add_joints(Draft& draft, const Part& part);

/// Reads an entry of `forces` whose type is no force of the core: a joint without constraint rows is one, too.
void add_force_joint(Draft& draft, const Part& part, const CheckedValue& entry);

/// Does a type for these spaces work in a model of this one?
bool serves(Space space, Space model_space);
/// Was the joint of this name asked for without play?
bool is_made_ideal(Draft& draft, const std::string& name);
/// What to write where a joint of the type has no coordinate; empty where it cannot have one.
std::string coordinate_hint(const Component& type);
/// The joint of these parameters and what it declares; false after a mistake in them. Throws Error{plugin}.
bool make_joint(Draft& draft, const CheckedParameters& parameters, const CheckedValue& entry, JointRef& joint,
                JointLayout& layout);

/// Throws Error{usage} when an `--ideal` pattern matched no joint with play. Call after the joints of all parts, and
/// only if nothing was wrong with them.
void require_ideal_matches(const Draft& draft);

}  // namespace freeplay
