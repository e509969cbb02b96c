#include "model/body_section.h"

namespace freeplay {
namespace {

void read_pose(const CheckedValue& value, Body& body) {
  MapReader map(value, "pose");
  const auto position = map.find("position");
  const auto angle = map.find("angle");
  if (position) body.position = position->vector(dimension::length);
  if (angle) body.angle = angle->quantity(dimension::angle);
  for (const char* spatial : {"rpy", "quaternion"}) map.refuse(spatial, "only in spatial models");
  map.finish();
}

void read_velocity(const CheckedValue& value, Body& body) {
  MapReader map(value, "velocity");
  const auto linear = map.find("linear");
  const auto angular = map.find("angular");
  if (linear) body.velocity = linear->vector(dimension::velocity).value_or(Vector3{});
  if (angular) body.angular_velocity[2] = angular->quantity(dimension::angular_velocity).value_or(0.0);
  map.finish();
}

void read_body(const CheckedValue& entry, Body& body) {
  MapReader map(entry, "body");
  const auto mass = map.require("mass");
  const auto inertia = map.require("inertia");
  if (mass) body.mass = mass->quantity(dimension::mass, positive).value_or(1.0);
  if (inertia) body.inertia[8] = inertia->quantity(dimension::moment_of_inertia, not_negative).value_or(1.0);
  if (inertia && body.inertia[8] == 0.0) {
    inertia->warn("zero-inertia", "the body '" + body.name + "' has no moment of inertia: it is a point mass");
  }
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
