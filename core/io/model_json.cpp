#include "io/model_json.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "model/parameter_tree.h"

namespace freeplay {
namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

/// Vectors of planar models are two numbers long.
Json vector_json(const Vector3& v) { return Json::array({v[0], v[1]}); }

Json value_json(const Parameter& parameter, const ParameterValue& value) {
  switch (parameter.kind) {
    case ParameterKind::choice:
      return value.word < 0 ? Json(nullptr) : Json(words_of(parameter).at(at(value.word)));
    case ParameterKind::vector:
      return vector_json(value.vector);
    case ParameterKind::contact_law:
    case ParameterKind::friction_law: {
      if (!value.law) return nullptr;
      Json law = {{"law", value.law->component->description.name}};
      law.update(parameters_json(*value.law));
      return law;
    }
    case ParameterKind::function:
      return value.given ? Json("function of time") : Json(nullptr);
    case ParameterKind::number:
    case ParameterKind::integer:
      break;
  }
  if (value.word >= 0) return words_of(parameter).at(at(value.word));
  return std::isfinite(value.number) ? Json(value.number) : Json(nullptr);
}

Json tree_json(const ParameterTree& tree, const ParameterBlock& block) {
  Json json = Json::object();
  for (const ParameterTree& child : tree.children) {
    Json value = nullptr;
    if (child.leaf != nullptr) {
      const auto found = block.values.find(child.leaf->name);
      if (found != block.values.end()) value = value_json(*child.leaf, found->second);
    }
    if (value.is_null() && !child.children.empty()) {
      value = tree_json(child, block);
      if (value.empty()) value = nullptr;
    }
    if (!value.is_null()) json[child.name] = std::move(value);
  }
  return json;
}

Json frame_json(const Marker& frame) {
  if (frame.angle == 0.0) return vector_json(frame.position);
  return {{"position", vector_json(frame.position)}, {"angle", frame.angle}};
}

/// Frames that a body was given, by the part of their name behind the slash.
Json frames_json(const Model& model, const std::string& body) {
  Json json = Json::object();
  const std::string stem = body + "/";
  for (auto frame = std::ranges::lower_bound(model.frames, stem, {}, &Marker::name);
       frame != model.frames.end() && frame->name.starts_with(stem); ++frame) {
    const std::string name = frame->name.substr(stem.size());
    if (name != "origin" && name != "com") json[name] = frame_json(*frame);
  }
  return json;
}

Json body_json(const Model& model, const Body& body) {
  Json json = {{"mass", body.mass}, {"inertia", body.inertia[8]}, {"com", vector_json(body.com)}};
  if (body.position || body.angle) {
    json["pose"] = Json::object();
    if (body.position) json["pose"]["position"] = vector_json(*body.position);
    if (body.angle) json["pose"]["angle"] = *body.angle;
  }
  if (body.velocity != Vector3{} || body.angular_velocity[2] != 0.0) {
    json["velocity"] = {{"linear", vector_json(body.velocity)}, {"angular", body.angular_velocity[2]}};
  }
  json["frames"] = frames_json(model, body.name);
  return json;
}

Json joint_json(const Model& model, const JointElement& joint) {
  Json json = {{"type", joint.component->description.name}};
  if (joint.gear >= 0) {
    const Gear& gear = model.gears[at(joint.gear)];
    json["of"] = {model.joints[at(gear.first)].name, model.joints[at(gear.second)].name};
    json["ratio"] = gear.ratio;
    json["offset"] = gear.offset ? Json(*gear.offset) : Json("auto");
    return json;
  }
  json["between"] = {model.markers[at(joint.marker_a)].name, model.markers[at(joint.marker_b)].name};
  if (joint.parameters) json.update(parameters_json(*joint.parameters));
  return json;
}

Json driver_json(const Model& model, const Driver& driver) {
  Json json = {{"joint", model.joints[at(driver.joint)].name}, {"kind", driver_kind_word(driver.kind)}};
  if (driver.kinematics >= 0) {
    json["inverse_kinematics"] = model.kinematics[at(driver.kinematics)].name;
    json["elbow"] = driver.elbow;
  } else if (driver.table) {
    json["table"] = true;
  } else {
    json["value"] = driver.text;
  }
  return json;
}

Json force_json(const Model& model, const ForceElement& element) {
  if (element.joint >= 0) return joint_json(model, model.joints[at(element.joint)]);
  const AppliedForce& force = model.forces[at(element.applied)];
  const std::string& marker = model.markers[at(force.marker)].name;
  if (force.kind == ForceKind::torque) {
    return {{"type", "torque"}, {"on", marker.substr(0, marker.find('/'))}, {"value", force.text.at(0)}};
  }
  return {{"type", "force"}, {"at", marker}, {"value", force.text}, {"axes", force.frame_axes ? "frame" : "global"}};
}

Json own_gravity_json(const Model& model, const OwnGravity& own) {
  Json bodies = Json::array();
  for (const BodyId body : own.bodies) bodies.push_back(model.bodies[at(body)].name);
  return {{"type", "gravity"}, {"on", bodies}, {"value", vector_json(own.value)}};
}

Json initial_json(const Model& model) {
  Json joints = Json::object(), speeds = Json::object();
  for (const JointElement& joint : model.joints) {
    if (joint.start_coordinate) joints[joint.name] = joint.start_coordinate->value;
    if (joint.start_speed) speeds[joint.name] = joint.start_speed->value;
  }
  return {{"joints", joints}, {"speeds", speeds}};
}

Json simulation_json(const Settings& settings) {
  Json integrator = nullptr;
  if (settings.integrator_parameters.component != nullptr) {
    integrator = Json{{"type", settings.integrator_parameters.component->description.name}};
    integrator.update(parameters_json(settings.integrator_parameters));
  }
  return {{"start", settings.start},
          {"end", settings.end},
          {"step", settings.step},
          {"integrator", integrator},
          {"interval", settings.interval}};
}

}  // namespace

const char* driver_kind_word(DriverKind kind) {
  constexpr const char* words[] = {"angle", "position", "velocity", "torque", "force"};
  return words[static_cast<int>(kind)];
}

Json parameters_json(const ParameterBlock& block) {
  return tree_json(ParameterTree(block.component->description.parameters), block);
}

Json model_json(const Model& model) {
  Json json = {{"name", model.name},
               {"space", model.space == Space::planar ? "planar" : "spatial"},
               {"gravity", vector_json(model.gravity)},
               {"bodies", Json::object()},
               {"joints", Json::object()},
               {"drivers", Json::object()},
               {"forces", Json::object()}};
  json["ground"] = {{"frames", frames_json(model, "ground")}};
  for (const Body& body : model.bodies) json["bodies"][body.name] = body_json(model, body);
  for (const JointElement& joint : model.joints) {
    if (!joint.is_force) json["joints"][joint.name] = joint_json(model, joint);
  }
  for (const Driver& driver : model.drivers) json["drivers"][driver.name] = driver_json(model, driver);
  for (const ForceElement& force : model.force_elements) {
    const std::string& name =
        force.joint >= 0 ? model.joints[at(force.joint)].name : model.forces[at(force.applied)].name;
    json["forces"][name] = force_json(model, force);
  }
  for (const OwnGravity& own : model.own_gravities) json["forces"][own.name] = own_gravity_json(model, own);
  json["initial"] = initial_json(model);
  json["simulation"] = simulation_json(model.settings);
  return json;
}

}  // namespace freeplay
