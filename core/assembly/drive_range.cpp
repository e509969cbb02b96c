#include "assembly/drive_range.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Dense>
#include <fmt/format.h>

#include "assembly/loop_gap.h"
#include "assembly/start_branches.h"
#include "base/index.h"

namespace freeplay {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

// In rad, and over the size of the model.
constexpr double first_step = 0.02, longest_step = 0.1, shortest_step = 1e-7;
constexpr double longest_way = 0.4;     // of a body in one step: beyond, it has leapt
constexpr double locked = 1e-5;         // range: a mechanism that moves nowhere, to what limits are sought to
constexpr double close_to_limit = 0.1;  // of a run that ends before it: forces grow without bound there
constexpr int instants = 4000;          // of a run that are looked at
constexpr int most_pieces = 4000;       // of the way of several drivers
constexpr int most_unknowns = 200;
// By singular values of the rows.
constexpr double full_rank = 1e-6;   // of the largest
constexpr double lost_rank = 1e-4;   // of what it is beside a dead point
constexpr double takes_part = 1e-3;  // share of a joint in the stress that its rows add up to

double largest_move(const System& system, std::span<const double> from, std::span<const double> to) {
  std::vector<double> increment(at(system.layout().nv()));
  system.coordinates().difference(from, to, increment);
  double largest = 0.0;
  for (int i = 0; i < static_cast<int>(increment.size()); ++i) {
    largest = std::max(largest, std::abs(increment[at(i)]) / (system.coordinates().is_turn(i) ? 1.0 : system.size()));
  }
  return largest;
}

// A small step of what is prescribed; where the mechanism does not follow it is put back.
template <class Prescribe>
bool follow(ClosedMechanism& mechanism, Prescribe&& prescribe) {
  const std::vector<double> q(mechanism.state.q().begin(), mechanism.state.q().end());
  const std::vector<double> h(mechanism.state.h().begin(), mechanism.state.h().end());
  prescribe();
  if (mechanism.holds(mechanism.converge()) && largest_move(mechanism.system, q, mechanism.state.q()) <= longest_way) {
    for (int j = 0; j < static_cast<int>(mechanism.model().joints.size()); ++j) {
      const int turn = mechanism.system.layout().turn(j);
      if (turn >= 0) mechanism.state.h()[at(turn)] = mechanism.e.coordinate[at(j)];
    }
    return true;
  }
  std::ranges::copy(q, mechanism.state.q().begin());
  std::ranges::copy(h, mechanism.state.h().begin());
  return false;
}

// Newton cannot follow from a singular position, where the mechanism may go on in two ways: it is sought from positions
// around, whose turns are spread by the golden ratio. False, and all as before, where there is no way on.
bool leave_dead_point(ClosedMechanism& mechanism, double sign) {
  ClosedMechanism::Lead& lead = mechanism.leads.back();
  const std::vector<double> q(mechanism.state.q().begin(), mechanism.state.q().end());
  const bool turns = mechanism.system.joint_layout(lead.joint).coordinate == Coordinate::angle;
  const double start = lead.value, unit = turns ? 1.0 : mechanism.system.size();
  for (const double part : {1.0, 0.1, 0.01}) {
    for (const double turn : {0.0, 0.1, -0.1, 0.3, -0.3}) {
      std::vector<double> increment(at(mechanism.system.layout().nv()), 0.0);
      for (int i = 0, turned = 0; i < static_cast<int>(increment.size()); ++i) {
        if (!mechanism.system.coordinates().is_turn(i)) continue;
        const double share = static_cast<double>(++turned) * 0.6180339887498949;
        increment[at(i)] = turn * (2.0 * (share - std::floor(share)) - 1.0);
      }
      mechanism.system.coordinates().retract(q, increment, mechanism.state.q());
      lead.value = start + sign * part * first_step * unit;
      if (mechanism.holds(mechanism.converge()) &&
          largest_move(mechanism.system, q, mechanism.state.q()) <= longest_way) {
        return true;
      }
    }
  }
  std::ranges::copy(q, mechanism.state.q().begin());
  lead.value = start;
  mechanism.position_rows();
  return false;
}

// The last coordinate of the way in one direction, +-infinity where it does not end.
double limit(ClosedMechanism& mechanism, double sign) {
  ClosedMechanism::Lead& lead = mechanism.leads.back();
  const bool turns = mechanism.system.joint_layout(lead.joint).coordinate == Coordinate::angle;
  const double unit = turns ? 1.0 : mechanism.system.size();
  const double whole = turns ? 2.0 * std::numbers::pi : 3.0 * unit, start = lead.value;
  double step = first_step * unit;
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
    step = first_step * unit;
  }
  return sign * infinite;
}

// Of the rows that hold and lead.
struct Ranks {
  explicit Ranks(const Eigen::MatrixXd& rows) : svd(rows, Eigen::ComputeFullU) {
    const Eigen::VectorXd& values = svd.singularValues();
    while (rank < values.size() && values[rank] > full_rank * values[0]) ++rank;
  }
  Eigen::BDCSVD<Eigen::MatrixXd> svd;
  Eigen::Index rank = 0;
};

// Joints whose rows take part in a state of stress without load.
std::vector<int> joints_under(const Eigen::VectorXd& stress, const ClosedMechanism::Rows& rows,
                              const ClosedMechanism& mechanism) {
  std::vector<int> joints;
  for (int j = 0; j < static_cast<int>(mechanism.model().joints.size()); ++j) {
    const Slice own = mechanism.system.layout().rows(j);
    double share = 0.0;
    for (std::size_t r = 0; r < rows.row.size(); ++r) {
      if (rows.row[r] < own.offset || rows.row[r] >= own.offset + own.size) continue;
      share = std::max(share, std::abs(stress[static_cast<Eigen::Index>(r)]));
    }
    if (share > takes_part * stress.lpNorm<Eigen::Infinity>()) joints.push_back(j);
  }
  return joints;
}

class Reach {
 public:
  Reach(const System& system, const State& start, double t)
      : model_(system.model()), settings_(model_.settings), mechanism_(system), t_(t) {
    mechanism_.system.take_start_of(system);
    std::ranges::copy(start.q(), mechanism_.state.q().begin());
    for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
      const int turn = mechanism_.system.layout().turn(j), own = system.layout().turn(j);
      if (turn >= 0 && own >= 0) mechanism_.state.h()[at(turn)] = start.h()[at(own)];
    }
    for (int d = 0; d < static_cast<int>(model_.drivers.size()); ++d) {
      const Driver& driver = model_.drivers[at(d)];
      if (prescribes(driver.kind) && driver.kinematics < 0) drivers_.push_back(d);
    }
  }

  std::optional<std::string> why() {
    if (drivers_.empty() || mechanism_.system.layout().nv() > most_unknowns) return std::nullopt;
    if (!mechanism_.holds(mechanism_.converge())) return std::nullopt;
    if (drivers_.size() > 1 && !go_to_end_of_way()) return std::nullopt;
    for (const int driver : drivers_) {
      if (auto text = why_of(driver)) return text;
    }
    return std::nullopt;
  }

  // The time from which even play does not bridge the gap.
  double torn_from() {
    if (drivers_.size() != 1 || mechanism_.system.layout().nv() > most_unknowns) return infinite;
    if (!mechanism_.holds(mechanism_.converge())) return infinite;
    const int driver = drivers_.front();
    double torn = infinite;
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
      double inside = 0.0, outside = most->out;
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
    double time = infinite, beyond = 0.0;
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
        if (exit.time < infinite) break;
        continue;
      }
      if (exit.time == infinite) exit.time = t, exit.up = s > range.to;
      exit.beyond = std::max(exit.beyond, out);
    }
    if (exit.time == infinite) return std::nullopt;
    return exit;
  }

  double time_of(int driver, double value_there, bool up) const {
    for (int i = 0; i <= instants; ++i) {
      const double s = value(driver, instant(i));
      if (up ? s >= value_there : s <= value_there) return instant(i);
    }
    return infinite;
  }

  // Where a driver opens the loops most on its way beyond the end of a range, and by how much; `out` counts from there.
  struct Widest {
    double out = 0.0;
    LoopGap gap{};
  };

  std::optional<Widest> widest(const DriveRange& range, const Exit& exit) {
    const double whole = 2.0 * std::numbers::pi;
    const bool comes_round =
        mechanism_.system.joint_layout(mechanism_.leads.back().joint).coordinate == Coordinate::angle &&
        range.from > -infinite && range.to < infinite;
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
    for (double step = 0.5 * way / pieces; best && step > 1e-3 * way; step *= 0.5) {
      const double from = best->out;
      for (const double out : {from - step, from + step}) {
        if (out > 0.0 && out <= way) look(out);
      }
    }
    return best;
  }

  Coordinate coordinate(int driver) const {
    return model_.joints[at(model_.drivers[at(driver)].joint)].ideal_layout.coordinate;
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

  std::string sentence(int d, const DriveRange& range, const Exit& exit) {
    const Driver& driver = model_.drivers[at(d)];
    const Coordinate kind = coordinate(d);
    const double end = exit.up ? range.to : range.from;
    const std::optional<Widest> most = widest(range, exit);
    if (range.to - range.from <= locked * unit(d)) {
      return fmt::format(
          "t = {:.9g} s: driver '{}' cannot move joint '{}' beyond the play: {} it at {}; does each of them hold the "
          "bodies that are meant, and do lengths and angles let the loop move [locked]",
          t_, driver.name, model_.joints[at(driver.joint)].name, what_locks(driver.joint), words(end, kind));
    }
    std::string text = fmt::format(
        "t = {:.9g} s: driver '{}' asks for a position that the mechanism cannot take: joint '{}' comes to a dead "
        "point "
        "at {}",
        t_, driver.name, model_.joints[at(driver.joint)].name, words(end, kind));
    if (most) {
      text += fmt::format(", and at {} joint '{}' would stay open by {:.4g} m",
                          words(end + (exit.up ? most->out : -most->out), kind),
                          model_.joints[at(most->gap.joint)].name, most->gap.size);
    }
    return text +
           fmt::format("; it can {}: keep the driver within, or check the lengths [dead-point]", words(range, kind));
  }

  // With the driver's joint leading: its row depends on those of the joints that hold it.
  std::string what_locks(int driven) {
    const ClosedMechanism::Rows rows = mechanism_.position_rows();
    const Ranks ranks{Eigen::MatrixXd(rows.matrix)};
    const auto lead = std::ranges::find(rows.lead, driven) - rows.lead.begin();
    const auto dependent = ranks.svd.matrixU().rightCols(ranks.svd.matrixU().cols() - ranks.rank);
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
  if (mechanism.system.layout().nv() > most_unknowns) return std::nullopt;
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

std::optional<DeadStart> dead_start(const System& system, const State& start) {
  ClosedMechanism mechanism(system);
  const Model& model = mechanism.model();
  if (mechanism.system.layout().nv() > most_unknowns) return std::nullopt;
  mechanism.system.take_start_of(system);
  std::ranges::copy(start.q(), mechanism.state.q().begin());
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    const int turn = mechanism.system.layout().turn(j), own = system.layout().turn(j);
    if (turn >= 0 && own >= 0) mechanism.state.h()[at(turn)] = start.h()[at(own)];
  }
  mechanism.position_rows();
  std::vector<int> drivers;
  for (int d = 0; d < static_cast<int>(model.drivers.size()); ++d) {
    const Driver& driver = model.drivers[at(d)];
    if (!prescribes(driver.kind) || driver.kinematics >= 0) continue;
    drivers.push_back(d);
    mechanism.held_row[at(mechanism.system.layout().driver_row(d))] = 0;
    mechanism.leads.push_back({driver.joint, mechanism.e.coordinate[at(driver.joint)]});
  }
  if (drivers.empty()) return std::nullopt;
  const ClosedMechanism::Rows rows = mechanism.position_rows();
  if (!mechanism.holds(rows)) return std::nullopt;
  const Ranks here{Eigen::MatrixXd(rows.matrix)};
  const Eigen::VectorXd& values = here.svd.singularValues();
  if (rows.matrix.rows() <= values.size() && values[values.size() - 1] > lost_rank * values[0]) return std::nullopt;
  const std::vector<double> q(mechanism.state.q().begin(), mechanism.state.q().end());
  const std::vector<ClosedMechanism::Lead> leads = mechanism.leads;
  for (std::size_t i = 0; i < leads.size(); ++i) {
    for (const double sign : {1.0, -1.0}) {
      mechanism.leads = leads;
      std::swap(mechanism.leads[i], mechanism.leads.back());
      std::ranges::copy(q, mechanism.state.q().begin());
      if (!leave_dead_point(mechanism, sign)) continue;
      std::swap(mechanism.leads[i], mechanism.leads.back());
      const Ranks there{Eigen::MatrixXd(mechanism.position_rows().matrix)};
      const Eigen::Index last = there.rank - 1;
      if (last < 0 || !(values[last] < lost_rank * there.svd.singularValues()[last])) continue;
      DeadStart found{drivers[i], {}};
      // The state of stress without load that is there and not beside it.
      Eigen::VectorXd stress = here.svd.matrixU().col(last);
      const auto always = there.svd.matrixU().rightCols(there.svd.matrixU().cols() - there.rank);
      stress -= always * (always.transpose() * stress);
      found.joints = joints_under(stress, rows, mechanism);
      return found;
    }
  }
  return std::nullopt;
}

std::string words(const DeadStart& start, const Model& model) {
  const Driver& driver = model.drivers[at(start.driver)];
  const std::string joints = joint_names(start.joints, model);
  return fmt::format(
      "driver '{}' starts joint '{}' at a dead point{}: nothing says which of two ways the mechanism goes "
      "on, or it cannot go as it is driven; start beside it, or drive another joint",
      driver.name, model.joints[at(driver.joint)].name,
      joints.empty() ? std::string{} : fmt::format(", where {} hold links in line", joints));
}

std::string joint_names(std::span<const int> joints, const Model& model) {
  constexpr std::size_t most = 6;
  std::string text;
  for (std::size_t i = 0; i < std::min(joints.size(), most); ++i) {
    text += fmt::format("{}'{}'", text.empty() ? "" : ", ", model.joints[at(joints[i])].name);
  }
  if (joints.size() > most) text += fmt::format(" and {} others", joints.size() - most);
  if (text.empty()) return text;
  return (joints.size() == 1 ? "joint " : "joints ") + text;
}

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
    return infinite;
  }
}

}  // namespace freeplay
