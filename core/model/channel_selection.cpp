#include "model/channel_selection.h"

#include <algorithm>
#include <string_view>
#include <unordered_set>

#include "base/name_pattern.h"

namespace freeplay {

bool matches_channel(std::string_view pattern, const Channels& channels) {
  return std::ranges::any_of(channels.all(),
                             [&](const ChannelInfo& channel) { return matches(pattern, channel.name); });
}

std::vector<std::size_t> select_channels(const Channels& channels, std::span<const std::string> patterns) {
  // Names are looked up, only what has a star is compared with each channel.
  std::unordered_set<std::string_view> names;
  std::vector<std::string_view> stars;
  for (const std::string& pattern : patterns) {
    if (is_pattern(pattern)) {
      stars.push_back(pattern);
    } else {
      names.insert(pattern);
    }
  }
  std::vector<std::size_t> selected;
  for (std::size_t i = 0; i < channels.all().size(); ++i) {
    const std::string& name = channels.all()[i].name;
    const auto fits = [&](std::string_view pattern) { return matches(pattern, name); };
    const bool wanted = names.contains(name) || std::ranges::any_of(stars, fits);
    if (static_cast<int>(i) == channels.time || wanted) selected.push_back(i);
  }
  selected.shrink_to_fit();  // of hundreds of thousands of columns
  return selected;
}

}  // namespace freeplay
