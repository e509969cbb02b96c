#include "assembly/force_turns.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/index.h"
#include "model/force_element.h"

namespace freeplay {
namespace {

/// Given by the file for the element itself, as may be where it stands under `joints`.
bool has_own_start(const Model& model, int element) {
  return model.joints[at(element)].start_coordinate ||
         std::ranges::any_of(model.drivers, [&](const Driver& driver) { return driver.joint == element; });
}

}  // namespace

double start_angle(const Model& model, std::span<const double> coordinate, int element) {
  const JointElement& force = model.joints[at(element)];
  const double own = coordinate[at(element)];
  const auto body = [&](int marker) { return model.markers[at(marker)].body; };
  const auto turned = [&](const JointElement& one) {
    return model.markers[at(one.marker_b)].angle - model.markers[at(one.marker_a)].angle;
  };
  const bool follows = is_force_element(force) && !has_own_start(model, element);
  for (std::size_t j = 0; follows && j < model.joints.size(); ++j) {
    const JointElement& joint = model.joints[j];
    if (is_force_element(joint) || joint.gear >= 0 || joint.layout.coordinate != Coordinate::angle) continue;
    const bool same = body(joint.marker_a) == body(force.marker_a) && body(joint.marker_b) == body(force.marker_b);
    const bool opposite = body(joint.marker_a) == body(force.marker_b) && body(joint.marker_b) == body(force.marker_a);
    if (!same && !opposite) continue;
    const double angle = coordinate[j] - turned(joint), near = (same ? angle : -angle) + turned(force);
    return own + 2.0 * std::numbers::pi * std::round((near - own) / (2.0 * std::numbers::pi));
  }
  return own;
}

}  // namespace freeplay
