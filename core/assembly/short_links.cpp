#include "assembly/short_links.h"

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <fmt/format.h>

#include "base/index.h"
#include "model/force_element.h"

namespace freeplay {
namespace {

constexpr double same_axis = 1e-6;  // distance of pins, by the clearance: several on one axis

/// A pin of a body, and what it joins to it.
struct Pin {
  const JointElement* joint;
  const Marker* own;
  BodyId other;
};

bool is_pin(const JointElement& joint) { return joint.ideal_layout().coordinate == Coordinate::angle; }

/// Across the axis of the first.
double distance(const Model& model, const Marker& first, const Marker& second) {
  Eigen::Vector3d apart;
  for (int i = 0; i < 3; ++i) apart[i] = second.position[at(i)] - first.position[at(i)];
  const Eigen::Vector3d axis(first.rotation[2], first.rotation[5], first.rotation[8]);
  return model.space == Space::spatial ? apart.cross(axis).norm() : apart.norm();
}

}  // namespace

void doubt_short_links(
    const Model& model,
    const std::function<void(const char* id, const std::string& message, const JointElement&)>& doubt) {
  struct Holds {
    std::array<Pin, 2> pins{};
    std::size_t joints = 0, count = 0;  // count: pins, at most two
  };
  std::vector<Holds> by_body(model.bodies.size());
  for (const JointElement& joint : model.joints) {
    if (joint.gear >= 0 || is_force_element(joint)) continue;
    const Marker &a = model.markers[at(joint.marker_a)], &b = model.markers[at(joint.marker_b)];
    for (const auto& [own, other] : {std::pair(&a, &b), std::pair(&b, &a)}) {
      if (own->body == ground || (own == &b && a.body == b.body)) continue;
      Holds& holds = by_body[at(own->body)];
      ++holds.joints;
      if (is_pin(joint) && holds.count < holds.pins.size()) holds.pins[holds.count++] = {&joint, own, other->body};
    }
  }
  for (BodyId body = 0; body < static_cast<BodyId>(by_body.size()); ++body) {
    const auto& [pins, joints, count] = by_body[at(body)];
    if (joints != 2 || count != 2 || pins[0].other == pins[1].other) continue;
    const auto play = [](const Pin& pin) { return pin.joint->has_play ? pin.joint->layout.clearance : 0.0; };
    const Pin& loose = play(pins[0]) > play(pins[1]) ? pins[0] : pins[1];
    const double length = distance(model, *pins[0].own, *pins[1].own);
    if (!(length < play(loose)) || !(length > same_axis * play(loose))) continue;
    doubt("doubtful-clearance",
          fmt::format("the clearance of joint '{}' is {:.4g} m, more than the {:.3g} m between the two pins of body "
                      "'{}', which can go round in it and move nothing: check it, the frames of the body and their "
                      "units",
                      loose.joint->name, play(loose), length, model.bodies[at(body)].name),
          *loose.joint);
  }
}

}  // namespace freeplay
