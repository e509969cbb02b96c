#include "run/body_groups.h"

#include "base/disjoint_sets.h"

namespace freeplay {

BodyGroups::BodyGroups(const Model& model) : model_(model), of_(model.bodies.size()) {
  DisjointSets groups(static_cast<int>(of_.size()));
  const auto unite = [&](BodyId a, BodyId b) {
    if (a != ground && b != ground) groups.unite(a, b);
  };
  for (const JointElement& joint : model.joints) {
    if (joint.gear < 0) unite(body(joint.marker_a), body(joint.marker_b));
  }
  for (const Gear& gear : model.gears) unite(moved(gear.first), moved(gear.second));
  for (std::size_t b = 0; b < of_.size(); ++b) of_[b] = groups.root(static_cast<int>(b));
}

BodyId BodyGroups::body(int marker) const { return model_.markers[at(marker)].body; }

BodyId BodyGroups::moved(int joint) const {
  const JointElement& element = model_.joints[at(joint)];
  if (element.gear >= 0) return moved(model_.gears[at(element.gear)].first);
  return body(element.marker_b) == ground ? body(element.marker_a) : body(element.marker_b);
}

}  // namespace freeplay
