// point_source: what runs the points of a study file.
#pragma once

#include "study/file.h"
#include "study/point_runner.h"

namespace freeplay {

/// The file outlives it.
PointSource point_source(const StudyFile& file);

}  // namespace freeplay
