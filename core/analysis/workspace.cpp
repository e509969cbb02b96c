#include "analysis/workspace.h"

#include <cmath>

#include "base/error.h"

namespace freeplay {
namespace {

/// Grid of x and y, y fastest.
class Cells {
 public:
  Cells(const std::vector<Station>& stations, long nx, long ny) : stations_(stations), nx_(nx), ny_(ny) {}

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
        const long i = static_cast<long>(open.back());
        open.pop_back();
        const long x = i / ny_, y = i % ny_;
        border = border || x == 0 || y == 0 || x == nx_ - 1 || y == ny_ - 1;
        for (const auto& [dx, dy] : {std::pair{1L, 0L}, {-1L, 0L}, {0L, 1L}, {0L, -1L}}) {
          if (x + dx < 0 || x + dx >= nx_ || y + dy < 0 || y + dy >= ny_) continue;
          const auto next = static_cast<std::size_t>((x + dx) * ny_ + y + dy);
          if (seen[next] || stations_[next].reachable != reachable) continue;
          seen[next] = 1;
          open.push_back(next);
        }
      }
      ++count;
      inner += border ? 0 : 1;
    }
    return {count, inner};
  }

 private:
  const std::vector<Station>& stations_;
  long nx_, ny_;
};

Demand between(const Demand& a, const Demand& b, double s) {
  Demand out = a;
  for (std::size_t i = 0; i < 3; ++i) out.pose[i].value += s * (b.pose[i].value - a.pose[i].value);
  return out;
}

/// Share of the way from a reachable station to a demand out of reach at which reach ends.
double end_of_reach(PostureSolver& solver, const Demand& good, const Posture& at_good, const Demand& bad) {
  double inside = 0.0, outside = 1.0;
  Posture here = at_good, trial;
  Unreachable why;
  while (outside - inside > 1e-9) {
    const double middle = 0.5 * (inside + outside);
    if (solver.reach(between(good, bad, middle), here, trial, why)) {
      inside = middle;
      here = trial;
    } else {
      outside = middle;
    }
  }
  return inside;
}

}  // namespace

WorkspaceShape workspace_shape(IdealMechanism& mechanism, const std::vector<Station>& stations,
                               const std::array<GridValues, 3>& axes, const Tick& tick) {
  WorkspaceShape shape;
  const long nx = axes[0].count, ny = axes[1].count;
  const Cells cells(stations, nx, ny);
  shape.regions = cells.regions(true).first;
  shape.holes = cells.regions(false).second;
  const auto spacing = [](const GridValues& axis) {
    return axis.count > 1 ? std::abs(axis.value(axis.count - 1) - axis.value(0)) / static_cast<double>(axis.count - 1)
                          : 0.0;
  };
  long reachable = 0;
  PostureSolver solver(mechanism);
  for (long i = 0; i < nx * ny; ++i) {
    const Station& station = stations[static_cast<std::size_t>(i)];
    reachable += station.reachable ? 1 : 0;
    if (tick) tick(1);
    for (const long next : {i % ny + 1 < ny ? i + 1 : -1, i + ny < nx * ny ? i + ny : -1}) {
      if (next < 0) continue;
      const Station& other = stations[static_cast<std::size_t>(next)];
      if (station.reachable == other.reachable) continue;
      const Station& good = station.reachable ? station : other;
      const Station& bad = station.reachable ? other : station;
      const double share = end_of_reach(solver, good.demand, good.posture, bad.demand);
      const Demand end = between(good.demand, bad.demand, share);
      shape.boundary.push_back({end.pose[0].value, end.pose[1].value});
    }
  }
  shape.area = static_cast<double>(reachable) * spacing(axes[0]) * spacing(axes[1]);
  return shape;
}

double reach_in_direction(IdealMechanism& mechanism, const FramePose& pose, double angle, double longest) {
  PostureSolver solver(mechanism);
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
    if (solver.reach(to, posture, next, why)) {
      posture = next;
      continue;
    }
    const double share = end_of_reach(solver, ahead(longest * (i - 1) / pieces), posture, to);
    return longest * (i - 1 + share) / pieces;
  }
  return longest;
}

}  // namespace freeplay
