#include "run/slowest_turn.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "base/index.h"
#include "model/force_element.h"

namespace freeplay {
namespace {

constexpr double slower = 1.0 - 1e-9;  // than by rounding

/// second = by first, of the coordinates of two joints.
struct Coupling {
  int first, second;
  double by;
};

bool turns(const JointElement& joint) { return joint.ideal_layout().coordinate == Coordinate::angle; }

/// The joint about which a body turns on ground, or -1.
int axle_of(const Model& model, BodyId body) {
  const auto found = std::ranges::find_if(model.joints, [&](const JointElement& joint) {
    if (joint.gear >= 0 || is_force_element(joint) || !turns(joint)) return false;
    const BodyId a = model.markers[at(joint.marker_a)].body, b = model.markers[at(joint.marker_b)].body;
    return std::min(a, b) == ground && std::max(a, b) == body;
  });
  return found == model.joints.end() ? -1 : static_cast<int>(found - model.joints.begin());
}

/// Strands take wheels of two radii along, without slip.
std::optional<Coupling> coupling_by_strands(const Model& model, const JointElement& element) {
  if (!is_force_element(element) || !element.parameters) return std::nullopt;
  const auto& values = element.parameters->values;
  const auto first = values.find("first_radius"), second = values.find("second_radius");
  if (first == values.end() || second == values.end() || !values.contains("strands")) return std::nullopt;
  const int a = axle_of(model, model.markers[at(element.marker_a)].body);
  const int b = axle_of(model, model.markers[at(element.marker_b)].body);
  if (a < 0 || b < 0 || !(first->second.number > 0.0 && second->second.number > 0.0)) return std::nullopt;
  return Coupling{a, b, first->second.number / second->second.number};
}

std::vector<Coupling> couplings_of(const Model& model) {
  std::vector<Coupling> all;
  for (const Gear& gear : model.gears) {
    if (turns(model.joints[at(gear.first)]) && turns(model.joints[at(gear.second)]) && gear.ratio != 0.0)
      all.push_back({gear.first, gear.second, std::abs(gear.ratio)});
  }
  for (const JointElement& element : model.joints) {
    if (const auto coupling = coupling_by_strands(model, element)) all.push_back(*coupling);
  }
  return all;
}

}  // namespace

SlowestTurn slowest_turn(const Model& model, int joint) {
  const std::vector<Coupling> couplings = couplings_of(model);
  std::vector<double> ratio(model.joints.size(), 0.0);
  ratio[at(joint)] = 1.0;
  SlowestTurn slowest{.joint = joint};
  std::vector<int> reached{joint};
  for (std::size_t i = 0; i < reached.size(); ++i) {
    const auto pass = [&](int from, int to, double by) {
      if (from != reached[i] || ratio[at(to)] != 0.0) return;
      ratio[at(to)] = by * ratio[at(from)];
      reached.push_back(to);
      if (ratio[at(to)] < slower * slowest.ratio) slowest = {to, ratio[at(to)]};
    };
    for (const Coupling& coupling : couplings) {
      pass(coupling.first, coupling.second, coupling.by);
      pass(coupling.second, coupling.first, 1.0 / coupling.by);
    }
  }
  return slowest;
}

}  // namespace freeplay
