#include "format/body_section.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "format/doubtful_number.h"
#include "format/rotation_keys.h"
#include "model/rotation.h"

namespace freeplay {
namespace {

void read_pose(const CheckedValue& value, Body& body) {
  MapReader map(value, "pose");
  body.pose_location = value.key_location();
  const auto position = map.find("position");
  if (position) body.position = position->vector(dimension::length);
  body.rotation = read_rotation(map);
  if (value.in_space()) {
    map.refuse("angle", "only in planar models; use 'rpy' or 'quaternion'");
  } else if (const auto angle = map.find("angle")) {
    body.angle = angle->quantity(dimension::angle);
    if (body.angle) doubt_direction(*angle, *body.angle);
  }
  map.finish();
}

void read_velocity(const CheckedValue& value, Body& body) {
  MapReader map(value, "velocity");
  body.velocity_location = value.key_location();
  const auto linear = map.find("linear");
  const auto angular = map.find("angular");
  body.velocity_given = linear.has_value();
  body.angular_velocity_given = angular.has_value();
  if (linear) body.velocity = linear->vector(dimension::velocity).value_or(Vector3{});
  if (angular && value.in_space()) {
    body.angular_velocity = angular->vector(dimension::angular_velocity).value_or(Vector3{});
    for (std::size_t i = 0; i < 3 && angular->node().is_list(); ++i) {
      if (i < angular->node().items.size()) doubt_angular_speed(angular->item(i), body.angular_velocity[i]);
    }
  } else if (angular) {
    body.angular_velocity[2] = angular->quantity(dimension::angular_velocity).value_or(0.0);
    doubt_angular_speed(*angular, body.angular_velocity[2]);
  }
  map.finish();
}

// [Ixx, Iyy, Izz], [Ixx, Iyy, Izz, Ixy, Ixz, Iyz] (elements of the tensor) or its three rows.
std::optional<Rotation> read_tensor(const CheckedValue& value) {
  const auto items = value.list();
  if (!items) return std::nullopt;
  const auto rows_of = [&]() -> std::optional<Rotation> {
    Rotation tensor{};
    for (std::size_t r = 0; r < 3; ++r) {
      const auto row = (*items)[r].quantities(3, dimension::moment_of_inertia);
      if (!row) return std::nullopt;
      std::ranges::copy(*row, tensor.begin() + static_cast<std::ptrdiff_t>(3 * r));
    }
    return tensor;
  };
  if (items->size() == 3 && (*items)[0].node().is_list()) {
    const std::optional<Rotation> tensor = rows_of();
    if (!tensor) return std::nullopt;
    for (const auto& [r, c] : {std::pair(1, 3), std::pair(2, 6), std::pair(5, 7)}) {
      const double upper = (*tensor)[static_cast<std::size_t>(r)], lower = (*tensor)[static_cast<std::size_t>(c)];
      if (std::abs(upper - lower) <= 1e-9 * std::max(std::abs(upper), std::abs(lower))) continue;
      value.fail("out-of-range",
                 fmt::format("a tensor of inertia is symmetric, but {:.6g} faces {:.6g}", upper, lower));
      return std::nullopt;
    }
    return tensor;
  }
  if (items->size() != 3 && items->size() != 6) {
    value.wrong_type("3 moments of inertia, 6 numbers or 3 rows of 3");
    return std::nullopt;
  }
  const auto n = value.quantities(items->size(), dimension::moment_of_inertia);
  if (!n) return std::nullopt;
  if (n->size() == 3) return Rotation{(*n)[0], 0.0, 0.0, 0.0, (*n)[1], 0.0, 0.0, 0.0, (*n)[2]};
  return Rotation{(*n)[0], (*n)[3], (*n)[4], (*n)[3], (*n)[1], (*n)[5], (*n)[4], (*n)[5], (*n)[2]};
}

void read_inertia(const CheckedValue& value, Body& body) {
  if (!value.in_space()) {
    body.inertia[8] = value.quantity(dimension::moment_of_inertia, not_negative).value_or(1.0);
    if (body.inertia[8] != 0.0) return;
    return value.warn("zero-inertia", "the body '" + body.name + "' has no moment of inertia: it is a point mass");
  }
  body.inertia = no_rotation;
  const std::optional<Rotation> tensor = read_tensor(value);
  if (!tensor) return;
  const Vector3 p = principal_moments(*tensor);
  const double slack = 1e-6 * p[2];
  if (p[0] < -slack || p[2] > p[0] + p[1] + slack) {
    const std::string moments = fmt::format("{:.6g}, {:.6g}, {:.6g}", p[0], p[1], p[2]);
    return value.fail("out-of-range",
                      p[0] < -slack
                          ? "no body has this inertia: a principal moment is negative (" + moments + ")"
                          : "no body has this inertia: its largest principal moment is above the sum of the others (" +
                                moments + ")");
  }
  body.inertia = *tensor;
  if (p[2] == 0.0) {
    value.warn("zero-inertia", "the body '" + body.name + "' has no moment of inertia: it is a point mass");
  }
}

void read_body(const CheckedValue& entry, Body& body) {
  MapReader map(entry, "body");
  const auto mass = map.require("mass");
  const auto inertia = map.require("inertia");
  if (mass) body.mass = mass->quantity(dimension::mass, positive).value_or(1.0);
  if (inertia) read_inertia(*inertia, body);
  if (const auto com = map.find("com")) body.com = com->vector(dimension::length).value_or(Vector3{});
  if (const auto pose = map.find("pose")) read_pose(*pose, body);
  if (const auto velocity = map.find("velocity")) read_velocity(*velocity, body);
  map.find("frames");
  map.finish();
}

void check_ground(const CheckedValue& entry) {
  MapReader map(entry, "ground");
  map.find("frames");
  for (const char* key : {"mass", "inertia", "com", "pose", "velocity", "use"}) {
    map.refuse(key, "ground does not move; it carries frames only");
  }
  map.finish();
}

}  // namespace

void add_bodies(Draft& draft, const Part& part) {
  const auto section = part.section("bodies");
  if (!section) return;
  for (const CheckedValue& entry : entries_of(*section)) {
    if (entry.key() == "ground") {
      check_ground(entry);
      continue;
    }
    Draft::check_name(entry);
    const std::string name = part.full(entry.key());
    if (!draft.bodies.add(name)) continue;  // only after an instance name was refused
    Body& body = draft.model.bodies.emplace_back();
    body.name = name;
    body.location = entry.key_location();
    body.gravity = draft.model.gravity;
    read_body(entry, body);
    const int id = static_cast<int>(draft.model.bodies.size()) - 1;
    draft.frames[name + "/origin"] = {id, {}, 0.0};
    draft.frames[name + "/com"] = {id, body.com, 0.0};
  }
}

}  // namespace freeplay
