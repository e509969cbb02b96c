#include "analysis/joint_way.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/index.h"

namespace freeplay {
namespace {

constexpr double end_rounding = 1e-9;  // of the larger of 1 and the end [rad or m]

/// The turn of an angle in which it lies between the ends, or else nearest to one of them.
double within_way(double angle, const JointWay& way) {
  const double middle = 0.5 * (way.lowest + way.highest);
  return nearest_turn(angle, middle);
}

double slack(double end) { return end_rounding * std::max(1.0, std::abs(end)); }

}  // namespace

std::vector<JointWay> joint_ways(const Model& model) {
  std::vector<JointWay> ways;
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const JointLayout& layout = model.joints[j].layout;
    if (layout.coordinate == Coordinate::none || (std::isinf(layout.lowest) && std::isinf(layout.highest))) continue;
    ways.push_back({static_cast<int>(j), layout.lowest, layout.highest});
  }
  for (const AnalysisSection::Ends& ends : model.analysis.limits) {
    ways.push_back({ends.joint, ends.lowest, ends.highest});
  }
  return ways;
}

bool within_ways(std::span<const JointWay> ways, PostureSolver& solver, double t, const Posture& posture,
                 Unreachable& why) {
  const Evaluation& e = solver.evaluate(t, posture, term_position);
  const Model& model = solver.mechanism().model();
  for (const JointWay& way : ways) {
    const bool turns = model.joints[at(way.joint)].ideal_layout().coordinate == Coordinate::angle;
    const bool bounded = std::isfinite(way.lowest) && std::isfinite(way.highest);
    double place = e.coordinate[at(way.joint)];
    if (turns && bounded) place = within_way(place, way);
    const bool below = place<way.lowest - slack(way.lowest), above = place> way.highest + slack(way.highest);
    if (!below && !above) continue;
    why = {};
    why.beyond = way.joint;
    why.place = place;
    why.end = below ? way.lowest : way.highest;
    return false;
  }
  return true;
}

}  // namespace freeplay
