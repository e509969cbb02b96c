#include "drawing/joint_shapes.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace freeplay {

std::vector<JointShape> JointShapes::of(const Model& model, const JointElement& joint) {
  std::vector<JointShape> shapes;
  for (const BodyLine& line : joint.layout.outlines) {
    JointShape shape{line.on_second != 0 ? joint.marker_b : joint.marker_a, {}};
    const Marker& at = model.markers[static_cast<std::size_t>(shape.marker)];
    const double c = std::cos(at.angle), s = std::sin(at.angle);
    for (std::size_t i = 0; i + 1 < line.points.size; i += 2) {
      const double x = line.points[i], y = line.points[i + 1];
      shape.points.push_back({at.position[0] + c * x - s * y, at.position[1] + s * x + c * y});
    }
    shapes.push_back(std::move(shape));
  }
  return shapes;
}

JointShapes::JointShapes(const Model& model) : outlined_(model.markers.size(), 0) {
  std::vector<char> held(model.markers.size(), 0);
  for (const JointElement& joint : model.joints) {
    for (const int marker : {joint.marker_a, joint.marker_b}) {
      if (marker >= 0) (joint.layout.outlines.empty() ? held : outlined_)[static_cast<std::size_t>(marker)] = 1;
    }
    std::ranges::move(of(model, joint), std::back_inserter(all_));
  }
  for (const AppliedForce& force : model.forces) held[static_cast<std::size_t>(force.marker)] = 1;
  for (std::size_t m = 0; m < held.size(); ++m) {
    if (held[m] != 0) outlined_[m] = 0;
  }
}

}  // namespace freeplay
