// ModelJson: the expanded model as JSON.
#pragma once

#include "io/json_text.h"
#include "model/model.h"

namespace freeplay {

/// The model after parameters, presets, templates and URDF are expanded: full names, SI units, vectors of the plane as
/// two numbers. Functions of time are their texts. Keys are those of the model file.
Json model_json(const Model& model);

/// The parameters of a component, nested as in the model file; null for what may be absent and is.
Json parameters_json(const ParameterBlock& block);

/// "angle", "position" and so on.
const char* driver_kind_word(DriverKind kind);

}  // namespace freeplay
