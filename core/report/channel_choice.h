// ChannelChoice: which channels a page shows, and which go first when there is no room.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "report/reported_run.h"

namespace freeplay {

/// Indices into ReportedRun::columns, without time, the most wanted first: energy, paths and frames, drivers, clearance
/// joints, bodies, other joints; with patterns those that fit one, in their order. Throws Error{usage}
/// "unknown-channel" with a suggestion where a pattern fits none of any run.
std::vector<std::vector<std::size_t>> choose_channels(std::span<const ReportedRun> runs,
                                                      std::span<const std::string> patterns);

}  // namespace freeplay
