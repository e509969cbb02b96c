// ProfileTable: what `freeplay run --profile` prints.
#pragma once

#include <string>

#include "run/simulation.h"

namespace freeplay {

/// Phases with their time, share and count, then the counts of the run. `text_seconds`: processor time that was spent
/// beside the run on making rows into text.
std::string profile_table(const Profile& profile, const Outcome& outcome, double text_seconds);

}  // namespace freeplay
