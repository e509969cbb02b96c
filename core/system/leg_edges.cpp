#include "system/leg_edges.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/index.h"

namespace freeplay {
namespace {

constexpr int fewest_pieces_of_run = 128;
constexpr double shortest_look = 1e-9;  // of a run
constexpr double may_bend = 0.05;       // by which a piece may bend, by the lengths of the leg
constexpr double look_closer_at = 0.1;  // sine of the angle between crank and coupler
constexpr double near_edge = 0.05;      // the same, of what is noted
constexpr double touching = 1e-6;       // the same, of what no step tells from the edge itself
constexpr double still_there = 0.5;     // of a jump of speed, from four times as far

/// The leg of a driver on its path.
class LegOnPath {
 public:
  LegOnPath(const Model& model, int driver, const Leg& leg) : model_(model), driver_(driver), leg_(leg) {}

  struct Place {
    bool valid = false;
    double t = 0.0, squared = 0.0;  ///< of the sine between crank and coupler; below zero out of reach
    double distance = 0.0;          ///< of the pins on ground and platform [m]
    Jet x{}, y{}, crank{};
  };

  [[gnu::cold]] Place at_time(double t) const {
    const Driver& driven = model_.drivers[at(driver_)];
    const InverseKinematics& entry = model_.kinematics[at(driven.kinematics)];
    PathPose pose;
    EvaluationFailure failure;
    Place place{.t = t};
    if (!entry.path.evaluate(t, pose, failure)) return place;
    const Jet turned = pose[2] - Jet::constant(model_.markers[at(entry.marker)].angle);
    const PlatformTurn platform(turned);
    const CrankPose crank = solve_crank(leg_, pose[0], pose[1], platform);
    const Jet cosine = cos(turned), sine = sin(turned), cx = Jet::constant(leg_.cx), cy = Jet::constant(leg_.cy);
    place.x = pose[0] + cosine * cx - sine * cy;
    place.y = pose[1] + sine * cx + cosine * cy;
    place.distance = crank.distance;
    place.crank = crank.crank;
    const double sum = leg_.crank + leg_.coupler, difference = leg_.crank - leg_.coupler, d = crank.distance;
    place.squared = (sum - d) * (sum + d) * (d - difference) * (d + difference) /
                    (4.0 * leg_.crank * leg_.crank * leg_.coupler * leg_.coupler);
    place.valid = std::isfinite(place.squared);
    return place;
  }

  /// Whether the path between two places is what they say of the middle.
  [[gnu::cold]] bool says(const Place& left, const Place& middle, const Place& right) const {
    const auto off = [&](const Place& from) {
      const double h = middle.t - from.t;
      const double x = from.x.value + h * (from.x.rate + 0.5 * h * from.x.acceleration) - middle.x.value;
      const double y = from.y.value + h * (from.y.rate + 0.5 * h * from.y.acceleration) - middle.y.value;
      return std::hypot(x, y) / (leg_.crank + leg_.coupler);
    };
    return off(left) <= may_bend && off(right) <= may_bend;
  }

  [[gnu::cold]] Place lowest(double from, double to) const {
    constexpr double golden = 0.6180339887498949;
    Place a = at_time(to - golden * (to - from)), b = at_time(from + golden * (to - from));
    for (int i = 0; i < 60; ++i) {
      if (a.squared < b.squared) {
        to = b.t, b = a, a = at_time(to - golden * (to - from));
      } else {
        from = a.t, a = b, b = at_time(from + golden * (to - from));
      }
    }
    return a.squared < b.squared ? a : b;
  }

  /// What is noted of a place where the leg is closest to the edge.
  [[gnu::cold]] PathEdge edge(const Place& place, double around) const {
    PathEdge edge{.kinematics = model_.drivers[at(driver_)].kinematics, .time = place.t};
    const double sum = leg_.crank + leg_.coupler, difference = std::abs(leg_.crank - leg_.coupler);
    edge.distance = std::max(std::min(std::abs(sum - place.distance), std::abs(place.distance - difference)), 0.0);
    const double sine = std::sqrt(std::max(place.squared, 0.0));
    const double h = 0.05 * around;
    const double bend = at_time(place.t - h).squared + at_time(place.t + h).squared - 2.0 * place.squared;
    const double fall = std::sqrt(std::max(bend, 0.0) / 2.0) / h;
    edge.width = fall > 0.0 ? sine / fall : around;
    edge.joints = fmt::format("joint '{}' ({})", leg_.name,
                              place.distance > 0.5 * (sum + difference) ? "its leg stretched" : "its leg folded");
    edge.jumps = sine < touching && fall > 0.0 && speed_jumps(place.t, near_edge / fall);
    return edge;
  }

 private:
  [[gnu::cold]] bool speed_jumps(double t, double h) const {
    const auto jump = [&](double by) {
      const double turned = at_time(t + by).crank.value - at_time(t - by).crank.value;
      const double rate = std::abs(at_time(t + by).crank.rate - at_time(t - by).crank.rate);
      return std::pair(std::abs(std::remainder(turned, 2.0 * M_PI)), rate);
    };
    const auto [far_turn, far_rate] = jump(h);
    const auto [near_turn, near_rate] = jump(0.25 * h);
    return (far_turn > look_closer_at && near_turn > still_there * far_turn) ||
           (far_rate > 0.0 && near_rate > still_there * far_rate);
  }

  const Model& model_;
  int driver_;
  const Leg& leg_;
};

}  // namespace

std::vector<PathEdge> leg_edges(const Model& model, int driver, const Leg& leg, double from, double to) {
  std::vector<PathEdge> edges;
  const LegOnPath path(model, driver, leg);
  const double run = to - from, longest = run / fewest_pieces_of_run;
  LegOnPath::Place left = path.at_time(from);
  for (double piece = longest; left.valid && left.t < to && run > 0.0;) {
    const double next = left.t + piece > to - 1e-3 * piece ? to : left.t + piece;
    const LegOnPath::Place middle = path.at_time(0.5 * (left.t + next)), right = path.at_time(next);
    if (!right.valid || !middle.valid) return edges;
    if (piece > shortest_look * run && !path.says(left, middle, right)) {
      piece *= 0.5;
      continue;
    }
    // The parabola of the square of the sine.
    const double bend = left.squared - 2.0 * middle.squared + right.squared,
                 slope = 0.5 * (right.squared - left.squared);
    const bool inside = bend > 0.0 && std::abs(slope) <= bend;
    if (inside && middle.squared - 0.5 * slope * slope / bend < look_closer_at * look_closer_at) {
      const LegOnPath::Place lowest = path.lowest(left.t, next);
      const bool again = !edges.empty() && lowest.t - edges.back().time < 0.1 * piece;
      if (lowest.squared < near_edge * near_edge && !again) edges.push_back(path.edge(lowest, next - left.t));
    }
    left = right;
    piece = std::min(2.0 * piece, longest);
  }
  return edges;
}

}  // namespace freeplay
