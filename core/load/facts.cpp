#include "load/facts.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "model/gear_teeth.h"
#include "system/system.h"

namespace freeplay {
namespace {

const char* space_word(const Model& model) { return model.space == Space::planar ? "planar" : "spatial"; }

/// A count, or null for the -1 of "not computed".
Json count(int value) { return value < 0 ? Json(nullptr) : Json(value); }

std::string line(const std::string& name, int value) {
  return fmt::format("  {:<18}  {}\n", name, value < 0 ? "-" : std::to_string(value));
}

std::string ideal_text(const ConstraintFacts& ideal) {
  const auto number = [](int value) { return value < 0 ? std::string("-") : std::to_string(value); };
  std::string text =
      fmt::format("  {:<18}  constraints {}  rank {}  redundant {}  dof {}  dof_driven {}", "ideal", ideal.constraints,
                  number(ideal.rank), number(ideal.redundant), number(ideal.dof), number(ideal.dof_driven));
  if (ideal.driver_redundant > 0) text += fmt::format("  driver_redundant {}", ideal.driver_redundant);
  return text + "\n";
}

Json ideal_json(const ConstraintFacts& ideal) {
  return {{"constraints", ideal.constraints},      {"rank", count(ideal.rank)},
          {"redundant", count(ideal.redundant)},   {"dof", count(ideal.dof)},
          {"dof_driven", count(ideal.dof_driven)}, {"driver_redundant", count(ideal.driver_redundant)}};
}

}  // namespace

std::string facts_text(const Model& model, const ModelFacts& facts) {
  const ConstraintFacts& actual = facts.actual;
  std::string text = fmt::format("  {:<18}  {}\n", "space", space_word(model));
  text += line("bodies", facts.bodies) + line("joints", facts.joints);
  text += line("clearance_joints", facts.clearance_joints) + line("drivers", facts.drivers);
  text += line("coordinates", facts.coordinates) + line("velocities", facts.velocities);
  text += line("constraints", actual.constraints) + line("driver_constraints", facts.driver_constraints);
  text += line("rank", actual.rank) + line("redundant", actual.redundant);
  text += line("dof", actual.dof) + line("dof_driven", actual.dof_driven);
  if (actual.driver_redundant > 0) text += line("driver_redundant", actual.driver_redundant);
  if (facts.ideal) text += ideal_text(*facts.ideal);
  const auto alone = std::ranges::count_if(
      model.gears, [&](const Gear& one) { return couples_alone(model.joints[static_cast<std::size_t>(one.joint)]); });
  if (alone > 0) {
    text += fmt::format("  {:<18}  {} (the forces of their teeth on the bearings are not modelled)\n", "gears", alone);
  }
  return text;
}

std::string structure_text(const Structure& structure) {
  const auto list = [](const char* name, const std::vector<std::string>& items) {
    return items.empty() ? std::string() : fmt::format("  {:<18}  {}\n", name, fmt::join(items, ", "));
  };
  return list("left_free", structure.left_free) + list("undetermined", structure.undetermined);
}

Json facts_json(const Model& model, const ModelFacts& facts, const Structure& structure) {
  const ConstraintFacts& actual = facts.actual;
  return {{"space", space_word(model)},
          {"bodies", facts.bodies},
          {"joints", facts.joints},
          {"clearance_joints", facts.clearance_joints},
          {"drivers", facts.drivers},
          {"coordinates", facts.coordinates},
          {"velocities", facts.velocities},
          {"constraints", actual.constraints},
          {"driver_constraints", facts.driver_constraints},
          {"rank", count(actual.rank)},
          {"redundant", count(actual.redundant)},
          {"dof", count(actual.dof)},
          {"dof_driven", count(actual.dof_driven)},
          {"driver_redundant", count(actual.driver_redundant)},
          {"ideal", facts.ideal ? ideal_json(*facts.ideal) : Json(nullptr)},
          {"left_free", structure.left_free},
          {"undetermined", structure.undetermined}};
}

std::string moved_text(const Model& model, const StartReport& report) {
  constexpr std::size_t most_lines = 20;
  std::vector<std::string> moved, chosen;
  for (const MovedStart& one : report.moved) moved.push_back(sentence(one));
  for (const ChosenSpeed& one : report.chosen) chosen.push_back(sentence(model, one));
  std::string text;
  for (const auto& [word, lines] : {std::pair("moved", &moved), std::pair("chosen", &chosen)}) {
    for (std::size_t i = 0; i < std::min(lines->size(), most_lines); ++i) {
      text += fmt::format("  {:<18}  {}\n", i == 0 ? word : "", (*lines)[i]);
    }
    if (lines->size() <= most_lines) continue;
    text += fmt::format("  {:<18}  and {} more: validate --json has all\n", "", lines->size() - most_lines);
  }
  return text;
}

std::string start_text(const Model& model, const Start& start) {
  constexpr std::size_t most_names = 5;
  const std::vector<std::string>& bodies = start.structure.left_free;
  const std::string moved = moved_text(model, start.report);
  const auto doubted = [](const StructureDoubt& doubt) { return doubt.id == "left-free"; };
  if (bodies.empty() || model.drivers.empty() || std::ranges::any_of(start.structure.doubts, doubted)) return moved;
  const std::size_t shown = std::min(bodies.size(), most_names);
  std::string names = fmt::format("'{}'", fmt::join(bodies.begin(), bodies.begin() + static_cast<long>(shown), "', '"));
  if (shown < bodies.size()) names += fmt::format(" and {} more", bodies.size() - shown);
  const std::string free = fmt::format(
      "  {:<18}  with all drivers at rest {} still move{}: where that is not meant, a joint or a driver is missing\n",
      "left_free", names, bodies.size() == 1 ? "s" : "");
  return free + moved;
}

Json start_json(const Model& model, const Start& start) {
  Json json = Json::object();
  // Names of bodies differ: none need be looked for before one is added.
  auto& bodies = json.get_ref<Json::object_t&>();
  const System system(model);
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    if (model.space == Space::spatial) {
      const std::span<const double> pose = start.state.q().subspan(7 * i, 7);
      const std::array<double, 4> turn = system.coordinates().frame_quaternion(static_cast<BodyId>(i), start.state.q());
      bodies.emplace_back(model.bodies[i].name, Json{{"x", pose[0]},
                                                     {"y", pose[1]},
                                                     {"z", pose[2]},
                                                     {"qw", turn[0]},
                                                     {"qx", turn[1]},
                                                     {"qy", turn[2]},
                                                     {"qz", turn[3]}});
      continue;
    }
    const std::span<const double> pose = start.state.q().subspan(3 * i, 3);
    bodies.emplace_back(model.bodies[i].name, Json{{"x", pose[0]}, {"y", pose[1]}, {"angle", pose[2]}});
  }
  return json;
}

Json start_changes_json(const Model& model, const StartReport& report) {
  Json moved = Json::array(), chosen = Json::array();
  for (const MovedStart& one : report.moved) {
    const bool of_joint = one.body.empty();
    moved.push_back({{of_joint ? "joint" : "body", of_joint ? one.joint : one.body},
                     {"quantity", one.quantity},
                     {"by", one.by},
                     {"unit", one.unit},
                     {"far", one.far}});
  }
  for (const ChosenSpeed& one : report.chosen) {
    if (one.body >= 0) {
      Json& own = chosen.emplace_back(Json{{"body", model.bodies[static_cast<std::size_t>(one.body)].name}});
      if (one.speed > 0.0) own["speed"] = one.speed;
      if (one.angular_speed > 0.0) own["angular_speed"] = one.angular_speed;
      continue;
    }
    chosen.push_back({{"joint", model.joints[static_cast<std::size_t>(one.joint)].name}, {"speed", one.speed}});
  }
  return {{"moved", std::move(moved)}, {"chosen", std::move(chosen)}};
}

}  // namespace freeplay
