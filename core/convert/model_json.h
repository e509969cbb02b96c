// ModelJson: the expanded model as JSON.
#pragma once

#include "base/json_text.h"
#include "model/model.h"

namespace freeplay {

/// Quantities of the JSON: SI numbers, or text with the SI unit ("0.3 m", "(0, 1) m/s^2") for people.
enum class Quantities { numbers, text };

/// The model after parameters, presets, templates and URDF are expanded: full names, SI units, vectors of the plane as
/// two numbers. Functions of time are their texts, and so is the unit of a limit that has one. Keys are those of the
/// model file; a driver by inverse kinematics names its entry of `paths`, which has the frame and the path.
Json model_json(const Model& model, Quantities quantities = Quantities::numbers);

/// The parameters of a component, nested as in the model file; null for what may be absent and is.
Json parameters_json(const ParameterBlock& block);

/// "angle", "position" and so on.
const char* driver_kind_word(DriverKind kind);

}  // namespace freeplay
