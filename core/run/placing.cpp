#include "run/placing.h"

#include <cmath>
#include <vector>

#include <fmt/format.h>

namespace freeplay {
namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

struct PlanarPose {
  double x = 0.0, y = 0.0, angle = 0.0;
};

PlanarPose operator*(const PlanarPose& a, const PlanarPose& b) {
  const double c = std::cos(a.angle), s = std::sin(a.angle);
  return {a.x + c * b.x - s * b.y, a.y + s * b.x + c * b.y, a.angle + b.angle};
}
PlanarPose inverse(const PlanarPose& a) {
  const double c = std::cos(a.angle), s = std::sin(a.angle);
  return {-c * a.x - s * a.y, s * a.x - c * a.y, -a.angle};
}

class Walk {
 public:
  Walk(const System& closed, std::span<const double> coordinates)
      : system_(closed),
        model_(closed.model()),
        coordinates_(coordinates),
        frames_(model_.bodies.size()),
        placed_(model_.bodies.size(), 0) {}

  void run() {
    place_paths();
    for (std::size_t b = 0; b < frames_.size(); ++b) {
      const Body& body = model_.bodies[b];
      if (!placed_[b] && body.position) {
        put(static_cast<int>(b), {(*body.position)[0], (*body.position)[1], body.angle.value_or(0.0)});
      }
    }
    while (place_next()) {
    }
    for (std::size_t b = 0; b < frames_.size(); ++b) {
      if (!placed_[b]) frames_[b] = {0.0, 0.0, model_.bodies[b].angle.value_or(0.0)};
    }
  }

  PlanarPose frame(int body) const { return frames_[at(body)]; }

 private:
  const Marker& marker(int m) const { return model_.markers[at(m)]; }
  PlanarPose mount(int m) const { return {marker(m).position[0], marker(m).position[1], marker(m).angle}; }
  bool placed(BodyId body) const { return body == ground || placed_[at(body)] != 0; }
  PlanarPose pose(BodyId body) const { return body == ground ? PlanarPose{} : frames_[at(body)]; }
  void put(BodyId body, const PlanarPose& pose) {
    frames_[at(body)] = pose;
    placed_[at(body)] = 1;
  }

  void place_paths() {
    for (int k = 0; k < static_cast<int>(model_.kinematics.size()); ++k) {
      const InverseKinematics& entry = model_.kinematics[at(k)];
      PathPose path;
      MotionFault fault;
      if (!system_.motions().path(k, model_.settings.start, path, fault)) {
        throw_motion_fault(model_, fault, Error::Category::input);
      }
      const BodyId body = marker(entry.marker).body;
      if (body != ground && entry.path[0] && entry.path[1]) {
        const double guess = model_.bodies[at(body)].angle.value_or(0.0) + marker(entry.marker).angle;
        const double angle = entry.path[2] ? path[2].value : guess;
        put(body, PlanarPose{path[0].value, path[1].value, angle} * inverse(mount(entry.marker)));
      }
      for (int d = entry.first_driver; d < entry.first_driver + entry.driver_count; ++d) place_leg(d);
    }
  }

  void place_leg(int driver) {
    if (system_.motions().leg(driver) == nullptr) return;
    const Leg& leg = *system_.motions().leg(driver);
    LegPose pose;
    MotionFault fault;
    if (!system_.motions().leg_pose(driver, model_.settings.start, pose, fault)) {
      throw_motion_fault(model_, fault, Error::Category::input);
    }
    const double direction = pose.crank.value + leg.crank_direction;
    const double bx = leg.ax + leg.crank * std::cos(direction), by = leg.ay + leg.crank * std::sin(direction);
    put_on_pin(leg.crank_body, pose.crank.value, leg.crank_pin_x, leg.crank_pin_y, leg.ax, leg.ay);
    put_on_pin(leg.coupler_body, pose.coupler.value, leg.coupler_pin_x, leg.coupler_pin_y, bx, by);
  }

  void put_on_pin(BodyId body, double angle, double pin_x, double pin_y, double x, double y) {
    const double c = std::cos(angle), s = std::sin(angle);
    put(body, {x - c * pin_x + s * pin_y, y - s * pin_x - c * pin_y, angle});
  }

  bool place_next() {
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      const JointElement& joint = model_.joints[at(j)];
      const BodyId a = marker(joint.marker_a).body, b = marker(joint.marker_b).body;
      if (placed(a) == placed(b)) continue;
      if (place_by(j, placed(a))) return true;
    }
    return false;
  }

  // Places the body at the free end of a joint; false when its type cannot.
  bool place_by(int j, bool second_is_free) {
    const JointElement& joint = model_.joints[at(j)];
    const double coordinate = std::isnan(coordinates_[at(j)]) ? 0.0 : coordinates_[at(j)];
    Pose relative{};
    Message message;
    if (!system_.joint(j).place(coordinate, relative, message)) {
      if (message.text[0] == '\0') return false;
      throw Error(Error::Category::plugin, "plugin-failed",
                  fmt::format("joint '{}' of {} failed to place a body: {}", joint.name,
                              model_.instances.words_of(*joint.component), message.text),
                  joint.location);
    }
    double angle = std::atan2(relative.rotation[3], relative.rotation[0]);
    if (system_.joint_layout(j).coordinate == Coordinate::angle) {
      angle += 2.0 * M_PI * std::round((coordinate - angle) / (2.0 * M_PI));
    }
    const PlanarPose b_in_a{relative.position[0], relative.position[1], angle};
    const int near = second_is_free ? joint.marker_a : joint.marker_b;
    const int far = second_is_free ? joint.marker_b : joint.marker_a;
    PlanarPose end = pose(marker(near).body) * mount(near) * (second_is_free ? b_in_a : inverse(b_in_a));
    const BodyId body = marker(far).body;
    if (const auto& given = model_.bodies[at(body)].angle) end.angle = *given + marker(far).angle;
    put(body, end * inverse(mount(far)));
    return true;
  }

  const System& system_;
  const Model& model_;
  std::span<const double> coordinates_;
  std::vector<PlanarPose> frames_;
  std::vector<char> placed_;
};

}  // namespace

void place_bodies(const System& closed, std::span<const double> coordinates, std::span<double> q) {
  Walk walk(closed, coordinates);
  walk.run();
  const Model& model = closed.model();
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    const Vector3& com = model.bodies[at(b)].com;
    const PlanarPose centre = walk.frame(b) * PlanarPose{com[0], com[1], 0.0};
    q[3 * at(b)] = centre.x;
    q[3 * at(b) + 1] = centre.y;
    q[3 * at(b) + 2] = centre.angle;
  }
}

void throw_motion_fault(const Model& model, const MotionFault& fault, Error::Category category) {
  Location location;
  if (fault.kinematics >= 0) {
    location = model.kinematics[at(fault.kinematics)].path_location;
  } else if (fault.driver >= 0) {
    location = model.drivers[at(fault.driver)].location;
  } else if (fault.force >= 0) {
    location = model.forces[at(fault.force)].location;
  }
  throw Error(category, fault.id, fault.text, location);
}

}  // namespace freeplay
