// The section `simulation`.
#pragma once

#include "format/draft.h"

namespace freeplay {

/// The start time [s], needed before anything that depends on time is read; 0 when it is not given or in error.
double read_start_time(const CheckedValue& section);

/// Fills the settings; `section` may be missing. All frames are known. The command line wins over the file. False when
/// a frame of the output could not be found.
bool read_simulation(Draft& draft, const std::optional<CheckedValue>& section);

}  // namespace freeplay
