#include "analysis/station.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <exception>
#include <semaphore>
#include <system_error>
#include <thread>

#include <fmt/format.h>

#include "analysis/regular_start.h"
#include "base/error.h"
#include "base/index.h"

namespace freeplay {
namespace {

Demand path_demand(IdealMechanism& mechanism, double t) {
  const Platform& platform = mechanism.platform();
  Demand demand;
  demand.t = t;
  if (!platform.has_path()) {
    demand.inputs = mechanism.driven_inputs(t);
    return demand;
  }
  demand.given = platform.path_components();
  EvaluationFailure failure;
  PathPose pose;
  if (!platform.path.evaluate(t, pose, failure)) {
    throw Error(Error::Category::numerical, failure.id,
                fmt::format("the path has no value at t = {} s: {}", t, failure.reason), platform.location);
  }
  demand.pose = pose.numbers;
  return demand;
}

/// Reaches points of a grid from their neighbours.
class GridFlood {
 public:
  GridFlood(IdealMechanism& mechanism, const Components& given, std::span<const GridValues> axes,
            std::vector<Station>& stations, const Tick& tick, std::span<const JointWay> ways)
      : tick_(tick),
        solver_(mechanism),
        start_(regular_start(mechanism, given)),
        axes_(axes),
        stations_(stations),
        ways_(ways) {}

  void run() {
    // From the start to the point next to it that can be reached; further points only if all nearer ones fail.
    std::vector<std::size_t> order(stations_.size());
    const FramePose here = solver_.frame(start_);
    std::vector<double> distance(stations_.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      order[i] = i;
      for (std::size_t k = 0; k < axes_.size(); ++k) {
        const double gap = stations_[i].demand.given[k] ? stations_[i].demand.pose[k].value - here[k] : 0.0;
        distance[i] += gap * gap;
      }
    }
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return distance[i]; });
    constexpr std::size_t most_attempts = 200;
    for (std::size_t i = 0; i < std::min(order.size(), most_attempts) && open_.empty(); ++i) reach(order[i], start_);
    while (!open_.empty()) {
      const std::size_t from = open_.front();
      open_.pop_front();
      for_each_neighbour(from, [&](std::size_t to) {
        if (!stations_[to].reachable) reach(to, stations_[from].posture);
      });
    }
  }

 private:
  void reach(std::size_t index, const Posture& from) {
    Station& station = stations_[index];
    station.reachable = solver_.reach(station.demand, from, station.posture, station.why);
    station.folded = solver_.folded();
    if (station.reachable && !ways_.empty()) {
      station.reachable = within_ways(ways_, solver_, station.demand.t, station.posture, station.why);
    }
    if (tick_) tick_(station.reachable ? 1 : 0);
    if (station.reachable && !station.folded) open_.push_back(index);
  }
  template <class Visit>
  void for_each_neighbour(std::size_t index, const Visit& visit) {
    const long i = static_cast<long>(index);
    long stride = static_cast<long>(stations_.size());
    for (const GridValues& axis : axes_) {
      stride /= axis.count;
      const long place = i / stride % axis.count;
      if (place > 0) visit(static_cast<std::size_t>(i - stride));
      if (place + 1 < axis.count) visit(static_cast<std::size_t>(i + stride));
    }
  }

  const Tick& tick_;
  PostureSolver solver_;
  Posture start_;
  std::span<const GridValues> axes_;
  std::vector<Station>& stations_;
  std::span<const JointWay> ways_;
  std::deque<std::size_t> open_;
};

}  // namespace

Components components_to_give(const PoseForm& form, int freedoms, const Components& given, const std::string& what,
                              const Location& place) {
  Components out = given;
  const int wanted = std::min(freedoms, form.freedoms());
  for (std::size_t i = form.lengths; i < form.size() && wanted == form.freedoms(); ++i) out[i] = true;
  if (count(out) == wanted) return out;
  const bool in_file = !place.file.empty();
  const std::string needs =
      wanted == form.freedoms()
          ? fmt::format("{}, and may give {}", enumeration(form.words.first(form.lengths)),
                        form.lengths + 1 == form.size() ? "the angle" : enumeration(form.words.subspan(form.lengths)))
          : fmt::format("{} of {}", wanted, enumeration(form.words));
  throw Error(in_file ? Error::Category::input : Error::Category::usage,
              in_file ? (count(out) < wanted ? "ik-underdetermined" : "ik-unreachable") : "bad-value",
              fmt::format("{} gives {} of {}, but the mechanism leaves its frame {} freedom{}", what, count(given),
                          enumeration(form.words), freedoms, freedoms == 1 ? "" : "s"),
              place, fmt::format("it must give {}", needs));
}

std::vector<Station> at_demands(IdealMechanism& mechanism, const std::vector<Demand>& demands, const Tick& tick) {
  PostureSolver solver(mechanism);
  std::vector<Station> stations;
  for (const Demand& demand : demands) {
    Station& station = stations.emplace_back();
    station.demand = demand;
    if (tick) tick(1);
    const bool direct = mechanism.closed_form() && demand.inputs.empty() && count(demand.given) == 3;
    const Posture from = direct                  ? Posture{}
                         : demand.inputs.empty() ? regular_start(mechanism, demand.given)
                                                 : mechanism.start();
    station.reachable = solver.reach(demand, from, station.posture, station.why);
    station.folded = solver.folded();
    if (station.reachable || station.why.input >= 0 || !demand.inputs.empty()) continue;
    Unreachable leg;
    solver.legs_in_reach(demand, from, leg);
    if (leg.input >= 0) station.why = leg;
  }
  return stations;
}

std::vector<Station> along_path(IdealMechanism& mechanism, const GridValues& times, const Tick& tick) {
  PostureSolver solver(mechanism);
  const bool direct =
      mechanism.closed_form() && mechanism.platform().has_path() && count(mechanism.platform().path_components()) == 3;
  std::vector<Station> stations;
  double last = mechanism.model().settings.start;
  const bool posed = mechanism.platform().has_path();
  Posture from = direct  ? Posture{}
                 : posed ? regular_start(mechanism, mechanism.platform().path_components())
                         : mechanism.start();
  for (long k = 0; k < times.count; ++k) {
    Station& station = stations.emplace_back();
    station.time = times.value(k);
    if (tick) tick(1);
    station.demand = path_demand(mechanism, station.time);
    const auto way = [&](double s) {
      return direct || s == 1.0 ? station.demand : path_demand(mechanism, last + s * (station.time - last));
    };
    station.reachable = solver.reach(way, from, station.posture, station.why);
    station.folded = solver.folded();
    if (direct || !station.reachable || station.folded) continue;
    from = station.posture;
    last = station.time;
  }
  return stations;
}

std::vector<Station> on_grid(IdealMechanism& mechanism, std::span<const GridValues> axes, const Components& given,
                             int threads, const Tick& tick, std::span<const JointWay> ways) {
  long points = 1;
  for (const GridValues& axis : axes) points *= axis.count;
  std::vector<Station> stations;
  stations.reserve(static_cast<std::size_t>(points));
  for (std::size_t i = 0; i < static_cast<std::size_t>(points); ++i) {
    if (tick && i % 1024 == 0) tick(0);
    Demand& demand = stations.emplace_back().demand;
    demand.t = mechanism.model().settings.start;
    demand.given = given;
    long stride = points;
    for (std::size_t c = 0; c < axes.size(); ++c) {
      stride /= axes[c].count;
      if (given[c]) demand.pose[c] = Jet::constant(axes[c].value(static_cast<long>(i) / stride % axes[c].count));
    }
  }
  if (!mechanism.closed_form() || count(given) < 3) {
    GridFlood(mechanism, given, axes, stations, tick, ways).run();
    return stations;
  }
  in_parallel(stations.size(), threads, tick, [&](int, std::size_t first, std::size_t last) {
    PostureSolver solver(mechanism);
    for (std::size_t i = first; i < last; ++i) {
      stations[i].reachable = solver.reach(stations[i].demand, {}, stations[i].posture, stations[i].why);
      if (tick) tick(1);
    }
  });
  return stations;
}

void in_parallel(std::size_t count, int threads, const Tick& tick,
                 const std::function<void(int, std::size_t, std::size_t)>& work) {
  const std::size_t pieces = std::clamp<std::size_t>(at(std::max(threads, 1)), 1, std::max<std::size_t>(count, 1));
  std::vector<std::exception_ptr> failures(pieces);
  const auto run = [&](std::size_t piece) {
    try {
      work(static_cast<int>(piece), count * piece / pieces, count * (piece + 1) / pieces);
    } catch (...) {
      failures[piece] = std::current_exception();
    }
  };
  std::vector<std::thread> others;
  others.reserve(pieces);
  std::counting_semaphore<> ended(0);
  std::size_t piece = 1;
  try {
    for (; piece < pieces; ++piece) {
      others.emplace_back([&, piece] {
        run(piece);
        ended.release();
      });
    }
  } catch (const std::system_error&) {  // no more threads: the rest is done here
  }
  run(0);
  for (; piece < pieces; ++piece) run(piece);
  try {
    for (std::size_t left = others.size(); left > 0;) {
      if (ended.try_acquire_for(std::chrono::milliseconds(50))) {
        --left;
      } else if (tick) {
        tick(0);
      }
    }
  } catch (...) {
    if (!failures[0]) failures[0] = std::current_exception();
  }
  for (std::thread& other : others) other.join();
  for (const std::exception_ptr& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
}

}  // namespace freeplay
