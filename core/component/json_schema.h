// JSON Schema (2020-12) of the model file, of study files and of summary.json, for completion and checking in editors.
// It says keys and shapes; dimensions, names and ranges are for `freeplay validate`.
#pragma once

#include <string>
#include <vector>

#include "base/json_text.h"
#include "component/registry.h"

namespace freeplay {

/// Made from the format table and the parameter tables of the registry's types. `force_types`: joint types that may
/// stand under `forces`. Beside the standard words a key may carry "x-unit", its SI unit.
Json model_schema(const Registry& registry, const std::vector<std::string>& force_types);

/// Of a file that has a study alone, from the schema of the model file.
Json study_schema(const Json& model);

Json summary_schema();

}  // namespace freeplay
