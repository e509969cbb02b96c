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

/// Assembled centres of mass by body.
Json start_json(const Model& model, const Start& start);

}  // namespace freeplay
