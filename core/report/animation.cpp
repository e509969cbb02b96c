#include "report/animation.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "component/joint_roles.h"
#include "report/base64.h"

namespace freeplay {
namespace {

constexpr std::size_t most_frames = 600, least_frames = 100;
constexpr const char* plane_pose[] = {"x", "y", "angle"};
constexpr const char* space_pose[] = {"x", "y", "z", "qw", "qx", "qy", "qz"};
constexpr const char* force_names[] = {"fx", "fy", "fz"};

/// What a picture shows of a joint: turn, slide, rod, weld; without rows a tie between two points, or a force along or
/// about an axis, which has no picture.
const char* symbol(const JointElement& joint, bool planar) {
  if (joint.is_force || (joint.layout.constraint_rows == 0 && !joint.has_play)) {
    return joint.layout.coordinate == Coordinate::none ? "tie" : "force";
  }
  if (joint.ideal_layout().coordinate == Coordinate::position) return "slide";
  if (joint.ideal_layout().coordinate == Coordinate::angle) return "turn";
  if (joint.ideal_layout().constraint_rows == 1) return "rod";
  return joint.ideal_layout().constraint_rows == (planar ? 3 : 6) ? "weld" : "turn";
}

}  // namespace

Animation::Animation(const Model& model, const std::vector<RecordColumn>& columns, std::size_t rows,
                     std::size_t numbers)
    : model_(model), planar_(model.space == Space::planar), rows_(rows) {
  add_bodies(columns);
  if (bodies_.empty()) return;
  add_joints(columns);
  plan(rows, numbers);
}

std::vector<std::size_t> Animation::place(const std::vector<RecordColumn>& columns, const std::string& prefix,
                                          std::span<const char* const> names) {
  std::vector<std::size_t> found;
  for (const char* name : names) {
    const auto column = std::ranges::find(columns, prefix + name, &RecordColumn::name);
    if (column == columns.end()) return {};
    found.push_back(static_cast<std::size_t>(column - columns.begin()));
  }
  std::vector<std::size_t> places;
  for (const std::size_t index : found) {
    places.push_back(columns_.size());
    columns_.push_back(index);
  }
  return places;
}

void Animation::add_bodies(const std::vector<RecordColumn>& columns) {
  const auto names = planar_ ? std::span<const char* const>(plane_pose) : std::span<const char* const>(space_pose);
  for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
    auto places = place(columns, "body." + model_.bodies[b].name + ".", names);
    if (places.empty()) {
      left_out_.push_back("pose of body " + model_.bodies[b].name);
    } else {
      bodies_.push_back({static_cast<int>(b), {std::move(places)}});
    }
  }
}

void Animation::add_joints(const std::vector<RecordColumn>& columns) {
  const auto names = std::span<const char* const>(force_names).first(planar_ ? 2 : 3);
  for (std::size_t j = 0; j < model_.joints.size(); ++j) {
    const JointElement& joint = model_.joints[j];
    if (joint.gear >= 0) continue;
    const auto body = [&](int marker) { return model_.markers[static_cast<std::size_t>(marker)].body; };
    if (!drawn(body(joint.marker_a)) || !drawn(body(joint.marker_b))) continue;
    const std::string prefix = (joint.is_force ? "force." : "joint.") + joint.name + ".";
    joints_.push_back({static_cast<int>(j), {place(columns, prefix, names)}});
  }
}

void Animation::plan(std::size_t rows, std::size_t numbers) {
  std::size_t each = 0;
  for (const DrawnBody& body : bodies_) each += body.pose.places.size();
  for (const DrawnJoint& joint : joints_) each += joint.force.places.size();
  frames_ = std::min({most_frames, rows, std::max(least_frames, numbers / std::max<std::size_t>(each, 1))});
  std::size_t used = 0;
  const auto find_room = [&](Moving& moving) {
    const std::size_t needed = frames_ * moving.places.size();
    moving.still = used + needed > numbers;
    if (!moving.still) used += needed;
    return !moving.still;
  };
  for (DrawnBody& body : bodies_) {
    if (!find_room(body.pose)) left_out_.push_back("motion of body " + name_of(body.body));
  }
  for (DrawnJoint& joint : joints_) {
    if (joint.force.places.empty() || find_room(joint.force)) continue;
    left_out_.push_back("force of joint " + model_.joints[static_cast<std::size_t>(joint.joint)].name);
  }
  for (std::size_t k = 0; k < frames_; ++k) {
    frame_rows_.push_back(static_cast<std::int32_t>(frames_ > 1 ? k * (rows_ - 1) / (frames_ - 1) : 0));
  }
}

bool Animation::drawn(BodyId body) const {
  return body == ground || std::ranges::find(bodies_, body, &DrawnBody::body) != bodies_.end();
}

std::string Animation::name_of(BodyId body) const {
  return body == ground ? "ground" : model_.bodies[static_cast<std::size_t>(body)].name;
}

void Animation::row(double time, std::span<const double> numbers) {
  const std::size_t row = row_++;
  if (times_.size() >= frame_rows_.size() || frame_rows_[times_.size()] != static_cast<std::int32_t>(row)) return;
  const auto take = [&](Moving& moving, bool once) {
    if (moving.still && (!once || !times_.empty())) return;
    for (const std::size_t place : moving.places) moving.numbers.push_back(numbers[place]);
  };
  for (DrawnBody& body : bodies_) take(body.pose, true);
  for (DrawnJoint& joint : joints_) take(joint.force, false);
  times_.push_back(time);
}

std::size_t Animation::size() const {
  std::size_t size = base64_size(4 * frames_) + base64_size(8 * frames_);
  const auto add = [&](const Moving& moving) {
    size += base64_size(4 * moving.places.size() * (moving.still ? 1 : frames_));
  };
  for (const DrawnBody& body : bodies_) add(body.pose);
  for (const DrawnJoint& joint : joints_) add(joint.force);
  return size;
}

/// From the centre of mass, whose place the poses are, in body axes; on ground the place itself.
Json Animation::point(BodyId body, const Vector3& position) const {
  const Vector3 com = body == ground ? Vector3{} : model_.bodies[static_cast<std::size_t>(body)].com;
  Json json = Json::array();
  for (std::size_t i = 0; i < (planar_ ? 2u : 3u); ++i) json.push_back(position[i] - com[i]);
  return json;
}

/// Frames that something stands on and those that the file declares; the centre of mass where these are fewer than two.
Json Animation::points_of(int body) const {
  Json points = Json::array();
  const auto add = [&](const Vector3& position) {
    Json one = point(body, position);
    if (std::ranges::find(points, one) == points.end()) points.push_back(std::move(one));
  };
  for (const Marker& marker : model_.markers) {
    if (marker.body == body && !marker.name.ends_with("/com")) add(marker.position);
  }
  for (const Marker& frame : model_.frames) {
    if (frame.body == body && !frame.name.ends_with("/com") && !frame.name.ends_with("/origin")) add(frame.position);
  }
  if (points.size() < 2) add(model_.bodies[static_cast<std::size_t>(body)].com);
  return points;
}

Json Animation::body_json(const DrawnBody& drawn) const {
  const std::size_t width = drawn.pose.places.size();
  std::vector<double> numbers = drawn.pose.numbers, offset(width, 0.0);
  for (std::size_t i = 0; i < width; ++i) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (std::size_t k = i; k < numbers.size(); k += width) {
      low = std::min(low, numbers[k]);
      high = std::max(high, numbers[k]);
    }
    if (std::isfinite(low) && std::isfinite(high)) offset[i] = 0.5 * low + 0.5 * high;
    for (std::size_t k = i; k < numbers.size(); k += width) numbers[k] -= offset[i];
  }
  return {{"name", name_of(drawn.body)},
          {"points", points_of(drawn.body)},
          {"offset", offset},
          {"poses", base64_floats(numbers)}};
}

Json Animation::joint_json(const DrawnJoint& drawn) const {
  const JointElement& joint = model_.joints[static_cast<std::size_t>(drawn.joint)];
  const Marker& a = model_.markers[static_cast<std::size_t>(joint.marker_a)];
  const Marker& b = model_.markers[static_cast<std::size_t>(joint.marker_b)];
  const char* what = symbol(joint, planar_);
  const bool round = joint.layout.clearance > 0.0 && !plays_between_walls(joint.layout);  // drawn as a circle
  Json json = {{"name", joint.name},
               {"kind", joint.component->description.name},
               {"symbol", what},
               {"first", name_of(a.body)},
               {"at_first", point(a.body, a.position)},
               {"second", name_of(b.body)},
               {"at_second", point(b.body, b.position)},
               {"clearance", round ? Json(joint.layout.clearance) : Json(nullptr)},
               {"forces", drawn.force.still ? std::string() : base64_floats(drawn.force.numbers)}};
  if (what != std::string_view("slide")) return json;
  const Rotation& r = a.rotation;
  const std::size_t k = joint.component->description.axis == MarkerAxis::z ? 2 : 0;
  const Vector3 axis = planar_ ? Vector3{std::cos(a.angle), std::sin(a.angle), 0.0} : Vector3{r[k], r[3 + k], r[6 + k]};
  json["axis"] = point(ground, axis);
  return json;
}

/// Frames whose paths are prescribed or reported.
Json Animation::marks() const {
  Json list = Json::array();
  std::vector<int> markers;
  for (const InverseKinematics& entry : model_.kinematics) markers.push_back(entry.marker);
  markers.insert(markers.end(), model_.settings.frames.begin(), model_.settings.frames.end());
  for (const int index : markers) {
    const Marker& marker = model_.markers[static_cast<std::size_t>(index)];
    if (marker.body == ground || !drawn(marker.body)) continue;
    list.push_back(
        {{"name", marker.name}, {"body", name_of(marker.body)}, {"at", point(marker.body, marker.position)}});
  }
  return list;
}

Json Animation::json() const {
  Json bodies = Json::array(), joints = Json::array();
  for (const DrawnBody& body : bodies_) bodies.push_back(body_json(body));
  for (const DrawnJoint& joint : joints_) joints.push_back(joint_json(joint));
  return {{"frames", frames_},
          {"rows", base64_numbers<std::int32_t>(frame_rows_)},
          {"times", base64_numbers<double>(times_)},
          {"space", planar_ ? "planar" : "spatial"},
          {"bodies", std::move(bodies)},
          {"joints", std::move(joints)},
          {"marks", marks()}};
}

}  // namespace freeplay
