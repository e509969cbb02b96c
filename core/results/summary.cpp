#include "results/summary.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "base/sha256.h"
#include "base/version.h"
#include "component/joint_roles.h"
#include "results/memory_json.h"
#include "run/figure_noise.h"

namespace freeplay {
namespace {

const char* word(Space space) { return space == Space::planar ? "planar" : "spatial"; }

const char* word(DriverKind kind) {
  switch (kind) {
    case DriverKind::angle:
      return "angle";
    case DriverKind::position:
      return "position";
    case DriverKind::velocity:
      return "velocity";
    case DriverKind::torque:
      return "torque";
    case DriverKind::force:
      break;
  }
  return "force";
}

/// A count, or null for the -1 of "not computed".
Json count(int value) { return value < 0 ? Json(nullptr) : Json(value); }

Json model_part(const Model& model, const ModelFacts& facts) {
  return {{"name", model.name},
          {"file", model.file},
          {"sha256", sha256(model.text)},
          {"space", word(model.space)},
          {"bodies", facts.bodies},
          {"joints", facts.joints},
          {"clearance_joints", facts.clearance_joints},
          {"drivers", facts.drivers},
          {"dof", count(facts.actual.dof)},
          {"dof_driven", count(facts.actual.dof_driven)},
          {"redundant", count(facts.actual.redundant)}};
}

/// The word of a choice: words are separated by '|'.
std::string choice(const char* words, int index) {
  std::string_view rest = words;
  for (int i = 0; i < index && !rest.empty(); ++i) rest.remove_prefix(std::min(rest.find('|'), rest.size() - 1) + 1);
  return std::string(rest.substr(0, rest.find('|')));
}

Json points_json(const ParameterPoints& points) {
  if (points.x.empty()) return points.y;
  Json all = Json::array();
  for (std::size_t i = 0; i < points.x.size(); ++i) all.push_back({points.x[i], points.y[i]});
  return all;
}

Json parameter_value(const Parameter& parameter, const ParameterValue& value) {
  if (value.word >= 0 && parameter.choices != nullptr) return choice(parameter.choices, value.word);
  if (parameter.kind == ParameterKind::vector) return value.vector;
  if (value.points) return points_json(*value.points);
  if (parameter.kind == ParameterKind::integer && std::isfinite(value.number)) return std::lround(value.number);
  return json_number(value.number);
}

Json integrator_part(const ParameterBlock& block) {
  Json part = {{"type", block.component->description.name}};
  for (const Parameter& parameter : block.component->description.parameters) {
    const auto value = block.values.find(parameter.name);
    if (value == block.values.end()) continue;
    Json* at = &part;  // the name is a path
    std::string_view path = parameter.name;
    for (std::size_t dot = path.find('.'); dot != std::string_view::npos; dot = path.find('.')) {
      at = &(*at)[std::string(path.substr(0, dot))];
      path.remove_prefix(dot + 1);
    }
    (*at)[std::string(path)] = parameter_value(parameter, value->second);
  }
  return part;
}

Json step_part(const Settings& settings) {
  Json part = {{"size", settings.step}, {"adaptive", settings.adaptive}};
  if (!settings.adaptive) return part;
  if (settings.accuracy > 0.0) part["accuracy"] = settings.accuracy;
  if (!(settings.accuracy > 0.0)) part["tolerance"] = settings.tolerance;
  part["min"] = settings.smallest_step;
  part["max"] = settings.largest_step;
  part["per_contact"] = settings.per_contact;
  return part;
}

Json counts_part(const Outcome& outcome, const Statistics& statistics) {
  return {{"rows", outcome.rows},
          {"steps", outcome.steps},
          {"rejected", outcome.rejected},
          {"iterations", outcome.iterations},
          {"factorizations", outcome.factorizations},
          {"contacts", statistics.contacts()},
          {"contacts_total", statistics.contacts_total()}};
}

/// Nine digits of a step: the difference of two times has no more.
double rounded_step(double dt) {
  const std::string text = fmt::format("{:.9g}", dt);
  std::from_chars(text.data(), text.data() + text.size(), dt);
  return dt;
}

Json time_part(const Outcome& outcome) {
  const auto step = [&](double dt) { return outcome.steps > 0 ? Json(rounded_step(dt)) : Json(nullptr); };
  return {{"reached", outcome.time},
          {"smallest_step", step(outcome.smallest_step)},
          {"largest_step", step(outcome.largest_step)}};
}

/// Null where the run ended before statistics began.
Json residuals_part(const RunRecord& record) {
  const bool any = record.statistics.any();
  const auto value = [&](double residual) { return any ? json_number(residual) : Json(nullptr); };
  return {{"position_max", value(record.statistics.position_residual())},
          {"velocity_max", value(record.statistics.velocity_residual())},
          {"energy_max", value(record.statistics.energy_residual())}};
}

Json bodies_part(const RunRecord& record) {
  Json part = Json::object();
  for (std::size_t i = 0; i < record.model.bodies.size(); ++i) {
    constexpr const char* in_plane[] = {"x", "y", "angle"};
    constexpr const char* in_space[] = {"x", "y", "z", "qw", "qx", "qy", "qz"};
    const bool planar = record.model.space == Space::planar;
    const auto names = planar ? std::span<const char* const>(in_plane) : std::span<const char* const>(in_space);
    const std::size_t first = static_cast<std::size_t>(record.channels.bodies[i]);
    Json& body = append(part, record.model.bodies[i].name, Json::object());
    for (std::size_t k = 0; k < names.size(); ++k) body[names[k]] = json_number(record.last_row[first + k]);
    body["max_speed"] = json_number(record.statistics.body_max_speed(static_cast<int>(i)));
  }
  return part;
}

/// Null for a joint without a normal force, numbers null where nothing was counted.
Json play_part(const RunRecord& record, int joint) {
  if (!record.clearances.has(joint)) return nullptr;
  const PlayFigures seen = record.clearances.figures(joint);
  return {{"flight", json_number(seen.flight)},
          {"impact", json_number(seen.impact)},
          {"lasting", json_number(seen.lasting)},
          {"impacts", seen.impacts},
          {"max_approach_speed", json_number(seen.max_approach_speed)},
          {"max_impulse", json_number(seen.max_impulse)},
          {"mean_fn", json_number(seen.mean_normal_force)},
          {"load_angle", json_number(seen.load_angle)},
          {"load_concentration", json_number(seen.load_concentration)},
          {"load_elevation", json_number(seen.load_elevation)},
          {"sliding", json_number(seen.sliding)},
          {"work", json_number(seen.work)},
          {"pv_mean", json_number(seen.pv_mean)},
          {"pv_max", json_number(seen.pv_max)},
          {"carried_in", json_number(seen.carried_in)},
          {"carried_out", json_number(seen.carried_out)}};
}

/// Null for a joint without play; what the file leaves open is null, too.
Json clearance_part(const JointLayout& layout) {
  if (!(layout.clearance > 0.0)) return nullptr;
  if (plays_between_walls(layout)) return {{"gap", layout.clearance}, {"length", json_number(layout.contact_length)}};
  return {{"radial_clearance", layout.clearance},
          {"bearing_radius", json_number(layout.smaller_radius + layout.clearance)},
          {"journal_radius", json_number(layout.smaller_radius)},
          {"length", json_number(layout.contact_length)}};
}

/// What contacts of a joint, or of an element among the forces, did: null where it has none; -1 stands for no joint.
void append_contacts(const RunRecord& record, int joint, Json& entry) {
  const bool touches = joint >= 0 && has_contact_statistics(record.channels.joints[static_cast<std::size_t>(joint)]);
  const JointStatistics seen = touches ? record.statistics.joint(joint) : JointStatistics{};
  const auto contact = [&](double value) { return touches ? json_number(value) : Json(nullptr); };
  entry["max_fn"] = contact(seen.max_normal_force);
  entry["max_delta"] = contact(seen.max_penetration);
  entry["max_eccentricity"] = contact(seen.max_eccentricity);
  entry["contacts"] = touches && record.statistics.any() ? Json(seen.contacts) : Json(nullptr);
  entry["contact_fraction"] = contact(seen.contact_fraction);
  entry["dissipated"] = contact(seen.dissipated);
}

Json joints_part(const RunRecord& record) {
  Json part = Json::object();
  for (std::size_t i = 0; i < record.model.joints.size(); ++i) {
    const JointElement& joint = record.model.joints[i];
    if (joint.is_force) continue;
    const JointStatistics seen = record.statistics.joint(static_cast<int>(i));
    Json& entry = append(part, joint.name,
                         {{"type", joint.component->description.name},
                          {"max_force", json_number(seen.max_force)},
                          {"max_torque", json_number(seen.max_torque)},
                          {"rms_force", json_number(seen.rms_force)}});
    append_contacts(record, static_cast<int>(i), entry);
    entry["clearance"] = clearance_part(joint.layout);
    entry["play"] = play_part(record, static_cast<int>(i));
  }
  return part;
}

Json forces_part(const RunRecord& record) {
  Json part = Json::object();
  for (std::size_t i = 0; i < record.model.force_elements.size(); ++i) {
    const ForceStatistics seen = record.statistics.force(static_cast<int>(i));
    const ForceWords words = force_words(record.model, static_cast<int>(i));
    Json& entry = append(part, words.name,
                         {{"type", words.type},
                          {"max_force", json_number(seen.max_force)},
                          {"max_torque", json_number(seen.max_torque)},
                          {"work", json_number(seen.work)}});
    const int joint = record.model.force_elements[i].joint;
    append_contacts(record, joint, entry);
    entry["play"] = joint >= 0 ? play_part(record, joint) : Json(nullptr);
  }
  return part;
}

Json drivers_part(const RunRecord& record) {
  Json part = Json::object();
  for (std::size_t i = 0; i < record.model.drivers.size(); ++i) {
    const Driver& driver = record.model.drivers[i];
    const DriverStatistics seen = record.statistics.driver(static_cast<int>(i));
    append(part, driver.name,
           {{"kind", word(driver.kind)},
            {"max_abs", json_number(seen.max_abs)},
            {"rms", json_number(seen.rms)},
            {"work", json_number(seen.work)}});
  }
  return part;
}

Json paths_part(const RunRecord& record) {
  Json part = Json::object();
  for (std::size_t i = 0; i < record.model.kinematics.size(); ++i) {
    const PathStatistics seen = record.statistics.path(static_cast<int>(i));
    part[record.model.kinematics[i].name] = {{"max_position", json_number(seen.max_position)},
                                             {"rms_position", json_number(seen.rms_position)},
                                             {"max_angle", json_number(seen.max_angle)},
                                             {"rms_angle", json_number(seen.rms_angle)}};
  }
  return part;
}

Json energy_part(const EnergyColumns& columns, std::span<const double> row) {
  const auto value = [&](int column) { return json_number(row[static_cast<std::size_t>(column)]); };
  return {{"kinetic", value(columns.kinetic)},
          {"potential", value(columns.potential)},
          {"dissipated", value(columns.dissipated)},
          {"work", value(columns.work)},
          {"residual", value(columns.residual)}};
}

Json advice_part(const ContactAdvice& advice) {
  return {{"under_resolved", advice.under_resolved()},
          {"min_steps_per_contact", json_number(advice.fewest_steps())},
          {"step", json_number(advice.step())}};
}

Json verify_part(const RunRecord& record) {
  if (record.verify.empty()) return nullptr;
  Json part = Json::object();
  for (const auto& [channel, error] : record.verify) append(part, channel, json_number(error));
  return part;
}

Json trust_part(const Verdict& trust) {
  Json reasons = Json::array();
  for (const TrustReason& reason : trust.reasons()) {
    reasons.push_back({{"id", reason.id},
                       {"level", word(reason.level)},
                       {"message", reason.message},
                       {"element", reason.element.empty() ? Json(nullptr) : Json(reason.element)},
                       {"value", json_number(reason.value)},
                       {"limit", json_number(reason.limit)}});
  }
  return {{"verdict", word(trust.level())}, {"reasons", std::move(reasons)}};
}

/// The window of the statistics, and the largest values before it: null where nothing was left out.
Json statistics_part(const RunRecord& record) {
  const StatisticsWindow window = record.statistics.window();
  const auto largest = record.statistics.largest().before();
  const PeakValues& peaks = record.statistics.largest().places();
  const auto value = [&](std::size_t i) { return json_number(largest[i]); };
  Json joints = Json::object(), drivers = Json::object();
  for (std::size_t j = 0; j < record.model.joints.size(); ++j) {
    const JointElement& joint = record.model.joints[j];
    if (!joint.is_force) append(joints, joint.name, {{"max_force", value(peaks.force(static_cast<int>(j)))}});
  }
  for (std::size_t d = 0; d < record.model.drivers.size(); ++d) {
    append(drivers, record.model.drivers[d].name, {{"max_abs", value(peaks.effort(static_cast<int>(d)))}});
  }
  Json before = {{"joints", std::move(joints)}, {"drivers", std::move(drivers)}};
  const bool any = record.statistics.any(), left_out = record.model.settings.discard > 0.0;
  return {{"from", window.from},
          {"to", any ? Json(window.to) : Json(nullptr)},
          {"before", left_out ? std::move(before) : Json(nullptr)}};
}

/// By how much figures may differ in another run; null where nothing can touch and no differences grow.
Json noise_part(const RunRecord& record) {
  const PeakNoise& noise = record.statistics.largest().noise();
  if (!noise.active() && !noise.differences_grew()) return nullptr;
  const PeakValues& peaks = record.statistics.largest().places();
  const auto value = [&](std::size_t i) { return json_number(noise.of(i)); };
  const Model& model = record.model;
  Json joints = Json::object(), drivers = Json::object(), forces = Json::object(), paths = Json::object();
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    const JointElement& joint = model.joints[static_cast<std::size_t>(j)];
    if (joint.is_force) continue;
    const FigureNoise::OfJoint of = FigureNoise(record.statistics).joint(j);
    append(joints, joint.name,
           {{"max_force", value(peaks.force(j))},
            {"max_torque", value(peaks.torque(j))},
            {"max_fn", value(peaks.normal_force(j))},
            {"max_delta", value(peaks.penetration(j))},
            {"max_eccentricity", value(peaks.eccentricity(j))},
            {"rms_force", json_number(of.rms_force)},
            {"contacts", json_number(of.contacts)},
            {"contact_fraction", json_number(of.contact_fraction)}});
  }
  for (int d = 0; d < static_cast<int>(model.drivers.size()); ++d) {
    append(
        drivers, model.drivers[static_cast<std::size_t>(d)].name,
        {{"max_abs", value(peaks.effort(d))}, {"rms", json_number(FigureNoise(record.statistics).rms_of_driver(d))}});
  }
  for (int f = 0; f < static_cast<int>(model.force_elements.size()); ++f) {
    append(forces, force_words(model, f).name,
           {{"max_force", value(peaks.applied_force(f))}, {"max_torque", value(peaks.applied_torque(f))}});
  }
  for (int p = 0; p < static_cast<int>(model.kinematics.size()); ++p) {
    const FigureNoise::OfPath of = FigureNoise(record.statistics).path(p);
    append(paths, model.kinematics[static_cast<std::size_t>(p)].name,
           {{"max_position", value(peaks.position_error(p))},
            {"max_angle", value(peaks.angle_error(p))},
            {"rms_position", json_number(of.rms_position)},
            {"rms_angle", json_number(of.rms_angle)}});
  }
  return {{"growing_impacts", noise.growing_impacts()},
          {"joints", std::move(joints)},
          {"drivers", std::move(drivers)},
          {"forces", std::move(forces)},
          {"paths", std::move(paths)}};
}

Json performance_part(const Outcome& outcome) {
  const double rate = outcome.wall_seconds > 0.0 ? static_cast<double>(outcome.steps) / outcome.wall_seconds : 0.0;
  return {{"wall_seconds", outcome.wall_seconds}, {"steps_per_second", rate}};
}

}  // namespace

const char* status_word(RunStatus status) {
  switch (status) {
    case RunStatus::completed:
      return "completed";
    case RunStatus::stopped:
      return "stopped";
    case RunStatus::failed:
      return "failed";
    case RunStatus::interrupted:
      break;
  }
  return "interrupted";
}

ForceWords force_words(const Model& model, int index) {
  const ForceElement& element = model.force_elements[static_cast<std::size_t>(index)];
  if (element.joint >= 0) {
    const JointElement& joint = model.joints[static_cast<std::size_t>(element.joint)];
    return {joint.name, joint.component->description.name};
  }
  const AppliedForce& force = model.forces[static_cast<std::size_t>(element.applied)];
  return {force.name, force.kind == ForceKind::force ? "force" : "torque"};
}

bool has_contact_statistics(const JointColumns& columns) {
  return columns.normal_force >= 0 && columns.penetration >= 0 && columns.contact >= 0;
}

Json settings_json(const Model& model) {
  const Settings& settings = model.settings;
  Json set = Json::object();
  for (const auto& [name, text] : model.overrides) set[name] = text;
  return {{"start", settings.start},
          {"end", settings.end},
          {"integrator", integrator_part(settings.integrator_parameters)},
          {"step", step_part(settings)},
          {"interval", settings.interval},
          {"discard", settings.discard},
          {"set", set},
          {"ideal", model.ideal}};
}

Json summary(const RunRecord& record) {
  const Outcome& outcome = record.outcome;
  return {{"freeplay", {{"version", program_version}, {"schema", schema_version}}},
          {"model", model_part(record.model, record.facts)},
          {"settings", settings_json(record.model)},
          {"status", status_word(outcome.status)},
          {"stop_reason", outcome.reason.empty() ? Json(nullptr) : Json(outcome.reason)},
          {"exit_code", outcome.exit_code},
          {"time", time_part(outcome)},
          {"counts", counts_part(outcome, record.statistics)},
          {"statistics", statistics_part(record)},
          {"residuals", residuals_part(record)},
          {"bodies", bodies_part(record)},
          {"joints", joints_part(record)},
          {"drivers", drivers_part(record)},
          {"forces", forces_part(record)},
          {"paths", paths_part(record)},
          {"memory", memory_json(record.model, record.memory)},
          {"energy", energy_part(record.channels.energy, record.last_row)},
          {"advice", advice_part(record.advice)},
          {"verify", verify_part(record)},
          {"agree_until", json_number(record.agree_until)},
          {"verification", record.verification},
          {"trust", trust_part(record.trust)},
          {"noise", noise_part(record)},
          {"repeat", record.repeat},
          {"hashes", record.hashes},
          {"provenance", record.provenance},
          {"twin", record.twin},
          {"performance", performance_part(outcome)},
          {"files", record.files},
          {"warnings", record.warnings}};
}

}  // namespace freeplay
