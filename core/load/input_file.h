// The file of `freeplay run --inputs`: what efforts that are inputs become during a run.
#pragma once

#include <string>
#include <string_view>

#include "base/diagnostics.h"
#include "model/model.h"
#include "run/input_course.h"

namespace freeplay {

/// Reads a table of `time` [s] and inputs by name [N, N m] as a run of `model` writes it; an input without a column
/// keeps what it begins with. `file` is one of the files that the run is made from then. Mistakes are messages, with
/// which the course is empty. Throws Error{usage} for a model without inputs, Error{input} "file-not-found".
InputCourse read_inputs(const std::string& path, const Model& model, Diagnostics& diagnostics, InputFile& file);

/// The same table as a run writes it.
std::string input_text(const Model& model, const InputCourse& course);

}  // namespace freeplay
