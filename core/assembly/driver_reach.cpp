#include "assembly/driver_reach.h"

#include "base/disjoint_sets.h"
#include "base/index.h"

namespace freeplay {
namespace {

class Groups {
 public:
  explicit Groups(const Model& model) : model_(model), sets_(static_cast<int>(model.bodies.size())) {
    for (std::size_t j = 0; j < model.joints.size(); ++j) {
      const JointElement& joint = model.joints[j];
      if (joint.gear < 0) tie(joint.marker_a, joint.marker_b);
      tie_to_channels(joint.by_motion, joint.marker_a), tie_to_channels(joint.by_motion, joint.marker_b);
    }
    for (const Gear& gear : model.gears) {
      const JointElement &first = model.joints[at(gear.first)], &second = model.joints[at(gear.second)];
      for (const int a : {first.marker_a, first.marker_b}) tie(a, second.marker_a), tie(a, second.marker_b);
    }
    for (const AppliedForce& force : model.forces) tie_to_channels(force.by_motion, force.marker);
    for (const Driver& driver : model.drivers) {
      const JointElement& joint = model.joints[at(driver.joint)];
      tie_to_channels(driver.by_motion, joint.marker_a), tie_to_channels(driver.by_motion, joint.marker_b);
    }
  }

  BodyId body_of(int marker) const { return model_.markers[at(marker)].body; }
  int root(int body) { return sets_.root(body); }

 private:
  void tie(int marker, int other) {
    const BodyId a = body_of(marker), b = body_of(other);
    if (a != ground && b != ground) sets_.unite(a, b);
  }
  void tie_to_channels(const MotionFormulas& formulas, int marker) {
    for (const MotionChannel& channel : formulas.channels) {
      if (!channel.is_of_joint()) {
        tie(marker, channel.element);
        continue;
      }
      const JointElement& joint = model_.joints[at(channel.element)];
      tie(marker, joint.marker_a), tie(marker, joint.marker_b);
    }
  }

  const Model& model_;
  DisjointSets sets_;
};

}  // namespace

std::vector<int> tied_groups(const Model& model) {
  Groups groups(model);
  std::vector<int> found(model.bodies.size());
  for (std::size_t b = 0; b < found.size(); ++b) found[b] = groups.root(static_cast<int>(b));
  return found;
}

std::vector<char> reached_by_drivers(const Model& model) {
  const std::vector<int> groups = tied_groups(model);
  std::vector<char> driven(groups.size(), 0), reached(groups.size());
  for (const Driver& driver : model.drivers) {
    const JointElement& joint = model.joints[at(driver.joint)];
    for (const int marker : {joint.marker_a, joint.marker_b}) {
      if (const BodyId body = model.markers[at(marker)].body; body != ground) driven[at(groups[at(body)])] = 1;
    }
  }
  for (std::size_t b = 0; b < reached.size(); ++b) reached[b] = driven[at(groups[b])];
  return reached;
}

}  // namespace freeplay
