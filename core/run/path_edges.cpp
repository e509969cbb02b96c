#include "run/path_edges.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/index.h"

namespace freeplay {
namespace {
constexpr double made_to = 1e-4;        // of the model's size: few machines are made more exactly
constexpr double steps_in_width = 4.0;  // of how long the path is as close
}  // namespace

PathEdges::PathEdges(const System& system)
    : system_(system), edges_(system.motions().edges(system.model().settings.end)) {}

double PathEdges::step_beside(const PathEdge& edge, double t, double dt) {
  const double away = edge.time - t;
  const double finest = edge.width / steps_in_width;
  if (edge.jumps || !(finest > 0.0)) return dt;
  // Towards the place steps end ever closer to it, and no step but the finest ones goes over it.
  const double longest = std::max(finest, away > 0.0 ? 0.5 * away : -away / steps_in_width);
  return std::min(dt, longest);
}

std::vector<TrustReason> PathEdges::doubts(double until, double step) const {
  std::vector<TrustReason> reasons;
  const Model& model = system_.model();
  const double limit = made_to * system_.size();
  for (const PathEdge& edge : edges_) {
    if (edge.time > until) continue;
    const std::string driver = fmt::format("driver '{}'", model.kinematics[at(edge.kinematics)].name);
    TrustReason reason{.id = "singular-position", .level = Trust::doubtful, .message = {}, .element = driver};
    reason.value = edge.distance, reason.limit = limit;
    if (edge.jumps) {
      reason.level = Trust::bad;
      reason.message = fmt::format(
          "{}: its path touches the edge of what is reached at t = {:.9g} s, at {}, whose speed would have to jump "
          "there: forces beside it have no bound, and the table has none of them; keep the path away from it",
          driver, edge.time, edge.joints);
    } else if (edge.distance < limit) {
      reason.message = fmt::format(
          "{}: its path comes within {:.2g} m of the edge of what is reached, a singular place, at t = {:.9g} s, at "
          "{}: "
          "speeds and forces there hang on the last digits of the lengths; keep the path away from it",
          driver, edge.distance, edge.time, edge.joints);
    } else if (edge.width < steps_in_width * step) {
      reason.value = edge.width, reason.limit = steps_in_width * step;
      reason.message = fmt::format(
          "{}: at t = {:.9g} s its path comes within {:.2g} m of the edge of what is reached, at {}, and is there for "
          "{:.2g} s, which steps of {:.2g} s do not resolve; ask for shorter ones, or for an accuracy",
          driver, edge.time, edge.distance, edge.joints, edge.width, step);
    } else {
      continue;
    }
    reasons.push_back(std::move(reason));
  }
  return reasons;
}

}  // namespace freeplay
