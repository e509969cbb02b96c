// Provenance: what a result was made from and with.
#pragma once

#include <string>
#include <vector>

#include "base/json_text.h"
#include "model/model.h"

namespace freeplay {

/// What only the program knows of the making of a result.
struct Making {
  std::string made;                    ///< the command: "run"
  std::string command;                 ///< the command line as typed
  std::vector<std::string> arguments;  ///< what is needed to make it again, without output paths
  std::string build;                   ///< how the program was built
  Json seed = nullptr;                 ///< of what was drawn by chance
};

/// The record without the texts of model and inputs, which are beside it.
Json provenance(const Model& model, const Making& making);

/// The same with these texts, for what stands alone.
Json provenance_with_texts(const Model& model, const Making& making);

}  // namespace freeplay
