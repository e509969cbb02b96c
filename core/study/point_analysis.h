// PointAnalysis: points of a study that are analyses.
#pragma once

#include "analysis/request_words.h"
#include "analysis/table.h"
#include "format/checked_value.h"

namespace freeplay {

/// The map of `do`; reports what it does not know. Lists are what an option of `analyze` is when it is repeated, but a
/// list of numbers is one pose; maps are NAME=VALUE.
AnalysisWords read_analysis_words(const CheckedValue& section);

/// The table of a model. Throws what `analyze` does. May add a marker to the model.
AnalysisTable analysis_of(Model& model, const AnalysisWords& words);

}  // namespace freeplay
