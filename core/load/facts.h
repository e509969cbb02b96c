// Facts: what is said of a model that was assembled.
#pragma once

#include <string>

#include "assembly/assembly.h"
#include "base/json_text.h"
#include "model/model.h"

namespace freeplay {

/// The block of lines below the file's name.
std::string facts_text(const Model& model, const ModelFacts& facts);
/// Further lines: bodies that are left free beside the drivers, joints whose forces are not determined.
std::string structure_text(const Structure& structure);

Json facts_json(const Model& model, const ModelFacts& facts, const Structure& structure = {});

/// A line for each start value of the file that the start does not have, and for each joint speed that only least
/// kinetic energy decides; start_changes_json() has all of them.
std::string moved_text(const Model& model, const StartReport& report);
/// The same for the table of a run, after what moves in a mechanism whose drivers rest, where no doubt says so.
std::string start_text(const Model& model, const Start& start);

/// Assembled centres of mass [m] and angles [rad], or quaternions, by body.
Json start_json(const Model& model, const Start& start);

/// `moved`: how far what the file gives of bodies' poses and velocities was moved; `chosen`: speeds of joints [rad/s,
/// m/s] that only least kinetic energy decides.
Json start_changes_json(const Model& model, const StartReport& report);

}  // namespace freeplay
