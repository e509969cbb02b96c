// ChannelChoice: columns of a result by their names.
#pragma once

#include <string>
#include <vector>

#include "results/reader.h"

namespace freeplay {

/// Columns that fit the patterns, in the order of these, each once; those of one pattern in the order of the file.
/// Throws Error{usage} "unknown-channel" with a suggestion where a pattern fits none.
std::vector<std::size_t> chosen_channels(const ResultReader& reader, const std::vector<std::string>& patterns);

/// What to try instead of a pattern that no channel fits: the nearest name, or what the names begin with.
std::string channel_hint(const std::string& pattern, const std::vector<std::string>& names);

}  // namespace freeplay
