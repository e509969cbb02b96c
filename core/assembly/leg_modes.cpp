#include "assembly/leg_modes.h"

#include <cmath>

#include "model/leg.h"

namespace freeplay {
namespace {

struct PlanePoint {
  double x = 0.0, y = 0.0;
};
PlanePoint operator-(const PlanePoint& a, const PlanePoint& b) { return {a.x - b.x, a.y - b.y}; }
double cross(const PlanePoint& a, const PlanePoint& b) { return a.x * b.y - a.y * b.x; }
double direction(const PlanePoint& a) { return std::atan2(a.y, a.x); }

class Bodies {
 public:
  Bodies(const Model& model, std::span<double> q) : model_(model), q_(q) {}

  PlanePoint world(int m) const {
    const Marker& marker = model_.markers[static_cast<std::size_t>(m)];
    if (marker.body == ground) return {marker.position[0], marker.position[1]};
    const PlanePoint arm = turned(marker);
    return {coordinates(marker)[0] + arm.x, coordinates(marker)[1] + arm.y};
  }

  /// Turns the body of a marker by `angle` and puts the marker at `place`.
  void put(int m, double angle, const PlanePoint& place) const {
    const Marker& marker = model_.markers[static_cast<std::size_t>(m)];
    double* q = coordinates(marker);
    q[2] += angle;
    const PlanePoint arm = turned(marker);
    q[0] = place.x - arm.x;
    q[1] = place.y - arm.y;
  }

 private:
  double* coordinates(const Marker& marker) const { return &q_[3 * static_cast<std::size_t>(marker.body)]; }
  PlanePoint turned(const Marker& marker) const {
    const Body& body = model_.bodies[static_cast<std::size_t>(marker.body)];
    const double x = marker.position[0] - body.com[0], y = marker.position[1] - body.com[1];
    const double c = std::cos(coordinates(marker)[2]), s = std::sin(coordinates(marker)[2]);
    return {c * x - s * y, s * x + c * y};
  }

  const Model& model_;
  std::span<double> q_;
};

bool has_pose(const Model& model, int m) {
  const Body& body = model.bodies[static_cast<std::size_t>(model.markers[static_cast<std::size_t>(m)].body)];
  return body.position.has_value() || body.angle.has_value();
}

}  // namespace

bool bend_leg(const Model& model, int joint, int marker, int elbow, std::span<double> q) {
  const std::optional<LegChain> leg = find_leg_chain(model, joint, marker);
  if (!leg) return false;
  const Bodies bodies(model, q);
  const PlanePoint a = bodies.world(leg->crank_at_a), b = bodies.world(leg->crank_at_b);
  const PlanePoint c = bodies.world(leg->coupler_at_c), line = c - a;
  if (elbow * cross(line, b - a) >= 0.0) return false;
  bodies.put(leg->crank_at_a, 2.0 * (direction(line) - direction(b - a)), a);
  bodies.put(leg->coupler_at_c, 2.0 * (direction(line) - direction(c - b)), c);
  return true;
}

bool bend_legs(const Model& model, const InverseKinematics& entry, std::span<double> q) {
  bool bent = false;
  for (int d = entry.first_driver; d < entry.first_driver + entry.driver_count; ++d) {
    const Driver& driver = model.drivers[static_cast<std::size_t>(d)];
    const std::optional<LegChain> leg = find_leg_chain(model, driver.joint, entry.marker);
    if (!leg) continue;
    if (!driver.elbow_given && (has_pose(model, leg->crank_at_a) || has_pose(model, leg->coupler_at_c))) continue;
    bent = bend_leg(model, driver.joint, entry.marker, driver.elbow, q) || bent;
  }
  return bent;
}

}  // namespace freeplay
