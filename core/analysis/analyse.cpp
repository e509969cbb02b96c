#include "analysis/analyse.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/clearance_error.h"
#include "analysis/rows.h"
#include "analysis/workspace.h"
#include "base/index.h"
#include "component/joint_roles.h"

namespace freeplay {
namespace {

AnalysisTable workspace(IdealMechanism& mechanism, const AnalysisRequest& request, const RequestedStations& stations,
                        const Tick& tick, const TickOf& tick_of) {
  AnalysisTable table = workspace_rows(mechanism, stations.all(), stations.given(), request.threads, tick);
  if (stations.grid() == nullptr) return table;
  const PoseForm& form = mechanism.form();
  const std::vector<std::size_t> lengths = lengths_of_grid(form, *stations.grid(), stations.given());
  if (lengths.empty()) return table;
  const WorkspaceShape shape = workspace_shape(mechanism, stations.all(), *stations.grid(), lengths,
                                               tick_of("edges searched", stations.all().size()));
  table.summary[lengths.size() == 2 ? "area" : "volume"] = shape.size;
  table.summary["regions"] = shape.regions;
  table.summary["holes"] = shape.holes;
  for (std::size_t i = 0; i < shape.bounds.size(); ++i) table.summary["bounds"][form.words[i]] = shape.bounds[i];
  if (lengths.size() == 2) table.summary["boundary"] = shape.boundary;
  return table;
}

/// The walls of a slider in space bound its shifts and turns together: unless it says how, its play is not known.
void refuse_unknown_sliders(const Model& model) {
  for (const JointElement& joint : model.joints) {
    if (model.space == Space::planar || !joint.has_play || !plays_between_walls(joint.layout)) continue;
    if (!joint.layout.play_bounds.empty()) continue;
    throw Error(Error::Category::input, "type-space",
                fmt::format("joint '{}' is a slider in space that does not declare the bounds of its play, so that its "
                            "errors are not known",
                            joint.name),
                joint.location, "--ideal closes it");
  }
}

AnalysisTable rows(IdealMechanism& mechanism, const AnalysisRequest& request, const RequestedStations& stations,
                   std::vector<std::string>& warnings, const TickOf& tick_of) {
  const std::vector<Station>& all = stations.all();
  const Tick tick = tick_of("poses analysed", all.size());
  switch (request.kind) {
    case AnalysisKind::inverse_kinematics:
      return ik_rows(mechanism, all, stations.branches(), tick);
    case AnalysisKind::workspace:
      return workspace(mechanism, request, stations, tick, tick_of);
    case AnalysisKind::singularity:
      return singularity_rows(mechanism, all, stations.given(), request.threads, tick);
    case AnalysisKind::error:
      refuse_unknown_sliders(mechanism.model());
      if (mechanism.plays().empty() && mechanism.input_error() == 0.0) {
        warnings.push_back("no joint has clearance and no input errs: all errors are 0");
      }
      return error_rows(mechanism, all, request.error, request.threads, warnings, tick);
    case AnalysisKind::inverse_dynamics:
      break;
  }
  return inverse_dynamics_rows(mechanism, all, request.preload, tick);
}

/// What adds up to the worst position error, where one pose was asked for.
Json causes(const IdealMechanism& mechanism, const Station& station) {
  PostureSolver solver(mechanism);
  VelocityMapper mapper(mechanism, mechanism.form().all());
  VelocityMap map;
  mapper.map(solver.evaluate(station.demand.t, station.posture, term_position), map);
  const auto error = clearance_error(mechanism, map);
  if (!error) return nullptr;
  const Eigen::VectorXd& worst = error->exact.worst;
  Json shares = Json::object();
  std::size_t k = 0;
  for (const Play& play : mechanism.plays()) {
    shares[play_name(mechanism, play)] = json_number(play.radius * error->sensitivity[k++]);
  }
  for (const int j : mechanism.platform().inputs) {
    const double share = mechanism.input_error() * error->sensitivity[k++];
    if (share > 0.0) shares["driver." + mechanism.model().joints[at(j)].name] = json_number(share);
  }
  Json displacement = Json::array();
  for (const double change : worst) displacement.push_back(json_number(change));
  // An angle in the plane, a unit vector in space.
  Json direction = json_number(std::atan2(worst[1], worst[0]));
  if (mechanism.form().lengths == 3) {
    direction = Json::array();
    for (const double part : worst.head<3>().normalized()) direction.push_back(json_number(part));
  }
  return {{"displacement", std::move(displacement)}, {"direction", direction}, {"share", std::move(shares)}};
}

void add_summary(const IdealMechanism& mechanism, const AnalysisRequest& request, const RequestedStations& stations,
                 AnalysisTable& table) {
  const Model& model = mechanism.model();
  const PoseForm& form = mechanism.form();
  const std::vector<Station>& all = stations.all();
  const auto& mobility = stations.mobility();
  Json names = Json::array();
  for (const int j : mechanism.platform().inputs) names.push_back(model.joints[at(j)].name);
  Json own = {{"frame", model.markers[at(mechanism.platform().marker)].name},
              {"inputs", std::move(names)},
              {"length", mechanism.length()}};
  if (mobility) {
    own["freedoms"] = mobility->general.freedoms;
    own["redundant_inputs"] = mobility->general.redundant_inputs;
    own["redundant_constraints"] = mobility->general.redundant_rows;
    own["special_configuration"] = mobility->special();
  }
  if (request.kind == AnalysisKind::workspace || request.kind == AnalysisKind::singularity) {
    own["outputs"] = Json::array();
    for (std::size_t i = 0; i < form.size(); ++i) {
      if (stations.given()[i]) own["outputs"].push_back(form.words[i]);
    }
  }
  own["points"] = all.size();
  own["reachable"] = std::ranges::count(all, true, &Station::reachable);
  if (request.kind == AnalysisKind::error && all.size() == 1 && all.front().reachable)
    own["worst"] = causes(mechanism, all.front());
  own.update(table.summary);
  table.summary = std::move(own);
}

}  // namespace

AnalysisResult analyse(IdealMechanism& mechanism, const AnalysisRequest& request, const RequestedStations& stations,
                       const TickOf& tick_of) {
  AnalysisResult result;
  result.warnings = stations.warnings();
  result.table = rows(mechanism, request, stations, result.warnings, tick_of);
  add_summary(mechanism, request, stations, result.table);
  return result;
}

}  // namespace freeplay
