// Gears whose teeth press at the pitch point, without play.
#pragma once

#include <optional>

#include "base/index.h"
#include "model/model.h"

namespace freeplay {

inline constexpr const char* pressure_angle_word = "pressure_angle";

/// A gear with a pressure angle, its only parameter: bearings feel its teeth. One with play that is made ideal keeps
/// the parameters of its play.
inline bool has_teeth(const JointElement& joint) {
  return joint.gear >= 0 && !joint.has_play && joint.parameters != nullptr &&
         joint.parameters->component == joint.component;
}
/// A gear that couples two motions alone: bearings feel nothing of it.
inline bool couples_alone(const JointElement& joint) { return joint.gear >= 0 && !joint.has_play && !has_teeth(joint); }
/// Of a gear that has teeth [rad].
inline double pressure_angle(const JointElement& joint) { return joint.parameters->values.begin()->second.number; }

/// The one body on which both joints of a gear stand: it carries the wheels.
inline std::optional<BodyId> carrier_of(const Model& model, const Gear& gear) {
  const JointElement &first = model.joints[at(gear.first)], &second = model.joints[at(gear.second)];
  const auto body = [&](int marker) { return model.markers[at(marker)].body; };
  const auto is_of_second = [&](int marker) {
    return body(marker) == body(second.marker_a) || body(marker) == body(second.marker_b);
  };
  const bool a = is_of_second(first.marker_a), b = is_of_second(first.marker_b);
  if (a == b) return std::nullopt;
  return body(a ? first.marker_a : first.marker_b);
}

}  // namespace freeplay
