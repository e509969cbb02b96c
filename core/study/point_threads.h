// run_in_threads: points of a study in threads of this process, with their outcomes in memory.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "load/options.h"
#include "study/point.h"
#include "study/point_runner.h"
#include "workers/outcome.h"

namespace freeplay {

/// Points that one thread runs in order; of a chain, each begins where the one before it has ended.
using PointUnit = std::vector<StudyPoint>;

/// By index of the point, from 0 on to `points`; empty where it has not come to its end. `beat` is called in the
/// caller's thread, at least every 0.1 s, with the number of points done; where it returns false every run ends after
/// its step, and no other begins. Throws Error as PointRunner does for what is wrong with the whole.
std::vector<std::optional<StudyOutcome>> run_in_threads(const PointSource& source, const LoadOptions& options,
                                                        const std::vector<PointUnit>& units, std::size_t points,
                                                        int workers, const std::function<bool(std::size_t)>& beat);

}  // namespace freeplay
