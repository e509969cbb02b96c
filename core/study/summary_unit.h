// summary_unit: in which unit a figure of a run's summary is.
#pragma once

#include <string>

#include "model/channel.h"

namespace freeplay {

/// `path` as in summary.json, the word after the last dot being the figure; names in it may be patterns. "1" for what
/// has no dimension, is unknown, or differs between what a pattern fits.
std::string summary_unit(const std::string& path, const Model& model, const Channels& channels);

}  // namespace freeplay
