// CompleteModel: a document that has taken in a URDF file, as a YAML model that needs none.
#pragma once

#include <string>
#include <vector>

#include "format/document.h"

namespace freeplay {

/// Text of the model. Names that only URDF allows (a digit in front) get a '_' in front, everywhere; they are appended
/// to `renamed`.
std::string complete_model_text(const Document& document, std::vector<std::string>& renamed);

}  // namespace freeplay
