#include "assembly/out_of_reach.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "assembly/continuation.h"
#include "assembly/dead_point.h"
#include "assembly/drive_range.h"
#include "assembly/loop_gap.h"
#include "assembly/row_stress.h"
#include "base/index.h"

namespace freeplay {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();
constexpr double locked = 1e-5;         // range of a mechanism that moves nowhere, in rad or over the size of the model
constexpr double close_to_limit = 0.1;  // of a run that ends before it: forces grow without bound there
constexpr double noise = 1e-9;          // of a gap of a loop, by the size of the model
constexpr int instants = 4000;          // of a run that are looked at
constexpr int most_pieces = 4000;       // of the way of several drivers

class Reach {
 public:
  Reach(const System& system, const State& start, double t)
      : model_(system.model()), settings_(model_.settings), mechanism_(system), t_(t) {
    mechanism_.stand_at(system, start);
    for (int d = 0; d < static_cast<int>(model_.drivers.size()); ++d) {
      const Driver& driver = model_.drivers[at(d)];
      if (prescribes(driver.kind) && driver.kinematics < 0) drivers_.push_back(d);
    }
  }

  std::optional<std::string> why() {
    if (drivers_.empty() || mechanism_.system.layout().nv() > most_followed_velocities) return std::nullopt;
    if (!mechanism_.holds(mechanism_.converge())) return std::nullopt;
    if (drivers_.size() > 1 && !go_to_end_of_way()) return std::nullopt;
    for (const int driver : drivers_) {
      if (auto text = why_of(driver)) return text;
    }
    return std::nullopt;
  }

  // The time from which even play does not bridge the gap.
  double torn_from() {
    if (drivers_.size() != 1 || mechanism_.system.layout().nv() > most_followed_velocities) return never;
    if (!mechanism_.holds(mechanism_.converge())) return never;
    const int driver = drivers_.front();
    double torn = never;
    with_range(driver, [&](const DriveRange& range) {
      double play = 0.0;
      for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) play += model_.joints[at(j)].layout.clearance;
      const std::optional<Exit> exit = leaves(driver, range);
      if (!exit) return;
      const double end = exit->up ? range.to : range.from, sign = exit->up ? 1.0 : -1.0;
      const auto gap = [&](double out) {
        mechanism_.leads.back().value = end + sign * out;
        const std::optional<LoopGap> found = loop_gap(mechanism_);
        return found ? found->size : 0.0;
      };
      const std::optional<Widest> most = widest(range, *exit);
      if (!most || !(most->gap.size > 2.0 * play)) return;
      // The gap may fall and rise again on the way to the widest.
      constexpr int pieces = 24;
      double inside = 0.0, outside = most->out;
      for (int i = 1; i < pieces; ++i) {
        const double out = most->out * i / pieces;
        if (gap(out) > 2.0 * play) {
          outside = out;
          break;
        }
        inside = out;
      }
      for (int halving = 0; halving < 12; ++halving) {
        const double middle = 0.5 * (inside + outside);
        (gap(middle) > 2.0 * play ? outside : inside) = middle;
      }
      torn = time_of(driver, end + sign * outside, exit->up);
    });
    return torn;
  }

 private:
  // When, beyond which end, and how far a driver leaves a range the first time.
  struct Exit {
    double time = never, beyond = 0.0;
    bool up = true;
  };

  // NaN where a driver has no value.
  double value(int driver, double t) const {
    std::vector<TimeValue> motion(model_.drivers.size());
    MotionFault fault;
    if (!mechanism_.system.motions().evaluate(t, {motion.data(), motion.size()}, fault)) return std::nan("");
    return motion[at(driver)].value;
  }

  // Several drivers: to where the mechanism cannot follow all of them; false where it can up to the end of the run.
  bool go_to_end_of_way() {
    const double end = std::min(settings_.end, t_ + 0.01 * (t_ - settings_.start));
    const double longest = (end - settings_.start) / 200.0;
    double piece = longest;
    for (int pieces = 0; pieces < most_pieces && mechanism_.state.t() < end; ++pieces) {
      const double t = mechanism_.state.t();
      if (follow(mechanism_, [&] { mechanism_.state.t() = std::min(t + piece, end); })) {
        piece = std::min(1.5 * piece, longest);
        continue;
      }
      mechanism_.state.t() = t;
      mechanism_.position_rows();
      piece *= 0.5;
      if (piece < 1e-7 * (end - settings_.start)) return true;
    }
    return false;
  }

  double instant(int i) const { return settings_.start + (settings_.end - settings_.start) * i / instants; }

  std::optional<Exit> leaves(int driver, const DriveRange& range) const {
    Exit exit;
    for (int i = 0; i <= instants; ++i) {
      const double t = instant(i), s = value(driver, t), out = std::max(s - range.to, range.from - s);
      if (!(out > 1e-6 * unit(driver))) {
        if (exit.time < never) break;
        continue;
      }
      if (exit.time == never) exit.time = t, exit.up = s > range.to;
      exit.beyond = std::max(exit.beyond, out);
    }
    if (exit.time == never) return std::nullopt;
    return exit;
  }

  double time_of(int driver, double value_there, bool up) const {
    for (int i = 0; i <= instants; ++i) {
      const double s = value(driver, instant(i));
      if (up ? s >= value_there : s <= value_there) return instant(i);
    }
    return never;
  }

  // Where a driver opens the loops most on its way beyond the end of a range, and by how much; `out` counts from there.
  struct Widest {
    double out = 0.0;
    LoopGap gap{};
  };

  std::optional<Widest> widest(const DriveRange& range, const Exit& exit) {
    const double whole = 2.0 * std::numbers::pi;
    const bool comes_round =
        mechanism_.system.joints().layout(mechanism_.leads.back().joint).coordinate == Coordinate::angle &&
        range.from > -never && range.to < never;
    const double way = comes_round ? std::min(exit.beyond, whole - (range.to - range.from)) : exit.beyond;
    const double end = exit.up ? range.to : range.from, sign = exit.up ? 1.0 : -1.0;
    const std::vector<double> q(mechanism_.state.q().begin(), mechanism_.state.q().end());
    std::optional<Widest> best;
    const auto look = [&](double out) {
      std::ranges::copy(q, mechanism_.state.q().begin());
      mechanism_.leads.back().value = end + sign * out;
      const std::optional<LoopGap> gap = loop_gap(mechanism_);
      if (gap && (!best || gap->size > (1.0 + 1e-9) * best->gap.size)) best = Widest{out, *gap};
    };
    constexpr int pieces = 12;
    for (int i = 1; i <= pieces; ++i) look(way * i / pieces);
    // The gap may be narrow, and the mechanism close again beyond it, where it cannot get.
    for (double out = 0.5 * way / pieces; out > locked * (comes_round ? 1.0 : way); out *= 0.5) look(out);
    const double close = best ? best->out : 0.0;
    for (double step = std::min(0.5 * way / pieces, 0.5 * close); best && step > 1e-3 * close; step *= 0.5) {
      const double from = best->out;
      for (const double out : {from - step, from + step}) {
        if (out > 0.0 && out <= way) look(out);
      }
    }
    return best;
  }

  Coordinate coordinate(int driver) const {
    return model_.joints[at(model_.drivers[at(driver)].joint)].ideal_layout().coordinate;
  }
  double unit(int driver) const { return coordinate(driver) == Coordinate::angle ? 1.0 : mechanism_.system.size(); }

  // With the driver's joint leading in its place, from where it stands.
  template <class Use>
  void with_range(int d, Use&& use) {
    const int joint = model_.drivers[at(d)].joint, row = mechanism_.system.layout().driver_row(d);
    mechanism_.position_rows();
    mechanism_.held_row[at(row)] = 0;
    mechanism_.leads.push_back({joint, mechanism_.e.coordinate[at(joint)]});
    const DriveRange range = drive_range(mechanism_);
    if (range.limited()) use(range);
    mechanism_.leads.pop_back();
    mechanism_.held_row[at(row)] = 1;
  }

  std::optional<std::string> why_of(int d) {
    std::optional<std::string> text;
    with_range(d, [&](const DriveRange& range) {
      const std::optional<Exit> exit = leaves(d, range);
      if (!exit) return;
      const double end = exit->up ? range.to : range.from;
      const bool close = std::abs(value(d, t_) - end) <= close_to_limit * unit(d);
      if (t_ >= exit->time || close) text = sentence(d, range, *exit);
    });
    return text;
  }

  bool has_play() const {
    return std::ranges::any_of(model_.joints, [](const JointElement& joint) { return joint.has_play; });
  }
  /// What prescribes motion besides a driver, and may be one too many.
  std::string other_drivers(int d) const {
    std::string names;
    for (int other = 0; other < static_cast<int>(model_.drivers.size()); ++other) {
      if (other == d || !prescribes(model_.drivers[at(other)].kind)) continue;
      names += (names.empty() ? "'" : ", '") + model_.drivers[at(other)].name + "'";
    }
    return names.empty() ? names : fmt::format(", and is there one driver too many beside {}", names);
  }

  std::string sentence(int d, const DriveRange& range, const Exit& exit) {
    const Driver& driver = model_.drivers[at(d)];
    const Coordinate kind = coordinate(d);
    const double end = exit.up ? range.to : range.from;
    const std::optional<Widest> most = widest(range, exit);
    if (range.to - range.from <= locked * unit(d)) {
      return fmt::format(
          "t = {:.9g} s: driver '{}' cannot move joint '{}'{}: {} it at {}; does each of them hold the bodies that are "
          "meant, and do lengths and angles let the loop move{} [locked]",
          t_, driver.name, model_.joints[at(driver.joint)].name, has_play() ? " beyond the play" : "",
          what_locks(driver.joint), words(end, kind), other_drivers(d));
    }
    std::string text = fmt::format(
        "t = {:.9g} s: driver '{}' asks for a position that the mechanism cannot take: joint '{}' comes to a dead "
        "point "
        "at {}",
        t_, driver.name, model_.joints[at(driver.joint)].name, words(end, kind));
    if (most && most->gap.size > noise * mechanism_.system.size()) {
      text += fmt::format(", and at {} joint '{}' would stay open by {}",
                          words(end + (exit.up ? most->out : -most->out), kind),
                          model_.joints[at(most->gap.joint)].name, words(most->gap.miss, 0.0, 4));
    } else if (most) {
      text += ", beyond which its loops close only where it would have to leap to";
    }
    return text + fmt::format("; it can {}: keep the driver within, or check the lengths{} [dead-point]",
                              words(range, kind), model_.space == Space::spatial ? " and the axes of the joints" : "");
  }

  // With the driver's joint leading: its row depends on those of the joints that hold it.
  std::string what_locks(int driven) {
    const ClosedMechanism::Rows rows = mechanism_.position_rows();
    const RowSvd ranks(rows);
    const auto lead = std::ranges::find(rows.lead, driven) - rows.lead.begin();
    const auto dependent = ranks.svd.u.rightCols(ranks.svd.u.cols() - ranks.rank);
    std::vector<int> joints = joints_under(dependent * dependent.row(lead).transpose(), rows, mechanism_);
    std::erase(joints, driven);
    return joints.empty() ? "the mechanism holds"
                          : fmt::format("{} {}", joint_names(joints, model_), joints.size() == 1 ? "holds" : "hold");
  }

  const Model& model_;
  const Settings& settings_;
  ClosedMechanism mechanism_;
  double t_;
  std::vector<int> drivers_;
};

}  // namespace

std::optional<std::string> why_out_of_reach(const System& system, const State& start, double t) {
  try {
    if (auto text = Reach(system, start, t).why()) return text;
    const std::optional<DeadStart> dead = dead_start(system, start);
    if (!dead) return std::nullopt;
    return fmt::format("t = {:.9g} s: {} [dead-point]", t, words(*dead, system.model()));
  } catch (const Error&) {
    return std::nullopt;  // a joint or a driver that cannot answer there has been reported already
  }
}

double out_of_reach_from(const System& system, const State& start) {
  try {
    return Reach(system, start, system.model().settings.end).torn_from();
  } catch (const Error&) {
    return never;
  }
}

}  // namespace freeplay
