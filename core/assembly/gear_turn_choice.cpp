#include "assembly/gear_turn_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "assembly/start_branches.h"
#include "base/index.h"

namespace freeplay {

void GearTurnChoice::count(bool from_slides) {
  std::vector<bool> counted;
  for (const double held : held_) counted.push_back(!std::isnan(held));
  mechanism_.count_gears(std::move(counted), from_slides);
}

// A rack that other joints put far away has turned its pinion more than half a turn.
bool GearTurnChoice::from_slides(std::span<const double> guess) {
  const auto fixed = [](const Gear& gear) { return gear.offset.has_value(); };
  if (std::ranges::none_of(model_.gears, fixed)) return false;
  count(true);
  std::ranges::copy(guess, mechanism_.state.q().begin());
  if (mechanism_.holds(mechanism_.converge())) return true;
  count(false);
  return false;
}

// Gears with offsets of their own hold with whole turns: those that given poses have, or that given slides ask for,
// may keep more of what is given.
bool GearTurnChoice::from_other_turns(std::span<const double> guess, bool found) {
  const auto fixed = [](const Gear& gear) { return gear.offset.has_value(); };
  const GivenPoses given(mechanism_.system);
  if (std::ranges::none_of(model_.gears, fixed) || !given.any()) return false;
  if (found && StartBranches::keeps(given, mechanism_.state.q())) return false;
  std::vector<double> best(mechanism_.state.q().begin(), mechanism_.state.q().end());
  const std::vector<double> turns(mechanism_.state.h().begin(), mechanism_.state.h().end());
  std::vector<double> best_turns = turns;
  double least = found ? given.misses(best).norm() : std::numeric_limits<double>::infinity();
  int kind = 0;
  for (const int other : {1, 2, 3}) {
    std::ranges::copy(turns, mechanism_.state.h().begin());
    count_turns(other);
    std::ranges::copy(guess, mechanism_.state.q().begin());
    if (!mechanism_.holds(mechanism_.converge())) continue;
    const double misses = given.misses(mechanism_.state.q()).norm();
    if (!(misses < (1.0 - 1e-6) * least)) continue;
    least = misses, kind = other;
    best.assign(mechanism_.state.q().begin(), mechanism_.state.q().end());
    best_turns.assign(mechanism_.state.h().begin(), mechanism_.state.h().end());
  }
  std::ranges::copy(turns, mechanism_.state.h().begin());
  count_turns(kind);
  if (kind != 0) std::ranges::copy(best_turns, mechanism_.state.h().begin());
  std::ranges::copy(best, mechanism_.state.q().begin());
  mechanism_.evaluate(term_position | term_velocity);
  return kind != 0;
}

// Angles of gears are counted from (-pi, pi] (0), from given poses (1), from slides (2) or from that turn of the
// joint that leads a train with which it comes nearest to given poses (3).
void GearTurnChoice::count_turns(int kind) {
  if (kind == 0 || kind == 2) return count(kind == 2);
  std::vector<bool> counted;
  for (const double held : held_) counted.push_back(!std::isnan(held));
  std::vector<double> given(model_.joints.size(), std::numeric_limits<double>::quiet_NaN());
  for (const Gear& gear : model_.gears) {
    for (const int j : {gear.first, gear.second}) {
      const JointElement& joint = model_.joints[at(j)];
      if (mechanism_.system.layout().turn(j) < 0 || model_.space != Space::planar) continue;
      const auto a = given_angle(joint.marker_a), b = given_angle(joint.marker_b);
      if (a && b) given[at(j)] = *b - *a;
    }
  }
  if (kind == 3) {
    mechanism_.count_gears(std::move(counted), false);
    return mechanism_.turn_gears(given);
  }
  for (std::size_t j = 0; j < given.size(); ++j) {
    if (counted[j] || std::isnan(given[j])) continue;
    mechanism_.state.h()[at(mechanism_.system.layout().turn(static_cast<int>(j)))] = given[j];
    counted[j] = true;
  }
  mechanism_.count_gears(std::move(counted), false);
}

std::optional<double> GearTurnChoice::given_angle(int marker) const {
  const Marker& m = model_.markers[at(marker)];
  if (m.body == ground) return m.angle;
  const auto& own = model_.bodies[at(m.body)].angle;
  return own ? std::optional<double>(*own + m.angle) : std::nullopt;
}

}  // namespace freeplay
