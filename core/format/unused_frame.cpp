#include "format/unused_frame.h"

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
  // Instances of a template share a declaration: it is reported once, of the first of them.
  struct Declared {
    bool used = false;
    const std::string* name = nullptr;
    const Draft::Frame* frame = nullptr;
  };
  const auto before = [](const std::string& a, const std::string& b) {
    return a.size() != b.size() ? a.size() < b.size() : a < b;
  };
  std::unordered_map<const Node*, Declared> declared;
  for (const auto& [name, frame] : draft.frames) {
    if (frame.key == nullptr || frame.key->foreign) continue;
    Declared& one = declared[frame.key];
    one.used = one.used || draft.markers.contains(name);
    if (one.name != nullptr && before(*one.name, name)) continue;
    one.name = &name;
    one.frame = &frame;
  }
  if (std::ranges::all_of(declared, [](const auto& one) { return one.second.used; })) return;
  const std::unordered_map<BodyId, std::string> holds = shared_holds(draft);
  for (const auto& [key, one] : declared) {
    if (one.used) continue;
    const auto hold = holds.find(one.frame->body);
    CheckedValue(*one.frame->reading, *one.frame->value, key, key->text)
        .warn_at_key("unused",
                     fmt::format("frame '{}' is not used{}", key->text, hold == holds.end() ? "" : hold->second));
  }
}

}  // namespace freeplay
