// outcome_of: what a row of a segment says, as numbers.
#pragma once

#include "study/segment_reader.h"
#include "workers/outcome.h"

namespace freeplay {

StudyOutcome outcome_of(const SegmentRow& row, const RowLayout& layout);

}  // namespace freeplay
