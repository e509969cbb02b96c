// StudyProbe: how long points of a study take.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "study/open_study.h"

namespace freeplay {

/// Processor time: what others do on the machine does not count.
struct PointSeconds {
  double mean = 0.0, min = 0.0, max = 0.0;
  double row_bytes = 0.0;  ///< of a row in a segment, with its samples
};

/// Runs up to `count` points, spread over the study, for at most `longest` seconds; nothing where none ended.
std::optional<PointSeconds> probe_points(OpenStudy& study, std::uint64_t count, double longest);

}  // namespace freeplay
