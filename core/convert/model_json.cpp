#include "convert/model_json.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "base/index.h"
#include "base/number_text.h"
#include "base/token.h"
#include "base/unit.h"
#include "format/parameter_tree.h"
#include "model/gear_teeth.h"
#include "model/path_pose.h"

namespace freeplay {
namespace {

/// The unit of a parameter for these values: "kind: N/m | N*m/rad" chosen, "N/m^exponent" with its number.
std::string unit_text(const Parameter& parameter, const ParameterBlock& block) {
  const auto value = [&](const std::string& name) {
    const auto found = block.values.find(name);
    return found == block.values.end() ? ParameterValue{} : found->second;
  };
  std::string text = parameter.unit;
  if (const std::size_t colon = text.find(':'); colon != std::string::npos) {
    const int index = value(text.substr(0, colon)).word;
    std::string_view units = std::string_view(text).substr(colon + 1);
    for (int i = 0; i < index && units.find('|') != std::string_view::npos; ++i)
      units.remove_prefix(units.find('|') + 1);
    units = units.substr(0, units.find('|'));
    const std::size_t first = std::min(units.find_first_not_of(' '), units.size());
    text = std::string(units.substr(first, units.find_last_not_of(' ') + 1 - first));
  }
  for (std::size_t sign = text.find('^'); sign != std::string::npos; sign = text.find('^', sign + 1)) {
    const std::size_t end = word_end(text, sign + 1);
    if (end == sign + 1) continue;
    const ParameterValue power = value(text.substr(sign + 1, end - sign - 1));
    text.replace(sign + 1, end - sign - 1, number_text(std::isfinite(power.number) ? power.number : power.word));
  }
  const Unit unit = parse_unit(text);
  return unit.factor == 1.0 ? text : si_unit(unit.dimension);
}

const char* coordinate_unit(const JointElement& joint) {
  return joint.ideal_layout().coordinate == Coordinate::position ? "m" : "rad";
}

class ModelWriter {
 public:
  ModelWriter(const Model& model, Quantities quantities) : model_(model), quantities_(quantities) {}

  Json model() const {
    Json json = {{"name", model_.name},
                 {"space", model_.space == Space::planar ? "planar" : "spatial"},
                 {"gravity", vector(model_.gravity, "m/s^2")},
                 {"bodies", Json::object()},
                 {"joints", Json::object()},
                 {"drivers", Json::object()},
                 {"paths", Json::object()},
                 {"forces", forces()}};
    json["ground"] = {{"frames", frames("ground")}};
    for (const Body& one : model_.bodies) append(json["bodies"], one.name, body(one));
    for (const JointElement& one : model_.joints) {
      if (!one.is_force) append(json["joints"], one.name, joint(one));
    }
    for (const Driver& one : model_.drivers) append(json["drivers"], one.name, driver(one));
    for (const InverseKinematics& one : model_.kinematics) append(json["paths"], one.name, path(one));
    json["initial"] = initial();
    json["simulation"] = simulation();
    return json;
  }

  Json parameters(const ParameterBlock& block) const {
    return tree(ParameterTree(block.component->description.parameters), block);
  }

 private:
  const std::string& marker(int index) const { return model_.markers[at(index)].name; }

  // --- quantities ------------------------------------------------------------------------------------------------

  Json number(double value, const std::string& unit) const {
    if (quantities_ == Quantities::numbers || unit.empty() || unit == "1") return value;
    return number_text(value) + " " + unit;
  }

  bool in_space() const { return model_.space == Space::spatial; }
  Json list(std::span<const double> numbers, const std::string& unit) const {
    if (quantities_ == Quantities::numbers) return std::vector<double>(numbers.begin(), numbers.end());
    std::string text;
    for (const double x : numbers) text += (text.empty() ? "(" : ", ") + number_text(x);
    return unit.empty() ? text + ")" : text + ") " + unit;
  }
  /// Vectors of planar models are two numbers long.
  Json vector(const Vector3& v, const std::string& unit) const {
    return list(std::span(v).first(in_space() ? 3 : 2), unit);
  }
  /// w, x, y, z.
  Json quaternion(const Rotation& rotation) const {
    const Eigen::Quaterniond q(
        Eigen::Matrix3d(Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rotation.data())));
    const double numbers[] = {q.w(), q.x(), q.y(), q.z()};
    return list(numbers, "");
  }
  Json inertia(const Body& one) const {
    const auto& i = one.inertia;
    if (!in_space()) return number(i[8], "kg*m^2");
    const double all[] = {i[0], i[4], i[8], i[1], i[2], i[5]};
    return list(std::span(all).first(i[1] == 0.0 && i[2] == 0.0 && i[5] == 0.0 ? 3 : 6), "kg*m^2");
  }

  std::string unit(const Parameter& parameter, const ParameterBlock& block) const {
    return quantities_ == Quantities::numbers ? std::string() : unit_text(parameter, block);
  }

  // --- parameters ------------------------------------------------------------------------------------------------

  Json value(const Parameter& parameter, const ParameterValue& value, const ParameterBlock& block) const {
    switch (parameter.kind) {
      case ParameterKind::choice:
        return value.word < 0 ? Json(nullptr) : Json(words_of(parameter).at(at(value.word)));
      case ParameterKind::vector:
        return vector(value.vector, unit(parameter, block));
      case ParameterKind::contact_law:
      case ParameterKind::friction_law: {
        if (!value.law) return nullptr;
        Json law = {{"law", value.law->component->description.name}};
        law.update(parameters(*value.law));
        return law;
      }
      case ParameterKind::function:
        if (value.by_motion) return "function of the motion";
        return value.given ? Json("function of time") : Json(nullptr);
      case ParameterKind::formula:
        return value.given ? Json("formula") : Json(nullptr);
      case ParameterKind::list:
        return value.points ? list(value.points->y, unit(parameter, block)) : Json(nullptr);
      case ParameterKind::table:
        return value.points ? points(parameter, *value.points, block) : Json(nullptr);
      case ParameterKind::number:
      case ParameterKind::integer:
        break;
    }
    if (value.word >= 0) return words_of(parameter).at(at(value.word));
    if (value.by_motion) return "function of the motion";
    return std::isfinite(value.number) ? number(value.number, unit(parameter, block)) : Json(nullptr);
  }

  Json points(const Parameter& parameter, const ParameterPoints& all, const ParameterBlock& block) const {
    Parameter of_x = parameter;
    const std::string x_unit = variables_of(parameter).front().unit;
    of_x.unit = x_unit.c_str();
    const std::string of_first = unit(of_x, block), of_second = unit(parameter, block);
    Json json = Json::array();
    for (std::size_t i = 0; i < all.x.size(); ++i)
      json.push_back({number(all.x[i], of_first), number(all.y[i], of_second)});
    return json;
  }

  Json tree(const ParameterTree& tree_, const ParameterBlock& block) const {
    Json json = Json::object();
    for (const ParameterTree& child : tree_.children) {
      Json entry = nullptr;
      if (child.leaf != nullptr) {
        const auto found = block.values.find(child.leaf->name);
        if (found != block.values.end()) entry = value(*child.leaf, found->second, block);
      }
      if (entry.is_null() && !child.children.empty()) {
        entry = tree(child, block);
        if (entry.empty()) entry = nullptr;
      }
      if (!entry.is_null()) json[child.name] = std::move(entry);
    }
    return json;
  }

  // --- sections --------------------------------------------------------------------------------------------------

  Json frame(const Marker& one) const {
    if (in_space() && one.rotation != no_rotation) {
      return {{"position", vector(one.position, "m")}, {"quaternion", quaternion(one.rotation)}};
    }
    if (one.angle == 0.0) return vector(one.position, "m");
    return {{"position", vector(one.position, "m")}, {"angle", number(one.angle, "rad")}};
  }

  /// Frames that a body was given, by the part of their name after the slash.
  Json frames(const std::string& body) const {
    Json json = Json::object();
    const std::string stem = body + "/";
    for (auto one = std::ranges::lower_bound(model_.frames, stem, {}, &Marker::name);
         one != model_.frames.end() && one->name.starts_with(stem); ++one) {
      const std::string name = one->name.substr(stem.size());
      if (name != "origin" && name != "com") json[name] = frame(*one);
    }
    return json;
  }

  Json body(const Body& one) const {
    Json json = {{"mass", number(one.mass, "kg")}, {"inertia", inertia(one)}, {"com", vector(one.com, "m")}};
    if (one.position || one.angle || one.rotation) {
      json["pose"] = Json::object();
      if (one.position) json["pose"]["position"] = vector(*one.position, "m");
      if (one.angle) json["pose"]["angle"] = number(*one.angle, "rad");
      if (one.rotation) json["pose"]["quaternion"] = quaternion(*one.rotation);
    }
    if (one.velocity != Vector3{} || one.angular_velocity != Vector3{}) {
      const Vector3& w = one.angular_velocity;
      json["velocity"] = {{"linear", vector(one.velocity, "m/s")},
                          {"angular", in_space() ? vector(w, "rad/s") : number(w[2], "rad/s")}};
    }
    json["frames"] = frames(one.name);
    return json;
  }

  Json joint(const JointElement& one) const {
    Json json = {{"type", one.gear >= 0 ? "gear" : one.component->description.name}};
    if (one.gear >= 0) {
      const Gear& gear = model_.gears[at(one.gear)];
      const JointElement &first = model_.joints[at(gear.first)], &second = model_.joints[at(gear.second)];
      const std::string unit = coordinate_unit(second), input = coordinate_unit(first);
      json["of"] = {first.name, second.name};
      json["ratio"] = number(gear.ratio, unit == input ? "1" : unit + "/" + input);
      json["offset"] = gear.offset ? number(*gear.offset, unit) : Json("auto");
      if (!one.has_play) {
        if (has_teeth(one)) json[pressure_angle_word] = number(pressure_angle(one), "rad");
        return json;
      }
      const char* const block = one.component->description.block;
      Json own = parameters(*one.parameters);
      for (const char* key : {"first_radius", "middle"}) own[block].erase(key);  // of the gear
      for (const char* key : {block, "pressure_angle"}) {
        if (own.contains(key)) json[key] = own[key];
      }
      return json;
    }
    json["between"] = {marker(one.marker_a), marker(one.marker_b)};
    if (one.axis) json["axis"] = vector(*one.axis, "");
    if (one.parameters) json.update(parameters(*one.parameters));
    return json;
  }

  Json driver(const Driver& one) const {
    Json json = {{"joint", model_.joints[at(one.joint)].name}, {"kind", driver_kind_word(one.kind)}};
    if (one.kinematics >= 0) {
      json["inverse_kinematics"] = model_.kinematics[at(one.kinematics)].name;
      json["elbow"] = one.elbow;
    } else if (one.table) {
      json["table"] = table(one);
    } else {
      json[one.input ? "input" : "value"] = one.text;
    }
    return json;
  }

  /// Points are in SI; a file stays what it is, with the units of its columns.
  Json table(const Driver& one) const {
    const TableSource& source = one.table_source;
    if (!source.file.empty()) return file(source, effort_unit(one));
    const char* unit = effort_unit(one);
    Json json = {{"points", Json::array()}};
    for (std::size_t i = 0; i < one.table->times().size(); ++i) {
      json["points"].push_back({number(one.table->times()[i], "s"), number(one.table->values()[i], unit)});
    }
    json.update(smoothing(source));
    return json;
  }

  static Json file(const TableSource& source, const char* unit) {
    Json json = {{"file", source.file}};
    if (!source.time.empty()) json["time"] = source.time;
    if (!source.value.empty()) json["value"] = source.value;
    json["time_unit"] = source.time_unit.empty() ? "s" : source.time_unit;
    json["unit"] = source.unit.empty() ? unit : source.unit;
    json.update(smoothing(source));
    return json;
  }

  static Json smoothing(const TableSource& source) {
    constexpr const char* interpolations[] = {"cubic", "linear"};
    constexpr const char* ends[] = {"natural", "clamped", "periodic"};
    constexpr const char* outside[] = {"hold", "repeat", "error"};
    return {{"interpolation", interpolations[static_cast<int>(source.interpolation)]},
            {"ends", ends[static_cast<int>(source.ends)]},
            {"outside", outside[static_cast<int>(source.outside)]}};
  }

  const char* effort_unit(const Driver& one) const {
    constexpr const char* units[] = {"rad", "m", "", "N*m", "N"};
    if (one.kind != DriverKind::velocity) return units[static_cast<int>(one.kind)];
    return model_.joints[at(one.joint)].ideal_layout().coordinate == Coordinate::position ? "m/s" : "rad/s";
  }

  Json path(const InverseKinematics& one) const {
    const std::span<const char* const> keys = path_words(model_.space);
    Json path = Json::object();
    if (!one.path.source.file.empty()) {
      path = file(one.path.source, "m");
      if (!in_space()) path["angle_unit"] = one.path.angle_unit.empty() ? "rad" : one.path.angle_unit;
    }
    for (std::size_t i = 0; i < keys.size(); ++i) {
      if (one.path.functions[i]) path[keys[i]] = one.path.text[i];
    }
    return {{"frame", marker(one.marker)}, {"path", path}};
  }

  Json force(const ForceElement& element) const {
    if (element.joint >= 0) return joint(model_.joints[at(element.joint)]);
    const AppliedForce& force = model_.forces[at(element.applied)];
    const std::string& place = marker(force.marker);
    if (force.kind == ForceKind::torque) {
      return {{"type", "torque"},
              {"on", place.substr(0, place.find('/'))},
              {"value", in_space() ? Json(force.text) : Json(force.text.at(0))}};
    }
    return {{"type", "force"}, {"at", place}, {"value", force.text}, {"axes", force.frame_axes ? "frame" : "global"}};
  }

  Json own_gravity(const OwnGravity& own) const {
    Json bodies = Json::array();
    for (const BodyId body : own.bodies) bodies.push_back(model_.bodies[at(body)].name);
    return {{"type", "gravity"}, {"on", bodies}, {"value", vector(own.value, "m/s^2")}};
  }

  /// In declaration order.
  Json forces() const {
    Json json = Json::object();
    auto own = model_.own_gravities.begin();
    for (std::size_t i = 0; i <= model_.force_elements.size(); ++i) {
      for (; own != model_.own_gravities.end() && own->place == i; ++own) append(json, own->name, own_gravity(*own));
      if (i == model_.force_elements.size()) break;
      const ForceElement& element = model_.force_elements[i];
      const std::string& name =
          element.joint >= 0 ? model_.joints[at(element.joint)].name : model_.forces[at(element.applied)].name;
      append(json, name, force(element));
    }
    return json;
  }

  Json initial() const {
    Json joints = Json::object(), speeds = Json::object();
    for (const JointElement& one : model_.joints) {
      const std::string unit = coordinate_unit(one);
      if (one.start_coordinate) append(joints, one.name, number(one.start_coordinate->value, unit));
      if (one.start_speed) append(speeds, one.name, number(one.start_speed->value, unit + "/s"));
    }
    return {
        {"joints", joints},
        {"speeds", speeds},
        {"assembly",
         {{"tolerance", model_.settings.assembly_tolerance}, {"max_iterations", model_.settings.assembly_iterations}}}};
  }

  Json simulation() const {
    const Settings& settings = model_.settings;
    Json json = {{"start", number(settings.start, "s")}, {"end", number(settings.end, "s")}};
    if (settings.accuracy > 0.0) {
      json["accuracy"] = number(settings.accuracy, "m");
    } else {
      json["step"] = settings.adaptive ? adaptive_step() : number(settings.step, "s");
    }
    json["integrator"] = nullptr;
    if (settings.integrator_parameters.component != nullptr) {
      json["integrator"] = Json{{"type", settings.integrator_parameters.component->description.name}};
      json["integrator"].update(parameters(settings.integrator_parameters));
    }
    Json frames = Json::array();
    for (const int frame : settings.frames) frames.push_back(marker(frame));
    Json columns = Json::object();
    for (const OutputColumn& one : settings.columns) columns[one.name.substr(one.name.find('.') + 1)] = one.text;
    json["output"] = {{"interval", number(settings.interval, "s")},
                      {"channels", settings.channels},
                      {"columns", columns},
                      {"frames", frames},
                      {"format", result_formats[static_cast<std::size_t>(settings.format)]},
                      {"rows_in_contact", settings.rows_in_contact},
                      {"discard", number(settings.discard, "s")}};
    json["stop"] = Json::array();
    for (const StopCondition& one : settings.stop) json["stop"].push_back(condition(one));
    return json;
  }

  Json adaptive_step() const {
    const Settings& settings = model_.settings;
    return {{"size", number(settings.step, "s")},        {"adaptive", true},
            {"tolerance", settings.tolerance},           {"min", number(settings.smallest_step, "s")},
            {"max", number(settings.largest_step, "s")}, {"per_contact", settings.per_contact}};
  }

  /// The limit has the unit of the channel; it is written where the file writes it.
  Json condition(const StopCondition& one) const {
    const bool dimensioned = one.quantity.kind == DimensionKind::dimensioned;
    const std::string unit = dimensioned ? si_unit(one.quantity.dimension) : "1";
    return {{"channel", one.channel},
            {one.above ? "above" : "below", number(one.limit, unit)},
            {"after", number(one.after, "s")}};
  }

  const Model& model_;
  Quantities quantities_;
};

}  // namespace

const char* driver_kind_word(DriverKind kind) {
  constexpr const char* words[] = {"angle", "position", "velocity", "torque", "force"};
  return words[static_cast<int>(kind)];
}

Json model_json(const Model& model, Quantities quantities) { return ModelWriter(model, quantities).model(); }

}  // namespace freeplay
