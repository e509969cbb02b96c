#include "assembly/drive_range.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Core>
#include <fmt/format.h>

#include "assembly/continuation.h"
#include "assembly/start_branches.h"
#include "base/index.h"
#include "linear/row_solutions.h"

namespace freeplay {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

// In rad, and over the size of the model.
constexpr double longest_step = 0.1, shortest_step = 1e-7;
constexpr double finest_step = 1e-6;   // beside a singular position that is passed
constexpr double of_regularity = 0.3;  // a step by the regularity of the rows, which falls as the way to one does
constexpr double independent = 1e-7;   // pivot by the largest: rows with less follow from the others
constexpr double steady_step = 1e-3;   // a way of this length says where it leads, ...
constexpr double quick_step = 1e-5;    // ... and of this one how fast the mechanism moves
constexpr double much_faster = 2.0;    // than in steady steps: at the end of a way speeds grow without bound
constexpr double leaps[] = {0.01, 0.03, 0.1};               // over a singular position on the way
constexpr double closed_range = 1e-5;                       // less is no range
constexpr std::size_t most_branches = 8, few_branches = 2;  // that are looked at; each is followed both ways
constexpr int many_velocities = 45;
constexpr int most_way_steps = 2000;  // of a way: a finer one, as of a thread, is held to have no end

// The way of the last lead of a mechanism in one direction.
class Way {
 public:
  Way(ClosedMechanism& mechanism, double sign, double& best)
      : mechanism_(mechanism),
        lead_(mechanism.leads.back()),
        sign_(sign),
        best_(best),
        turns_(mechanism.system.joints().layout(lead_.joint).coordinate == Coordinate::angle),
        unit_(turns_ ? 1.0 : mechanism.system.size()),
        ahead_(at(mechanism.system.layout().nv())) {}

  // Its last coordinate, +-infinity where it does not end.
  double end() {
    const double whole = turns_ ? 2.0 * std::numbers::pi : 3.0 * unit_, start = lead_.value;
    double step = first_drive_step * unit_;
    for (int i = 0; i < most_way_steps && std::abs(lead_.value - start) < whole; ++i) {
      step = std::min(step, std::max(of_regularity * regularity(), finest_step) * unit_);
      if (go(step)) {
        step = std::min(1.5 * step, longest_step * unit_);
        continue;
      }
      step *= 0.5;
      if (step >= shortest_step * unit_) continue;
      const bool leaves = lead_.value == start ? leave_dead_point(mechanism_, sign_) : leap();
      if (!leaves) return lead_.value;
      step = first_drive_step * unit_;
    }
    return sign_ * infinite;
  }

 private:
  // Smallest pivot of the rows that are independent, by the largest that it had.
  double regularity() {
    const Eigen::MatrixXd columns = Eigen::MatrixXd(mechanism_.position_rows().matrix).transpose();
    const Eigen::VectorXd sizes = pivots(columns);
    double smallest = infinite;
    for (const double pivot : sizes) {
      if (pivot > independent * sizes[0]) smallest = std::min(smallest, pivot);
    }
    best_ = std::max(best_, smallest);
    return smallest / best_;
  }

  bool go(double step) {
    const double before = lead_.value;
    const std::vector<double> q(mechanism_.state.q().begin(), mechanism_.state.q().end());
    if (!follow(
            mechanism_, [&] { lead_.value = before + sign_ * step; }, ahead(step))) {
      lead_.value = before;
      return false;
    }
    if (step < quick_step * unit_) return true;
    mechanism_.system.coordinates().difference(q, mechanism_.state.q(), ahead_);
    speed_ = largest(ahead_) / step;
    if (step < steady_step * unit_) return true;
    way_ = ahead_;
    length_ = step;
    return true;
  }

  static double largest(std::span<const double> increment) {
    double size = 0.0;
    for (const double part : increment) size = std::max(size, std::abs(part));
    return size;
  }

  // Straight on by as much.
  std::span<const double> ahead(double step) {
    if (way_.empty()) return {};
    for (std::size_t i = 0; i < way_.size(); ++i) ahead_[i] = step / length_ * way_[i];
    return ahead_;
  }

  // Newton's method fails in singular positions that a mechanism passes, as a parallelogram does when it lies flat.
  bool leap() {
    if (way_.empty() || speed_ > much_faster * largest(way_) / length_) return false;
    return std::ranges::any_of(leaps, [&](double part) { return go(part * unit_); });
  }

  ClosedMechanism& mechanism_;
  ClosedMechanism::Lead& lead_;
  double sign_;
  double& best_;  // pivot
  bool turns_;
  double unit_;
  std::vector<double> ahead_, way_;  // of bodies; of the last steady step
  double length_ = 0.0;              // of the lead in that step
  double speed_ = 0.0;               // of the fastest part of a body, by that of the lead
};

}  // namespace

DriveRange drive_range(ClosedMechanism& mechanism) {
  const std::vector<double> q(mechanism.state.q().begin(), mechanism.state.q().end());
  const std::vector<double> h(mechanism.state.h().begin(), mechanism.state.h().end());
  const double value = mechanism.leads.back().value;
  double best = 0.0;
  const auto go = [&](double sign) {
    const double end = Way(mechanism, sign, best).end();
    mechanism.leads.back().value = value;
    std::ranges::copy(q, mechanism.state.q().begin());
    std::ranges::copy(h, mechanism.state.h().begin());
    mechanism.position_rows();
    return end;
  };
  DriveRange range;
  range.to = go(1.0);
  const double known = best;
  range.from = go(-1.0);
  if (best > known) range.to = go(1.0);  // how regular it can be was not known yet
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
  const std::string from = words(range.from, coordinate), to = words(range.to, coordinate);
  return from == to ? fmt::format("hardly {} from {}", verb, from) : fmt::format("{} from {} to {}", verb, from, to);
}

namespace {

// How far a coordinate is beyond a range.
double beyond(const DriveRange& range, double value, bool turns) {
  double least = infinite;
  const double turn = 2.0 * std::numbers::pi;
  for (const double round : {0.0, turn, -turn}) {
    if (round != 0.0 && !turns) break;
    least = std::min(least, std::max({0.0, value + round - range.to, range.from - value - round}));
  }
  return least;
}

// With the joint leading in place of what held it at `asked`, at whatever makes the mechanism close: of the ways in
// which it can be put together the one on which the joint comes nearest to that.
std::optional<std::string> closes_with(ClosedMechanism& mechanism, int joint, double asked) {
  const Model& model = mechanism.model();
  const std::vector<double> q(mechanism.state.q().begin(), mechanism.state.q().end());
  StartBranches branches(mechanism, q);
  branches.search();
  const Coordinate coordinate = model.joints[at(joint)].ideal_layout().coordinate;
  const bool turns = coordinate == Coordinate::angle;
  double closed = 0.0, least = infinite;
  DriveRange range;
  const std::size_t most = mechanism.system.layout().nv() > many_velocities ? few_branches : most_branches;
  for (std::size_t i = 0; i < std::min(branches.count(), most); ++i) {
    branches.take(i);
    const double here = mechanism.e.coordinate[at(joint)];
    mechanism.leads.push_back({joint, here});
    const DriveRange own = drive_range(mechanism);
    mechanism.leads.pop_back();
    const double away = beyond(own, asked, turns);
    if (away < least) least = away, closed = here, range = own;
  }
  std::ranges::copy(q, mechanism.state.q().begin());
  if (!(least < infinite)) return std::nullopt;
  const double unit = turns ? 1.0 : mechanism.system.size();
  if (std::abs(closed) < closed_range * unit) closed = 0.0;
  const std::string at_value =
      fmt::format("it closes with joint '{}' at {}", model.joints[at(joint)].name, words(closed, coordinate));
  if (!range.limited()) return at_value;
  if (range.to - range.from <= closed_range * unit) return at_value + ", where it is locked";
  return at_value + fmt::format(", which can {}", words(range, coordinate));
}

}  // namespace

std::optional<std::string> closes_elsewhere(ClosedMechanism& mechanism) {
  const Model& model = mechanism.model();
  if (mechanism.system.layout().nv() > most_followed_velocities) return std::nullopt;
  for (std::size_t i = 0; i < mechanism.leads.size(); ++i) {
    const ClosedMechanism::Lead lead = mechanism.leads[i];
    mechanism.leads.erase(mechanism.leads.begin() + static_cast<std::ptrdiff_t>(i));
    auto text = closes_with(mechanism, lead.joint, lead.value);
    mechanism.leads.insert(mechanism.leads.begin() + static_cast<std::ptrdiff_t>(i), lead);
    if (text) return text;
  }
  for (int d = 0; d < static_cast<int>(model.drivers.size()); ++d) {
    const int row = mechanism.system.layout().driver_row(d);
    if (row < 0 || model.drivers[at(d)].kinematics >= 0 || !mechanism.held_row[at(row)]) continue;
    mechanism.evaluate(term_position);
    const double asked = mechanism.e.motion[at(d)].value;
    mechanism.held_row[at(row)] = 0;
    auto text = closes_with(mechanism, model.drivers[at(d)].joint, asked);
    mechanism.held_row[at(row)] = 1;
    if (text) return text;
  }
  return std::nullopt;
}

}  // namespace freeplay
