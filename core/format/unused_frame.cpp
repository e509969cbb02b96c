#include "format/unused_frame.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <unordered_map>
#include <vector>

#include <fmt/format.h>

#include "format/doubtful_body.h"
#include "model/force_element.h"

namespace freeplay {
namespace {

/// By body the names of two joints that hold it at one and the same marker. More of them are meant there, as the
/// pistons of one swash plate.
std::unordered_map<BodyId, std::string> shared_holds(const Draft& draft) {
  std::unordered_map<BodyId, std::string> shared;
  std::unordered_map<int, std::vector<const JointElement*>> holds;  // by marker
  for (const JointElement& joint : draft.model.joints) {
    if (joint.gear >= 0 || is_force_element(joint)) continue;
    for (const int index : {joint.marker_a, joint.marker_b}) holds[index].push_back(&joint);
  }
  for (const JointElement& joint : draft.model.joints) {
    for (const int index : {joint.marker_a, joint.marker_b}) {
      const Marker& marker = draft.model.markers[static_cast<std::size_t>(index)];
      const auto found = holds.find(index);
      if (marker.body == ground || found == holds.end()) continue;
      const std::vector<const JointElement*>& joints = found->second;
      if (joints.size() != 2 || joints.back() != &joint) continue;
      shared.emplace(marker.body, fmt::format("; '{}' and '{}' both hold '{}': is one of them meant here?",
                                              joints.front()->name, joint.name, marker.name));
    }
  }
  return shared;
}

// A planar link all of whose joints are pins at one and the same place, away from its centre of mass: it turns there
// and moves nothing. What gears or forces take hold of may be meant to.
void warn_of_idle_links(const Draft& draft) {
  const Model& model = draft.model;
  if (model.space != Space::planar) return;
  struct Link {
    std::vector<const JointElement*> pins;
    int marker = -1;
    bool idle = true;
  };
  std::vector<Link> links(model.bodies.size());
  const auto at = [&](int marker) -> const Marker& { return model.markers[static_cast<std::size_t>(marker)]; };
  for (const JointElement& joint : model.joints) {
    for (const int index : {joint.marker_a, joint.marker_b}) {
      if (at(index).body == ground) continue;
      Link& link = links[static_cast<std::size_t>(at(index).body)];
      const bool pin =
          joint.gear < 0 && !is_force_element(joint) && joint.ideal_layout().coordinate == Coordinate::angle;
      link.idle = link.idle && pin && (link.marker < 0 || link.marker == index);
      link.marker = index;
      link.pins.push_back(&joint);
    }
  }
  for (const AppliedForce& force : model.forces) {
    if (at(force.marker).body != ground) links[static_cast<std::size_t>(at(force.marker).body)].idle = false;
  }
  for (const Gear& gear : model.gears) {
    for (const int joint : {gear.first, gear.second}) {
      for (const int index : {model.joints[static_cast<std::size_t>(joint)].marker_a,
                              model.joints[static_cast<std::size_t>(joint)].marker_b}) {
        if (at(index).body != ground) links[static_cast<std::size_t>(at(index).body)].idle = false;
      }
    }
  }
  std::set<const Node*> doubted;
  for (std::size_t b = 0; b < links.size(); ++b) {
    const Link& link = links[b];
    if (!link.idle || link.pins.size() < 2) continue;
    const Vector3 &com = model.bodies[b].com, &place = at(link.marker).position;
    if (std::hypot(com[0] - place[0], com[1] - place[1]) < 1e-9) continue;
    const auto entry = entry_of(draft, "joints", link.pins[1]->name);
    if (!entry || entry->key_node()->foreign || !doubted.insert(&entry->node()).second) continue;
    entry->warn_at_key("same-frame",
                       fmt::format("joints '{}' and '{}' hold '{}' at one place, '{}', so that its turning "
                                   "moves nothing: is one of them meant at another frame",
                                   link.pins[0]->name, link.pins[1]->name, model.bodies[b].name, at(link.marker).name));
  }
}

}  // namespace

void warn_unused_frames(const Draft& draft) {
  warn_of_idle_links(draft);
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
