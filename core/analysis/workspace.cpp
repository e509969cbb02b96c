#include "analysis/workspace.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "analysis/joint_way.h"
#include "base/error.h"

namespace freeplay {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Points of a grid of any number of axes, the last fastest.
class Cells {
 public:
  Cells(const std::vector<Station>& stations, std::vector<long> counts)
      : stations_(stations), counts_(std::move(counts)), strides_(counts_.size(), 1) {
    for (std::size_t k = counts_.size(); k-- > 1;) strides_[k - 1] = strides_[k] * counts_[k];
  }

  /// Calls visit(neighbour) for those ahead of a point along each axis and, with `both`, for those behind it. True when
  /// the point is on the border.
  template <class Visit>
  bool for_each_neighbour(std::size_t point, bool both, const Visit& visit) const {
    bool border = false;
    for (std::size_t k = counts_.size(); k-- > 0;) {
      const long place = static_cast<long>(point) / strides_[k] % counts_[k];
      border = border || place == 0 || place + 1 == counts_[k];
      if (both && place > 0) visit(point - static_cast<std::size_t>(strides_[k]));
      if (place + 1 < counts_[k]) visit(point + static_cast<std::size_t>(strides_[k]));
    }
    return border;
  }

  /// Regions of one sort, and how many of them do not touch the border.
  std::pair<int, int> regions(bool reachable) const {
    std::vector<char> seen(stations_.size(), 0);
    int count = 0, inner = 0;
    for (std::size_t first = 0; first < seen.size(); ++first) {
      if (seen[first] || stations_[first].reachable != reachable) continue;
      bool border = false;
      std::vector<std::size_t> open{first};
      seen[first] = 1;
      while (!open.empty()) {
        const std::size_t here = open.back();
        open.pop_back();
        const bool ends = for_each_neighbour(here, true, [&](std::size_t next) {
          if (seen[next] || stations_[next].reachable != reachable) return;
          seen[next] = 1;
          open.push_back(next);
        });
        border = border || ends;
      }
      ++count;
      inner += border ? 0 : 1;
    }
    return {count, inner};
  }

 private:
  const std::vector<Station>& stations_;
  std::vector<long> counts_, strides_;
};

double spacing(const GridValues& axis) {
  return axis.count > 1 ? std::abs(axis.value(axis.count - 1) - axis.value(0)) / static_cast<double>(axis.count - 1)
                        : 0.0;
}

Demand between(const Demand& a, const Demand& b, double s) {
  Demand out = a;
  for (std::size_t i = 0; i < out.pose.size(); ++i) out.pose[i].value += s * (b.pose[i].value - a.pose[i].value);
  return out;
}

/// Looks for where reach ends between a station in reach and a demand that is not.
class ReachEnd {
 public:
  /// `follows`: no part of the mechanism stands by itself.
  ReachEnd(IdealMechanism& mechanism, bool follows)
      : solver_(mechanism), ways_(joint_ways(mechanism.model())), follows_(follows) {}

  PostureSolver& solver() { return solver_; }

  /// The share of the way at which it ends, by its legs or by an end of a joint's way.
  double share(const Demand& good, const Posture& at_good, const Demand& bad) {
    if (!follows_) return halved(good, at_good, bad, 1.0);
    const double end = end_of_way(good, at_good, bad);
    Posture there;
    return holds(between(good, bad, end), at_good, there) ? end : halved(good, at_good, bad, end);
  }
  /// The posture for a demand, from another; false where it is out of reach.
  bool holds(const Demand& demand, const Posture& from, Posture& to) {
    Unreachable why;
    return solver_.reach(demand, from, to, why) && within_ways(ways_, solver_, demand.t, to, why);
  }

 private:
  double halved(const Demand& good, const Posture& at_good, const Demand& bad, double outside) {
    double inside = 0.0;
    Posture here = at_good, trial;
    while (outside - inside > 1e-9) {
      const double middle = 0.5 * (inside + outside);
      if (holds(between(good, bad, middle), here, trial)) {
        inside = middle;
        here = trial;
      } else {
        outside = middle;
      }
    }
    return inside;
  }
  /// Where the way that is followed ends, to two millionths.
  double end_of_way(const Demand& good, const Posture& at_good, const Demand& bad) {
    double last = 0.0;
    Posture trial;
    Unreachable why;
    const auto way = [&](double share) {
      if (share < 1.0) last = share;
      return between(good, bad, share);
    };
    return solver_.reach(way, at_good, trial, why) ? 1.0 : last;
  }

  PostureSolver solver_;
  std::vector<JointWay> ways_;
  bool follows_;
};

}  // namespace

std::vector<std::size_t> lengths_of_grid(const PoseForm& form, std::span<const GridValues> axes,
                                         const Components& given) {
  std::vector<std::size_t> lengths;
  for (std::size_t i = 0; i < form.size(); ++i) {
    const bool runs = form.lengths == 2 && i < 2 ? given[i] : axes[i].count > 1;
    if (!runs) continue;
    if (form.is_turn(i)) return {};
    lengths.push_back(i);
  }
  if (lengths.size() < 2) lengths.clear();
  return lengths;
}

WorkspaceShape workspace_shape(IdealMechanism& mechanism, const std::vector<Station>& stations,
                               std::span<const GridValues> axes, const std::vector<std::size_t>& lengths,
                               const Tick& tick) {
  WorkspaceShape shape;
  std::vector<long> counts;
  shape.size = static_cast<double>(std::ranges::count(stations, true, &Station::reachable));
  for (const std::size_t axis : lengths) {
    counts.push_back(axes[axis].count);
    shape.size *= spacing(axes[axis]);
  }
  const Cells cells(stations, counts);
  shape.regions = cells.regions(true).first;
  shape.holes = cells.regions(false).second;
  const std::size_t numbers = mechanism.form().lengths;
  ReachEnd end_of_reach(mechanism, numbers == 3 && !stations.empty() &&
                                       count(stations.front().demand.given) < mechanism.form().freedoms());
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const Station& station = stations[i];
    if (tick) tick(1);
    if (station.reachable) {
      const FramePose here = end_of_reach.solver().frame(station.posture);
      shape.bounds.resize(numbers, {infinity, -infinity});
      for (std::size_t k = 0; k < numbers; ++k) {
        const double x = station.demand.given[k] ? station.demand.pose[k].value : here[k];
        shape.bounds[k] = {std::min(shape.bounds[k][0], x), std::max(shape.bounds[k][1], x)};
      }
    }
    if (lengths.size() > 2) continue;  // a surface of too many points
    cells.for_each_neighbour(i, false, [&](std::size_t next) {
      const Station& other = stations[next];
      if (station.reachable == other.reachable) return;
      const Station& good = station.reachable ? station : other;
      const Station& bad = station.reachable ? other : station;
      const double share = end_of_reach.share(good.demand, good.posture, bad.demand);
      const Demand end = between(good.demand, bad.demand, share);
      std::vector<double>& point = shape.boundary.emplace_back();
      for (std::size_t k = 0; k < numbers; ++k) point.push_back(end.pose[k].value);
    });
  }
  return shape;
}

double reach_in_direction(IdealMechanism& mechanism, const FramePose& pose, double angle, double longest) {
  ReachEnd end_of_reach(mechanism, false);
  PostureSolver& solver = end_of_reach.solver();
  Demand demand;
  demand.t = mechanism.model().settings.start;
  demand.given = {true, true, true};
  for (std::size_t i = 0; i < 3; ++i) demand.pose[i] = Jet::constant(pose[i]);
  Posture posture, next;
  Unreachable why;
  if (!solver.reach(demand, mechanism.closed_form() ? Posture{} : mechanism.start(), posture, why)) {
    throw Error(Error::Category::numerical, "ik-unreachable", why.text(mechanism));
  }
  constexpr int pieces = 1000;
  for (int i = 1; i <= pieces; ++i) {
    const auto ahead = [&](double distance) {
      Demand out = demand;
      out.pose[0].value += distance * std::cos(angle);
      out.pose[1].value += distance * std::sin(angle);
      return out;
    };
    const Demand to = ahead(longest * i / pieces);
    if (end_of_reach.holds(to, posture, next)) {
      posture = next;
      continue;
    }
    const double share = end_of_reach.share(ahead(longest * (i - 1) / pieces), posture, to);
    return longest * (i - 1 + share) / pieces;
  }
  return longest;
}

}  // namespace freeplay
