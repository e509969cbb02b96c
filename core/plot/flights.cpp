#include "plot/flights.h"

#include <algorithm>

namespace freeplay::plot {

// Before its first event a joint was in the other state than after it.
Flights::Flights(ResultReader& reader, double from, double until, double shortest) : layout_(reader.layout()) {
  const std::size_t width = layout_.events.size();
  const auto end = [&](Joint& joint, double time) {
    const double begin = std::max(joint.free_since, from), over = std::min(time, until);
    if (joint.free && over - begin >= shortest) joint.spans.emplace_back(begin, over);
    joint.free = false;
  };
  if (width == 0) return;
  reader.events([&](std::span<const double> block) {
    for (; !block.empty(); block = block.subspan(width)) {
      const std::string& kind = layout_.kinds[static_cast<std::size_t>(block[2])];
      const bool begins = kind.ends_with("contact_begin");
      if (!begins && !kind.ends_with("contact_end")) continue;
      const auto index = static_cast<std::size_t>(block[1]);
      if (index >= joints_.size()) joints_.resize(index + 1);
      Joint& joint = joints_[index];
      if (!joint.seen && begins) joint.free = true, joint.free_since = from;
      joint.seen = true;
      if (begins) {
        end(joint, block[0]);
      } else {
        joint.free = true;
        joint.free_since = block[0];
      }
    }
  });
  for (Joint& joint : joints_) end(joint, until);
}

std::vector<std::pair<double, double>> Flights::of_channel(const std::string& channel) const {
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    if (channel.starts_with("joint." + layout_.joints[j] + ".")) return joints_[j].spans;
  }
  return {};
}

}  // namespace freeplay::plot
