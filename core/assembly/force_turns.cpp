#include "assembly/force_turns.h"

#include <cmath>
#include <numbers>

#include "base/index.h"

namespace freeplay {

double start_angle(const Model& model, std::span<const double> coordinate, int element) {
  const JointElement& force = model.joints[at(element)];
  const double own = coordinate[at(element)];
  const auto body = [&](int marker) { return model.markers[at(marker)].body; };
  const auto turned = [&](const JointElement& one) {
    return model.markers[at(one.marker_b)].angle - model.markers[at(one.marker_a)].angle;
  };
  for (std::size_t j = 0; force.is_force && j < model.joints.size(); ++j) {
    const JointElement& joint = model.joints[j];
    if (joint.is_force || joint.gear >= 0 || joint.layout.coordinate != Coordinate::angle) continue;
    const bool same = body(joint.marker_a) == body(force.marker_a) && body(joint.marker_b) == body(force.marker_b);
    const bool opposite = body(joint.marker_a) == body(force.marker_b) && body(joint.marker_b) == body(force.marker_a);
    if (!same && !opposite) continue;
    const double angle = coordinate[j] - turned(joint), near = (same ? angle : -angle) + turned(force);
    return own + 2.0 * std::numbers::pi * std::round((near - own) / (2.0 * std::numbers::pi));
  }
  return own;
}

}  // namespace freeplay
