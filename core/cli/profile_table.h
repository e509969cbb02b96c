// ProfileTable: what `freeplay run --profile` prints.
#pragma once

#include <string>

#include "run/simulation.h"

namespace freeplay {

/// Of this program so far, of all its threads [s].
double processor_seconds();

/// Phases with their time, share and count, then the counts of the run. `first_step_seconds`: processor time of the
/// program until its first step had ended, 0 where there was none; `text_seconds`: that was spent beside the run on
/// making rows into text.
std::string profile_table(const Profile& profile, const Outcome& outcome, double first_step_seconds,
                          double text_seconds);

}  // namespace freeplay
