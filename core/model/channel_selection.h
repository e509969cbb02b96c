// ChannelSelection: which columns a result file holds.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "model/channel.h"

namespace freeplay {

/// True if some channel fits the pattern, in which `*` stands for any run of characters.
bool matches_channel(std::string_view pattern, const Channels& channels);

/// Indices of the channels that fit one of the patterns, in the order of the row. `time` is always the first.
std::vector<std::size_t> select_channels(const Channels& channels, std::span<const std::string> patterns);

}  // namespace freeplay
