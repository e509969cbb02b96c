// Values of axes are tried on the models before anything runs.
#pragma once

#include "load/options.h"
#include "study/file.h"

namespace freeplay {

/// Reports, at the axis, values whose name or dimension no model takes: each kind of value of an axis is tried in a
/// model with `set`. That a number is out of range is a fact of its point. The models get the files that values name.
void check_values(StudyFile& study, const LoadOptions& options);

}  // namespace freeplay
