// InputDoubts: what was said of a model before it ran, as its result repeats it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "run/trust.h"

namespace freeplay {

/// The messages of a model that runs as sentences with their ids, and after them those of the run.
std::vector<std::string> warnings_of(const Diagnostics& diagnostics, std::span<const std::string> more);

/// What the model is doubted for.
void doubt_input(const Diagnostics& diagnostics, Verdict& verdict);

}  // namespace freeplay
