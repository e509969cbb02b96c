#include "assembly/start_report.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "assembly/given_poses.h"
#include "assembly/placing.h"
#include "assembly/play_rows.h"
#include "base/angle.h"
#include "base/index.h"

namespace freeplay {
namespace {

constexpr double noticed = 1e-4;               // of the size, of a radian, of a velocity
constexpr double noticed_of_play = 1e-3;       // of the clearance: of what its block gives
constexpr double noticed_pose_in_play = 0.05;  // of the clearance: of a pose
constexpr double far_turn = GivenPoses::far_turn, far_part = GivenPoses::far_part;

constexpr const char* by_load = "place under load";

constexpr double turned = 0.25 * std::numbers::pi;  // that is no matter of taste

double degrees(double angle) { return angle * 180.0 / std::numbers::pi; }

/// A joint that holds the axes of a body as those of ground, or null.
const JointElement* guide_on_ground(const System& closed, BodyId body) {
  const Model& model = closed.model();
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    const JointElement& joint = model.joints[at(j)];
    const BodyId a = model.markers[at(joint.marker_a)].body, b = model.markers[at(joint.marker_b)].body;
    if (joint.gear >= 0 || std::min(a, b) != ground || std::max(a, b) != body) continue;
    const bool slides = joint.ideal_layout().coordinate == Coordinate::position;
    const int rows = closed.layout().rows(j).size;
    if (model.space == Space::planar ? rows == 3 || (rows == 2 && slides) : rows == 6 || (rows == 5 && slides))
      return &joint;
  }
  return nullptr;
}

/// Whether something of the body goes elsewhere where it turns.
bool has_parts(const Model& model, BodyId body) {
  const auto away = [](const Vector3& place) { return place != Vector3{}; };
  return away(model.bodies[at(body)].com) || std::ranges::any_of(model.markers, [&](const Marker& marker) {
           return marker.body == body && away(marker.position);
         });
}

double turn_of(const System& closed, BodyId body, std::span<const double> q) {
  const Pose pose = closed.coordinates().frame_pose(body, q);
  const double* r = pose.rotation;
  return std::acos(std::clamp(0.5 * (r[0] + r[4] + r[8] - 1.0), -1.0, 1.0));
}

/// The guide that turns what stands on a body whose pose gives no angle, or null.
const JointElement* turned_by(const System& closed, BodyId id, std::span<const double> q) {
  const Body& body = closed.model().bodies[at(id)];
  const bool given = !body.position || body.angle || body.rotation;
  if (given || turn_of(closed, id, q) <= turned || !has_parts(closed.model(), id)) return nullptr;
  return guide_on_ground(closed, id);
}

}  // namespace

std::vector<MovedStart> moved_starts(const System& closed, std::span<const double> q, std::span<const double> v) {
  const Model& model = closed.model();
  const GivenPoses poses(closed);
  std::vector<double> given(v.size());
  start_velocities(closed, q, given);
  std::vector<MovedStart> out;
  const auto add = [&](const Body& body, const char* quantity, const char* unit, double by, double least, double far,
                       const Location& location) {
    if (by > least) out.push_back({body.name, quantity, unit, by, by > far, location});
  };
  std::vector<double> least_shift(model.bodies.size(), noticed * closed.size());
  for (const JointElement& joint : model.joints) {
    if (!joint.has_play || !(joint.layout.clearance > 0.0)) continue;
    for (const int marker : {joint.marker_a, joint.marker_b}) {
      const BodyId body = model.markers[at(marker)].body;
      if (body == ground) continue;
      double& least = least_shift[at(body)];  // in play a pose counts to parts of it
      least = std::min(least, noticed_pose_in_play * joint.layout.clearance);
    }
  }
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    const Body& body = model.bodies[at(b)];
    const double size = closed.size();
    if (body.position)
      add(body, "position", "m", poses.shift(b, q), least_shift[at(b)], far_part * size, body.pose_location);
    if (body.angle) add(body, "angle", "rad", poses.turn(b, q), noticed, far_turn, body.pose_location);
    if (body.rotation) add(body, "orientation", "rad", poses.turn(b, q), noticed, far_turn, body.pose_location);
    if (const JointElement* guide = turned_by(closed, b, q))
      out.push_back({body.name, "turn", "rad", turn_of(closed, b, q), false, body.pose_location, guide->name});
    if (!body.velocity_given && !body.angular_velocity_given) continue;
    double wanted[6], is[6];
    closed.coordinates().body_twist(b, q, given, wanted);
    closed.coordinates().body_twist(b, q, v, is);
    const auto length = [](double x, double y, double z) { return std::hypot(x, y, z); };
    const double turn = length(is[3] - wanted[3], is[4] - wanted[4], is[5] - wanted[5]);
    const double asked = length(wanted[3], wanted[4], wanted[5]);
    if (body.angular_velocity_given) {
      const double unit = std::max(asked, 1e-3);
      add(body, "angular velocity", "rad/s", turn, noticed * unit, far_part * unit, body.velocity_location);
    }
    if (!body.velocity_given) continue;
    // Of the origin of the body's frame.
    const Pose frame = closed.coordinates().frame_pose(b, q);
    double miss[3], arm[3] = {};
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c) arm[r] -= frame.rotation[3 * r + c] * body.com[c];
    }
    const double w[3] = {is[3], is[4], is[5]};
    miss[0] = is[0] + w[1] * arm[2] - w[2] * arm[1] - body.velocity[0];
    miss[1] = is[1] + w[2] * arm[0] - w[0] * arm[2] - body.velocity[1];
    miss[2] = is[2] + w[0] * arm[1] - w[1] * arm[0] - body.velocity[2];
    const double unit = std::max(length(body.velocity[0], body.velocity[1], body.velocity[2]), 1e-3 * size);
    add(body, "velocity", "m/s", length(miss[0], miss[1], miss[2]), noticed * unit, far_part * unit,
        body.velocity_location);
  }
  return out;
}

void add_moved_journal(const JointElement& joint, bool gives_velocity, const InitialOffset& wanted, double apart,
                       double rate, std::vector<MovedStart>& moved) {
  const auto length = [](const double* v) { return std::hypot(v[0], v[1], v[2]); };
  const double play = joint.layout.clearance > 0.0 ? joint.layout.clearance : length(wanted.position);
  if (length(wanted.position) > 0.0 && apart > noticed_of_play * play) {
    // The place under its load is none that the file gives, and could give otherwise.
    const bool loaded = starts_by_its_load(joint);
    moved.push_back({{},
                     loaded ? by_load : "eccentricity",
                     "m",
                     apart,
                     !loaded && apart > far_part * play,
                     joint.location,
                     joint.name});
  }
  const double speed = std::max(length(wanted.velocity), 1e-3 * play);
  if (gives_velocity && rate > noticed * speed) {
    moved.push_back({{}, "velocity", "m/s", rate, rate > far_part * speed, joint.location, joint.name});
  }
}

TwinStart twin_start(const System& closed, std::span<const double> taken, std::span<const double> other) {
  const Model& model = closed.model();
  std::vector<double> difference(at(closed.layout().nv()));
  closed.coordinates().difference(taken, other, difference);
  const int width = closed.layout().body_velocities();
  int worst = 0;
  double largest = -1.0;
  bool turns = true;
  for (int i = 0; i < static_cast<int>(difference.size()); ++i) {
    const double size = closed.coordinates().is_turn(i) ? std::abs(wrapped(difference[at(i)]))
                                                        : std::abs(difference[at(i)]) / closed.size();
    if (size > largest * (1.0 + 1e-6)) largest = size, worst = i / width, turns = closed.coordinates().is_turn(i);
  }
  const Body& body = model.bodies[at(worst)];
  const auto where = [&](std::span<const double> q) {
    // As the rows have it; the other within half a turn of that.
    const std::size_t angle = 3 * at(worst) + 2;
    if (turns && width == 3) return fmt::format("{:.1f} deg", degrees(taken[angle] + wrapped(q[angle] - taken[angle])));
    const Pose pose = closed.coordinates().frame_pose(worst, q);
    if (width == 3) return fmt::format("[{:.4g}, {:.4g}] m", pose.position[0], pose.position[1]);
    if (!turns) return fmt::format("[{:.4g}, {:.4g}, {:.4g}] m", pose.position[0], pose.position[1], pose.position[2]);
    const double* r = pose.rotation;
    return fmt::format("rpy [{:.1f}, {:.1f}, {:.1f}] deg", degrees(std::atan2(r[7], r[8])),
                       degrees(std::asin(std::clamp(-r[6], -1.0, 1.0))), degrees(std::atan2(r[3], r[0])));
  };
  return {body.name, where(taken), where(other), body.pose_location.line > 0 ? body.pose_location : body.location};
}

std::string sentence(const MovedStart& moved) {
  const bool turns = moved.unit == "rad", speed = moved.unit.ends_with("/s");
  const std::string by =
      turns ? fmt::format("{:.3g} deg", degrees(moved.by)) : fmt::format("{:.3g} {}", moved.by, moved.unit);
  const char* const far = moved.far ? ": that is far, correct it or the joints that lead there" : "";
  if (moved.quantity == "turn") {
    return fmt::format(
        "body '{}' starts turned by {} with all its frames, as joint '{}' holds it: its `pose` gives a "
        "position alone",
        moved.body, by, moved.joint);
  }
  if (moved.quantity == by_load) {
    return fmt::format(
        "the journal of joint '{}' starts {} from where its load alone would press it: other joints hold it",
        moved.joint, by);
  }
  if (!moved.joint.empty()) {
    return fmt::format("the journal of joint '{}' starts {} from the {} that `clearance.initial` gives{}", moved.joint,
                       by, moved.quantity, far);
  }
  return fmt::format("body '{}' starts {} from the {} that its `{}` gives{}", moved.body, by, moved.quantity,
                     speed ? "velocity" : "pose", far);
}

std::string sentence(const TwinStart& twin) {
  return fmt::format("two positions are equally near to what the file gives: body '{}' at {} (taken) or at {}",
                     twin.body, twin.taken, twin.other);
}

std::string sentence(const Model& model, const ChosenSpeed& chosen) {
  if (chosen.body >= 0) {
    std::string speeds;
    if (chosen.speed > 0.0) speeds = fmt::format("{:.4g} m/s", chosen.speed);
    if (chosen.angular_speed > 0.0)
      speeds += fmt::format("{}{:.4g} rad/s", speeds.empty() ? "" : " and ", chosen.angular_speed);
    return fmt::format("body '{}' starts at {} by least kinetic energy: the file leaves its velocity open",
                       model.bodies[at(chosen.body)].name, speeds);
  }
  const JointElement& joint = model.joints[at(chosen.joint)];
  const bool turns = joint.ideal_layout().coordinate == Coordinate::angle;
  return fmt::format("joint '{}' starts at {:.4g} {} by least kinetic energy: the file leaves its speed open",
                     joint.name, chosen.speed, turns ? "rad/s" : "m/s");
}

}  // namespace freeplay
