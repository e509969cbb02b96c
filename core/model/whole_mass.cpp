#include "model/whole_mass.h"

#include <algorithm>
#include <cmath>

#include "model/force_element.h"

namespace freeplay {

// Bodies are as far apart as their markers let them be.
double model_length(const Model& model) {
  const auto length = [](const Vector3& v) { return std::hypot(std::hypot(v[0], v[1]), v[2]); };
  double size = 0.0;
  for (const Marker& marker : model.markers) {
    Vector3 place = marker.position;
    if (marker.body != ground) {
      const Vector3& com = model.bodies[static_cast<std::size_t>(marker.body)].com;
      for (std::size_t i = 0; i < 3; ++i) place[i] -= com[i];
    }
    size = std::max(size, length(place));
  }
  for (const Body& body : model.bodies) {
    if (body.position) size = std::max(size, length(*body.position));
  }
  return size;
}

double model_size(const Model& model) {
  const double length = model_length(model);
  return length > 0.0 ? length : 1.0;
}

WholeMass whole_mass(const Model& model) {
  WholeMass all;
  for (const Body& body : model.bodies) {
    all.mass += body.mass;
    all.inertia += std::max({body.inertia[0], body.inertia[4], body.inertia[8]});
  }
  return all;
}

bool is_on_ground(const Model& model) {
  return std::ranges::any_of(model.joints, [&](const JointElement& joint) {
    if (is_force_element(joint) || joint.gear >= 0) return false;
    const auto body = [&](int marker) { return model.markers[static_cast<std::size_t>(marker)].body; };
    return body(joint.marker_a) == ground || body(joint.marker_b) == ground;
  });
}

}  // namespace freeplay
