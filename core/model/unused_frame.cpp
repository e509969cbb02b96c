#include "model/unused_frame.h"

#include <algorithm>

#include <fmt/format.h>

namespace freeplay {
namespace {

/// By body the names of two joints that hold it at one and the same marker.
std::unordered_map<BodyId, std::string> shared_holds(const Draft& draft) {
  std::unordered_map<BodyId, std::string> shared;
  std::unordered_map<int, const JointElement*> first;  // by marker
  for (const JointElement& joint : draft.model.joints) {
    if (joint.gear >= 0 || joint.is_force) continue;
    for (const int index : {joint.marker_a, joint.marker_b}) {
      const Marker& marker = draft.model.markers[static_cast<std::size_t>(index)];
      const auto [known, fresh] = first.emplace(index, &joint);
      if (fresh || marker.body == ground) continue;
      shared.emplace(marker.body, fmt::format("; '{}' and '{}' both hold '{}': is one of them meant here?",
                                              known->second->name, joint.name, marker.name));
    }
  }
  return shared;
}

}  // namespace

void warn_unused_frames(const Draft& draft) {
  std::unordered_map<const Node*, bool> used;  // by declaration, which instances of a template share
  for (const auto& [name, frame] : draft.frames) {
    if (frame.key == nullptr || frame.key->foreign) continue;
    bool& any = used[frame.key];
    any = any || draft.markers.contains(name);
  }
  if (std::ranges::all_of(used, [](const auto& one) { return one.second; })) return;
  const std::unordered_map<BodyId, std::string> holds = shared_holds(draft);
  for (const auto& [name, frame] : draft.frames) {
    if (frame.key == nullptr || frame.key->foreign || used[frame.key]) continue;
    const auto hold = holds.find(frame.body);
    CheckedValue(*frame.reading, *frame.value, frame.key, frame.key->text)
        .warn_at_key("unused",
                     fmt::format("frame '{}' is not used{}", frame.key->text, hold == holds.end() ? "" : hold->second));
  }
}

}  // namespace freeplay
