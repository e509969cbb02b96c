#include "run/body_groups.h"

#include <algorithm>
#include <numeric>

namespace freeplay {

BodyGroups::BodyGroups(const Model& model) : model_(model), of_(model.bodies.size()) {
  std::iota(of_.begin(), of_.end(), 0);
  for (const JointElement& joint : model.joints) {
    if (joint.gear < 0) unite(body(joint.marker_a), body(joint.marker_b));
  }
  for (const Gear& gear : model.gears) unite(moved(gear.first), moved(gear.second));
}

BodyId BodyGroups::body(int marker) const { return model_.markers[at(marker)].body; }

BodyId BodyGroups::moved(int joint) const {
  const JointElement& element = model_.joints[at(joint)];
  if (element.gear >= 0) return moved(model_.gears[at(element.gear)].first);
  return body(element.marker_b) == ground ? body(element.marker_a) : body(element.marker_b);
}

void BodyGroups::unite(BodyId a, BodyId b) {
  if (a == ground || b == ground) return;
  std::ranges::replace(of_, int{of_[at(b)]}, int{of_[at(a)]});
}

}  // namespace freeplay
