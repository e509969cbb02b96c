#include "assembly/placing.h"

#include <cmath>
#include <functional>
#include <queue>
#include <vector>

#include <fmt/format.h>

#include "base/angle.h"
#include "base/index.h"
#include "system/spatial_kinematics.h"

namespace freeplay {
namespace {

// Where a frame stands: in the plane with the angle counted over turns, in space with a rotation.
struct PlanarPose {
  double x = 0.0, y = 0.0, angle = 0.0;

  static PlanarPose of(const Marker& m) { return {m.position[0], m.position[1], m.angle}; }
  static PlanarPose guess(const Body& body) {
    const Vector3 place = body.position.value_or(Vector3{});
    return {place[0], place[1], body.angle.value_or(0.0)};
  }
  // The second frame of a joint in the first.
  static PlanarPose of(const Pose& relative, bool is_angle, double coordinate) {
    double angle = std::atan2(relative.rotation[3], relative.rotation[0]);
    if (is_angle) angle = nearest_turn(angle, coordinate);
    return {relative.position[0], relative.position[1], angle};
  }
  static constexpr std::size_t lengths = 2;
  // Turned as the body's guess is where the path leaves that open.
  static PlanarPose on_path(const FramePath& given, const PathPose& path, const Body& body, const Marker& frame) {
    const double angle = given.gives(2) ? path[2].value : body.angle.value_or(0.0) + frame.angle;
    return {path[0].value, path[1].value, angle};
  }
  // Turned as the body's own guess says, if it does, for a frame that stands at `end`.
  static void turn_as_given(const Body& body, const Marker& far, PlanarPose& end) {
    if (body.angle) end.angle = *body.angle + far.angle;
  }
};

PlanarPose operator*(const PlanarPose& a, const PlanarPose& b) {
  const double c = std::cos(a.angle), s = std::sin(a.angle);
  return {a.x + c * b.x - s * b.y, a.y + s * b.x + c * b.y, a.angle + b.angle};
}
PlanarPose inverse(const PlanarPose& a) {
  const double c = std::cos(a.angle), s = std::sin(a.angle);
  return {-c * a.x - s * a.y, s * a.x - c * a.y, -a.angle};
}

struct SpatialPose {
  spatial::Vector position = spatial::Vector::Zero();
  spatial::Matrix rotation = spatial::Matrix::Identity();

  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  static SpatialPose of(const Marker& m) {
    return {spatial::vector(m.position.data()), Eigen::Map<const RowMajor>(m.rotation.data())};
  }
  static SpatialPose guess(const Body& body) {
    SpatialPose pose;
    if (body.position) pose.position = spatial::vector(body.position->data());
    if (body.rotation) pose.rotation = Eigen::Map<const RowMajor>(body.rotation->data());
    return pose;
  }
  static SpatialPose of(const Pose& relative, bool, double) {
    return {spatial::vector(relative.position), Eigen::Map<const RowMajor>(relative.rotation)};
  }
  static constexpr std::size_t lengths = 3;
  static SpatialPose on_path(const FramePath& given, const PathPose& path, const Body& body, const Marker& frame) {
    const spatial::Vector position(path[0].value, path[1].value, path[2].value);
    if (given.gives_turning()) return {position, Eigen::Map<const RowMajor>(path.turning.rotation.data())};
    return {position, guess(body).rotation * of(frame).rotation};
  }
  static void turn_as_given(const Body& body, const Marker& far, SpatialPose& end) {
    if (body.rotation) end.rotation = guess(body).rotation * of(far).rotation;
  }
};

SpatialPose operator*(const SpatialPose& a, const SpatialPose& b) {
  return {a.position + a.rotation * b.position, a.rotation * b.rotation};
}
SpatialPose inverse(const SpatialPose& a) { return {-(a.rotation.transpose() * a.position), a.rotation.transpose()}; }

template <class Frame>
class Walk {
 public:
  Walk(const System& closed, std::span<const double> coordinates)
      : system_(closed),
        model_(closed.model()),
        coordinates_(coordinates),
        frames_(model_.bodies.size()),
        placed_(model_.bodies.size(), 0),
        joints_of_(model_.bodies.size()) {
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      for (const int m : {model_.joints[at(j)].marker_a, model_.joints[at(j)].marker_b}) {
        if (marker(m).body != ground) joints_of_[at(marker(m).body)].push_back(j);
      }
      next_.push(j);
    }
  }

  void run() {
    place_paths();
    for (std::size_t b = 0; b < frames_.size(); ++b) {
      const Body& body = model_.bodies[b];
      if (!placed_[b] && body.position) put(static_cast<int>(b), Frame::guess(body));
    }
    place_others();
    for (std::size_t b = 0; b < frames_.size(); ++b) {
      if (!placed_[b]) frames_[b] = Frame::guess(model_.bodies[b]);
    }
  }

  Frame frame(int body) const { return frames_[at(body)]; }

 private:
  const Marker& marker(int m) const { return model_.markers[at(m)]; }
  Frame mount(int m) const { return Frame::of(marker(m)); }
  bool placed(BodyId body) const { return body == ground || placed_[at(body)] != 0; }
  Frame pose(BodyId body) const { return body == ground ? Frame{} : frames_[at(body)]; }
  void put(BodyId body, const Frame& pose) {
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
      if (body != ground && entry.path.gives_all(Frame::lengths)) {
        put(body, Frame::on_path(entry.path, path, model_.bodies[at(body)], marker(entry.marker)) *
                      inverse(mount(entry.marker)));
      }
      if constexpr (std::is_same_v<Frame, PlanarPose>) {
        for (int d = entry.first_driver; d < entry.first_driver + entry.driver_count; ++d) place_leg(d);
      }
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

  /// By the first joint of which one end is placed; those of a body come up again when it is.
  void place_others() {
    for (; !next_.empty();) {
      const int j = next_.top();
      next_.pop();
      const JointElement& joint = model_.joints[at(j)];
      const BodyId a = marker(joint.marker_a).body, b = marker(joint.marker_b).body;
      if (placed(a) == placed(b) || !place_by(j, placed(a))) continue;
      const BodyId body = marker(placed_last_).body;
      for (const int other : joints_of_[at(body)]) next_.push(other);
    }
  }

  // Places the body at the free end of a joint; false when its type cannot. What exerts forces alone holds nothing.
  bool place_by(int j, bool second_is_free) {
    if (system_.joints().layout(j).constraint_rows == 0) return false;
    const JointElement& joint = model_.joints[at(j)];
    const double coordinate = std::isnan(coordinates_[at(j)]) ? 0.0 : coordinates_[at(j)];
    Pose relative{};
    Message message;
    if (!system_.joints().handle(j).place(coordinate, relative, message)) {
      if (message.text[0] == '\0') return false;
      throw Error(Error::Category::plugin, "plugin-failed",
                  fmt::format("joint '{}' of {} failed to place a body: {}", joint.name,
                              model_.instances.words_of(*joint.component), message.text),
                  joint.location);
    }
    const bool is_angle = system_.joints().layout(j).coordinate == Coordinate::angle;
    const Frame b_in_a = Frame::of(relative, is_angle, coordinate);
    const int near = second_is_free ? joint.marker_a : joint.marker_b;
    const int far = second_is_free ? joint.marker_b : joint.marker_a;
    Frame end = pose(marker(near).body) * mount(near) * (second_is_free ? b_in_a : inverse(b_in_a));
    const BodyId body = marker(far).body;
    Frame::turn_as_given(model_.bodies[at(body)], marker(far), end);
    put(body, end * inverse(mount(far)));
    placed_last_ = far;
    return true;
  }

  const System& system_;
  const Model& model_;
  std::span<const double> coordinates_;
  std::vector<Frame> frames_;
  std::vector<char> placed_;
  std::vector<std::vector<int>> joints_of_;                          ///< by body
  std::priority_queue<int, std::vector<int>, std::greater<>> next_;  ///< joints that may place a body
  int placed_last_ = -1;                                             ///< a marker of the body
};

}  // namespace

void place_bodies(const System& closed, std::span<const double> coordinates, std::span<double> q) {
  const Model& model = closed.model();
  if (model.space == Space::spatial) {
    Walk<SpatialPose> walk(closed, coordinates);
    walk.run();
    for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
      const SpatialPose frame = walk.frame(b);
      Pose pose;
      spatial::target(pose.position) = frame.position;
      Eigen::Map<SpatialPose::RowMajor>(pose.rotation) = frame.rotation;
      closed.coordinates().set_frame_pose(b, pose, q);
    }
    return;
  }
  Walk<PlanarPose> walk(closed, coordinates);
  walk.run();
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    const Vector3& com = model.bodies[at(b)].com;
    const PlanarPose centre = walk.frame(b) * PlanarPose{com[0], com[1], 0.0};
    q[3 * at(b)] = centre.x;
    q[3 * at(b) + 1] = centre.y;
    q[3 * at(b) + 2] = centre.angle;
  }
}

void start_velocities(const System& closed, std::span<const double> q, std::span<double> v) {
  const Model& model = closed.model();
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    const Body& body = model.bodies[at(b)];
    const Pose frame = closed.coordinates().frame_pose(b, q);
    const Vector3& w = body.angular_velocity;
    double arm[3] = {};
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c) arm[r] += frame.rotation[3 * r + c] * body.com[c];
    }
    const double twist[6] = {body.velocity[0] + (w[1] * arm[2] - w[2] * arm[1]),
                             body.velocity[1] + (w[2] * arm[0] - w[0] * arm[2]),
                             body.velocity[2] + (w[0] * arm[1] - w[1] * arm[0]),
                             w[0],
                             w[1],
                             w[2]};
    closed.coordinates().set_body_twist(b, q, twist, v);
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
