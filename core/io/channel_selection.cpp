#include "io/channel_selection.h"

#include <algorithm>

#include "model/name_rule.h"

namespace freeplay {

bool matches_channel(std::string_view pattern, const Channels& channels) {
  return std::ranges::any_of(channels.all(),
                             [&](const ChannelInfo& channel) { return matches(pattern, channel.name); });
}

std::vector<std::size_t> select_channels(const Channels& channels, std::span<const std::string> patterns) {
  std::vector<std::size_t> selected;
  for (std::size_t i = 0; i < channels.all().size(); ++i) {
    const auto wanted = [&](const std::string& pattern) { return matches(pattern, channels.all()[i].name); };
    if (static_cast<int>(i) == channels.time || std::ranges::any_of(patterns, wanted)) selected.push_back(i);
  }
  return selected;
}

}  // namespace freeplay
