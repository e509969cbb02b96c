#include "assembly/drive_range.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "assembly/continuation.h"
#include "assembly/start_branches.h"
#include "base/index.h"

namespace freeplay {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

// In rad, and over the size of the model.
constexpr double longest_step = 0.1, shortest_step = 1e-7;

// The last coordinate of the way in one direction, +-infinity where it does not end.
double limit(ClosedMechanism& mechanism, double sign) {
  ClosedMechanism::Lead& lead = mechanism.leads.back();
  const bool turns = mechanism.system.joints().layout(lead.joint).coordinate == Coordinate::angle;
  const double unit = turns ? 1.0 : mechanism.system.size();
  const double whole = turns ? 2.0 * std::numbers::pi : 3.0 * unit, start = lead.value;
  double step = first_drive_step * unit;
  while (std::abs(lead.value - start) < whole) {
    const double before = lead.value;
    if (follow(mechanism, [&] { lead.value = before + sign * step; })) {
      step = std::min(1.5 * step, longest_step * unit);
      continue;
    }
    lead.value = before;
    step *= 0.5;
    if (step >= shortest_step * unit) continue;
    if (before != start || !leave_dead_point(mechanism, sign)) return before;
    step = first_drive_step * unit;
  }
  return sign * infinite;
}

}  // namespace

DriveRange drive_range(ClosedMechanism& mechanism) {
  const std::vector<double> q(mechanism.state.q().begin(), mechanism.state.q().end());
  const std::vector<double> h(mechanism.state.h().begin(), mechanism.state.h().end());
  const double value = mechanism.leads.back().value;
  const auto go = [&](double sign) {
    const double end = limit(mechanism, sign);
    mechanism.leads.back().value = value;
    std::ranges::copy(q, mechanism.state.q().begin());
    std::ranges::copy(h, mechanism.state.h().begin());
    mechanism.position_rows();
    return end;
  };
  DriveRange range;
  range.to = go(1.0);
  range.from = go(-1.0);
  return range;
}

std::string words(double value, Coordinate coordinate) {
  return coordinate == Coordinate::angle ? fmt::format("{:.4g} deg", value * 180.0 / std::numbers::pi)
                                         : fmt::format("{:.4g} m", value);
}

std::string words(const DriveRange& range, Coordinate coordinate) {
  const std::string verb = coordinate == Coordinate::angle ? "turn" : "move";
  if (range.from == -infinite) return fmt::format("{} up to {}", verb, words(range.to, coordinate));
  if (range.to == infinite) return fmt::format("{} down to {}", verb, words(range.from, coordinate));
  return fmt::format("{} from {} to {}", verb, words(range.from, coordinate), words(range.to, coordinate));
}

std::optional<std::string> closes_elsewhere(ClosedMechanism& mechanism) {
  const Model& model = mechanism.model();
  if (mechanism.system.layout().nv() > most_followed_velocities) return std::nullopt;
  const std::vector<double> q(mechanism.state.q().begin(), mechanism.state.q().end());
  // With the joint leading in place of what held it, at whatever makes the mechanism close.
  const auto try_joint = [&](int joint) -> std::optional<std::string> {
    std::ranges::copy(q, mechanism.state.q().begin());
    StartBranches branches(mechanism, q);
    branches.search();
    if (!branches.any()) return std::nullopt;
    branches.take_nearest();
    const Coordinate coordinate = model.joints[at(joint)].ideal_layout.coordinate;
    const double closed = mechanism.e.coordinate[at(joint)];
    mechanism.leads.push_back({joint, closed});
    const DriveRange range = drive_range(mechanism);
    mechanism.leads.pop_back();
    std::string text =
        fmt::format("it closes with joint '{}' at {}", model.joints[at(joint)].name, words(closed, coordinate));
    if (range.limited()) text += fmt::format(", which can {}", words(range, coordinate));
    return text;
  };
  for (std::size_t i = 0; i < mechanism.leads.size(); ++i) {
    const ClosedMechanism::Lead lead = mechanism.leads[i];
    mechanism.leads.erase(mechanism.leads.begin() + static_cast<std::ptrdiff_t>(i));
    auto text = try_joint(lead.joint);
    mechanism.leads.insert(mechanism.leads.begin() + static_cast<std::ptrdiff_t>(i), lead);
    if (text) return text;
  }
  for (int d = 0; d < static_cast<int>(model.drivers.size()); ++d) {
    const int row = mechanism.system.layout().driver_row(d);
    if (row < 0 || model.drivers[at(d)].kinematics >= 0 || !mechanism.held_row[at(row)]) continue;
    mechanism.held_row[at(row)] = 0;
    auto text = try_joint(model.drivers[at(d)].joint);
    mechanism.held_row[at(row)] = 1;
    if (text) return text;
  }
  return std::nullopt;
}

}  // namespace freeplay
