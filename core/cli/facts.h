// Facts: what `freeplay validate` tells about a model.
#pragma once

#include <string>

#include "io/json_text.h"
#include "model/model.h"
#include "run/assembly.h"

namespace freeplay {

/// The block of lines below the file's name.
std::string facts_text(const Model& model, const ModelFacts& facts);
/// Further lines: bodies that are left free beside the drivers, joints whose forces are not determined.
std::string structure_text(const Structure& structure);

Json facts_json(const Model& model, const ModelFacts& facts, const Structure& structure = {});

/// A line for each start value of the file that the start does not have, and for each joint speed that only least
/// kinetic energy decides; the JSON of start_json() has all of them.
std::string moved_text(const Model& model, const StartReport& report);

/// Assembled centres of mass by body; under `moved` how far what the file gives of a body's pose and velocity was
/// moved, under
/// `chosen` speeds of joints whose second body it is that only least kinetic energy decides.
Json start_json(const Model& model, const Start& start);

}  // namespace freeplay
