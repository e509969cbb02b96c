#include "assembly/contradiction.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <fmt/format.h>

#include "assembly/even_spread.h"
#include "assembly/loop_gap.h"
#include "assembly/loop_sides.h"
#include "base/disjoint_sets.h"
#include "base/index.h"
#include "linear/row_solutions.h"
#include "model/force_element.h"

namespace freeplay {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int most_approach_steps = 60;
constexpr int few_starts = 10, many_starts = 40;
constexpr double longest_approach = 0.5;    // step: over the size of the model, and in rad
constexpr double level = 1e-3;              // slope of what is missed, by its size: no step makes it smaller
constexpr double closed_share = 1e-3;       // of the gap
constexpr double takes_no_part = 1e-3;      // share of what is missed in all
constexpr double most_operations = 5e8;     // about a second
constexpr double operations_of_rows = 1e3;  // that an evaluation takes, by velocity

using Kept = std::vector<char>;  // by condition

// Where Newton's method had thrown bodies far away: all positions made smaller.
std::vector<double> brought_near(const ClosedMechanism& mechanism) {
  std::vector<double> q(mechanism.state.q().begin(), mechanism.state.q().end());
  const std::size_t numbers = at(mechanism.system.layout().body_coordinates());
  const std::size_t ways = mechanism.model().space == Space::planar ? 2 : 3;
  const double part = std::min(1.0, 2.0 * mechanism.system.size() / farthest_body(mechanism));
  for (std::size_t i = 0; i < q.size(); ++i) {
    if (i % numbers < ways) q[i] *= part;
  }
  return q;
}

/// Whether some of the conditions hold together, as far as Newton's method finds out.
class Fulfilment {
 public:
  Fulfilment(ClosedMechanism& mechanism, double closed)
      : mechanism_(mechanism),
        system_(mechanism.system),
        closed_(std::max(closed, mechanism.model().settings.assembly_tolerance / mechanism.system.size())),
        q_(mechanism.state.q().begin(), mechanism.state.q().end()),
        h_(mechanism.state.h().begin(), mechanism.state.h().end()),
        near_(brought_near(mechanism)) {
    const ClosedMechanism::Rows rows = mechanism.position_rows();
    list_conditions(rows);
    for (const char length : rows_of_lengths(mechanism, rows)) unit_of_row_.push_back(length ? system_.size() : 1.0);
    unit_.resize(system_.layout().nv());
    for (int i = 0; i < static_cast<int>(unit_.size()); ++i) {
      unit_[i] = system_.coordinates().is_turn(i) ? 1.0 : system_.size();
    }
  }
  ~Fulfilment() {
    put(q_);
    mechanism_.position_rows();
  }
  Fulfilment(const Fulfilment&) = delete;
  Fulfilment& operator=(const Fulfilment&) = delete;

  const std::vector<Condition>& conditions() const { return conditions_; }
  bool too_long() const { return operations_ > most_operations; }

  /// From where the mechanism stood and from positions with all bodies turned. Where they do not hold, `missed` becomes
  /// those that are missed where the least is.
  bool holds(const Kept& kept, int starts, Kept& missed) {
    double least = -1.0;
    missed.assign(conditions_.size(), 0);
    for (int start = 0; start < starts && !too_long(); ++start) {
      put(turned(start));
      const VectorXd miss = approach(kept);
      if (miss.lpNorm<Eigen::Infinity>() <= closed_) return true;
      if (least >= 0.0 && !(miss.norm() < least)) continue;
      least = miss.norm();
      missed.assign(conditions_.size(), 0);
      for (std::size_t i = 0; i < chosen_.size(); ++i) {
        if (std::abs(miss[static_cast<Eigen::Index>(i)]) > takes_no_part * miss.lpNorm<Eigen::Infinity>())
          missed[of_row_[chosen_[i]]] = 1;
      }
    }
    return false;
  }

 private:
  void list_conditions(const ClosedMechanism::Rows& rows) {
    const Layout& layout = system_.layout();
    const auto add = [&](Condition::Kind kind, int index) {
      const bool known = !conditions_.empty() && conditions_.back().kind == kind && conditions_.back().index == index;
      if (!known) conditions_.push_back({kind, index});
      of_row_.push_back(conditions_.size() - 1);
    };
    const auto element_of = [&](int row) {
      for (int j = 0; row < layout.first_driver_row(); ++j) {
        const Slice own = layout.rows(j);
        if (row >= own.offset && row < own.offset + own.size) return Condition{Condition::Kind::joint, j};
      }
      int d = 0;
      while (layout.driver_row(d) != row) ++d;
      return Condition{Condition::Kind::driver, d};
    };
    int lead = 0;
    for (std::size_t i = 0; i < rows.row.size(); ++i) {
      if (rows.row[i] >= 0) {
        const Condition own = element_of(rows.row[i]);
        add(own.kind, own.index);
      } else if (rows.path[i] >= 0) {
        add(Condition::Kind::path, mechanism_.paths[at(rows.path[i])].kinematics);
      } else {
        add(Condition::Kind::start, lead++);
      }
    }
  }

  void put(const std::vector<double>& q) {
    std::ranges::copy(q, mechanism_.state.q().begin());
    std::ranges::copy(h_, mechanism_.state.h().begin());
  }

  std::vector<double> turned(int start) const {
    if (start == 0) return near_;
    constexpr double turns[] = {0.3, 1.0, std::numbers::pi};
    std::vector<double> q = near_;
    system_.coordinates().retract(near_, spread_turns(system_, turns[start % 3], start - 1), q);
    return q;
  }

  // Of the chosen rows.
  VectorXd miss_of_rows(const ClosedMechanism::Rows& rows) const {
    VectorXd miss(static_cast<Eigen::Index>(chosen_.size()));
    for (std::size_t i = 0; i < chosen_.size(); ++i) {
      miss[static_cast<Eigen::Index>(i)] =
          rows.residual[static_cast<Eigen::Index>(chosen_[i])] / unit_of_row_[chosen_[i]];
    }
    return miss;
  }

  // Levenberg and Marquardt.
  VectorXd approach(const Kept& kept) {
    chosen_.clear();
    for (std::size_t i = 0; i < of_row_.size(); ++i) {
      if (kept[of_row_[i]]) chosen_.push_back(i);
    }
    const std::span<double> q = mechanism_.state.q();
    ClosedMechanism::Rows rows = mechanism_.position_rows();
    VectorXd miss = miss_of_rows(rows);
    double damping = 1.0;
    for (int step = 0; step < most_approach_steps && miss.norm() > 1e-3 * closed_; ++step) {
      const MatrixXd j = slopes(rows);
      const VectorXd down = j.transpose() * miss;
      if (down.norm() <= level * miss.norm() * std::min(1.0, j.norm())) break;
      const bool wide = j.rows() <= j.cols();
      const double size = static_cast<double>(std::min(j.rows(), j.cols()));
      operations_ += size * size * static_cast<double>(std::max(j.rows(), j.cols())) +
                     operations_of_rows * static_cast<double>(system_.layout().nv());
      MatrixXd normal = wide ? MatrixXd(j * j.transpose()) : MatrixXd(j.transpose() * j);
      normal.diagonal().array() += damping * miss.norm() + 1e-12 * normal.diagonal().maxCoeff();
      VectorXd increment = wide ? VectorXd(-(j.transpose() * symmetric_solution(normal, miss)))
                                : VectorXd(-symmetric_solution(normal, down));
      increment *= std::min(1.0, longest_approach / increment.lpNorm<Eigen::Infinity>());
      increment = increment.cwiseProduct(unit_).eval();
      const std::vector<double> before(q.begin(), q.end());
      system_.coordinates().retract(before, {increment.data(), at(static_cast<int>(increment.size()))}, q);
      ClosedMechanism::Rows there = mechanism_.position_rows();
      const VectorXd left = miss_of_rows(there);
      if (left.norm() < miss.norm()) {
        rows = std::move(there), miss = left, damping *= 0.3;
      } else {
        std::ranges::copy(before, q.begin());
        damping *= 5.0;
        if (damping > 1e6) break;
      }
    }
    return miss;
  }

  MatrixXd slopes(const ClosedMechanism::Rows& rows) const {
    std::vector<int> place(of_row_.size(), -1);
    for (std::size_t i = 0; i < chosen_.size(); ++i) place[chosen_[i]] = static_cast<int>(i);
    MatrixXd j = MatrixXd::Zero(static_cast<Eigen::Index>(chosen_.size()), rows.matrix.cols());
    for (Eigen::Index column = 0; column < rows.matrix.cols(); ++column) {
      for (SparseMatrix::InnerIterator entry(rows.matrix, column); entry; ++entry) {
        const int i = place[static_cast<std::size_t>(entry.row())];
        if (i >= 0) j(i, column) = entry.value() * unit_[column] / unit_of_row_[static_cast<std::size_t>(entry.row())];
      }
    }
    return j;
  }

  ClosedMechanism& mechanism_;
  const System& system_;
  double closed_;
  std::vector<double> q_, h_, near_;
  std::vector<Condition> conditions_;
  std::vector<std::size_t> of_row_, chosen_;
  std::vector<double> unit_of_row_;
  VectorXd unit_;
  double operations_ = 0.0;
};

/// Leaves conditions out, one after the other, while the rest still contradict each other.
class Reduction {
 public:
  Reduction(ClosedMechanism& mechanism, int open, double gap)
      : mechanism_(mechanism),
        model_(mechanism.model()),
        fulfilment_(mechanism, closed_share * gap),
        conditions_(fulfilment_.conditions()),
        kept_(conditions_.size(), 1),
        open_(open) {}

  // Which are left over depends on the order: the fewest of two.
  std::vector<Condition> fewest() {
    leave_out_chains(kept_);
    Kept missed;
    if (fulfilment_.holds(kept_, few_starts, missed)) return {};
    take_if_open(missed);
    const Kept all = kept_;
    const Kept first = reduced(by_distance());
    kept_ = all;
    const Kept second = reduced(by_place());
    kept_ = std::ranges::count(second, 1) < std::ranges::count(first, 1) ? second : first;
    if (fulfilment_.holds(kept_, many_starts, missed) || fulfilment_.too_long()) return {};
    std::vector<Condition> found;
    for (std::size_t i = 0; i < conditions_.size(); ++i) {
      if (kept_[i]) found.push_back(conditions_[i]);
    }
    return found;
  }

 private:
  bool is_open(std::size_t i) const {
    return conditions_[i].kind == Condition::Kind::joint && conditions_[i].index == open_;
  }

  // Where the least is missed, conditions that hold take no part in what the others contradict.
  void take_if_open(Kept missed) {
    for (std::size_t i = 0; i < kept_.size(); ++i) {
      if (missed[i]) continue;
      missed[i] = kept_[i] && is_open(i);
    }
    for (std::size_t i = 0; i < kept_.size(); ++i) {
      if (!missed[i]) drop(i, missed);
    }
    leave_out_chains(missed);
    Kept ignored;
    if (missed != kept_ && std::ranges::count(missed, 1) > 0 && !fulfilment_.holds(missed, few_starts, ignored))
      kept_ = missed;
  }

  // Joints last, as what they alone contradict says more.
  Kept reduced(const std::vector<std::size_t>& order) {
    for (const bool joints : {false, true}) {
      for (const std::size_t i : order) {
        if (is_joint(i) == joints) leave_out(i);
      }
    }
    return kept_;
  }
  void leave_out(std::size_t i) {
    if (!kept_[i] || is_open(i) || fulfilment_.too_long()) return;
    Kept rest = kept_, missed;
    drop(i, rest);
    leave_out_chains(rest);
    if (std::ranges::count(rest, 1) == 0 || fulfilment_.holds(rest, few_starts, missed)) return;
    kept_ = rest;
    take_if_open(missed);
  }
  bool is_joint(std::size_t i) const {
    return conditions_[i].kind == Condition::Kind::joint && model_.joints[at(conditions_[i].index)].gear < 0;
  }

  std::vector<std::size_t> by_place() const {
    std::vector<std::size_t> order(conditions_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    return order;
  }

  // From those that are most joints away from the open one on, of equal ones from the end of the file on.
  std::vector<std::size_t> by_distance() const {
    std::vector<std::size_t> away(model_.bodies.size() + 1, model_.joints.size()), order;
    const auto nearer = [&](int j) -> std::size_t {
      const JointElement& joint = model_.joints[at(j)];
      return std::min(away[at(body_at(joint.marker_a))], away[at(body_at(joint.marker_b))]);
    };
    if (open_ >= 0) away[at(body_at(model_.joints[at(open_)].marker_a))] = 0;
    if (open_ >= 0) away[at(body_at(model_.joints[at(open_)].marker_b))] = 0;
    for (std::size_t round = 0; round < model_.bodies.size(); ++round) {
      for (int j = 0; j < static_cast<int>(model_.joints.size()); ++j) {
        const JointElement& joint = model_.joints[at(j)];
        if (joint.gear >= 0 || is_force_element(joint)) continue;
        for (const int marker : {joint.marker_a, joint.marker_b}) {
          std::size_t& there = away[at(body_at(marker))];
          there = std::min(there, nearer(j) + 1);
        }
      }
    }
    for (std::size_t far = model_.joints.size() + 1; far-- > 0;) {
      for (std::size_t i = conditions_.size(); i-- > 0;) {
        if ((is_joint(i) ? nearer(conditions_[i].index) : 0) == far) order.push_back(i);
      }
    }
    return order;
  }

  /// Joints whose coordinates a condition holds.
  std::vector<int> led_by(const Condition& condition) const {
    if (condition.kind == Condition::Kind::driver) return {model_.drivers[at(condition.index)].joint};
    if (condition.kind == Condition::Kind::start) return {mechanism_.leads[at(condition.index)].joint};
    if (condition.kind == Condition::Kind::path) return {};
    const int gear = model_.joints[at(condition.index)].gear;
    if (gear < 0) return {};
    return {model_.gears[at(gear)].first, model_.gears[at(gear)].second};
  }

  // A joint with all that is said of its coordinate.
  void drop(std::size_t i, Kept& kept) const {
    kept[i] = 0;
    if (conditions_[i].kind != Condition::Kind::joint) return;
    for (std::size_t other = 0; other < kept.size(); ++other) {
      if (kept[other] && std::ranges::count(led_by(conditions_[other]), conditions_[i].index) > 0) drop(other, kept);
    }
  }

  void unite(std::size_t i, DisjointSets& bodies) const {
    const Condition& condition = conditions_[i];
    const auto join = [&](int j) {
      const JointElement& joint = model_.joints[at(j)];
      bodies.unite(body_at(joint.marker_a), body_at(joint.marker_b));
    };
    const std::vector<int> led = led_by(condition);
    for (const int j : led) join(j);
    if (led.size() == 2) {
      bodies.unite(body_at(model_.joints[at(led[0])].marker_a), body_at(model_.joints[at(led[1])].marker_a));
    } else if (led.empty() && condition.kind == Condition::Kind::joint) {
      join(condition.index);
    }
  }
  int body_at(int marker) const { return model_.markers[at(marker)].body + 1; }

  // Bodies that hang on the others by one joint can follow them anywhere.
  void leave_out_chains(Kept& kept) const {
    for (std::size_t i = 0; i < kept.size(); ++i) {
      if (!kept[i] || !is_joint(i)) continue;
      DisjointSets bodies(static_cast<int>(model_.bodies.size()) + 1);
      for (std::size_t other = 0; other < kept.size(); ++other) {
        if (other == i || !kept[other]) continue;
        if (conditions_[other].kind == Condition::Kind::path) return;
        unite(other, bodies);
      }
      const JointElement& own = model_.joints[at(conditions_[i].index)];
      if (!bodies.together(body_at(own.marker_a), body_at(own.marker_b))) drop(i, kept);
    }
  }

  ClosedMechanism& mechanism_;
  const Model& model_;
  Fulfilment fulfilment_;
  const std::vector<Condition>& conditions_;
  Kept kept_;
  int open_;
};

}  // namespace

std::vector<Condition> contradiction(ClosedMechanism& mechanism, int open, double gap) {
  if (mechanism.system.layout().nv() > 200) return {};
  return Reduction(mechanism, open, gap).fewest();
}

std::string words(const std::vector<Condition>& conditions, const ClosedMechanism& mechanism) {
  const Model& model = mechanism.model();
  std::vector<std::string> joints, others, bodies;
  const auto add_body = [&](int marker) {
    const BodyId body = model.markers[at(marker)].body;
    if (body == ground) return;
    const std::string name = fmt::format("'{}'", model.bodies[at(body)].name);
    if (std::ranges::count(bodies, name) == 0) bodies.push_back(name);
  };
  for (const Condition& one : conditions) {
    if (one.kind == Condition::Kind::driver) {
      const Driver& driver = model.drivers[at(one.index)];
      others.push_back(driver.kind == DriverKind::velocity
                           ? fmt::format("the start value of '{}'", model.joints[at(driver.joint)].name)
                           : fmt::format("driver '{}'", driver.name));
    }
    if (one.kind == Condition::Kind::start)
      others.push_back(
          fmt::format("the start value of '{}'", model.joints[at(mechanism.leads[at(one.index)].joint)].name));
    if (one.kind == Condition::Kind::path)
      others.push_back(fmt::format("the path of '{}'", model.kinematics[at(one.index)].name));
    if (one.kind != Condition::Kind::joint) continue;
    const JointElement& joint = model.joints[at(one.index)];
    joints.push_back(fmt::format("'{}'", joint.name));
    if (joint.gear >= 0) continue;
    add_body(joint.marker_a);
    add_body(joint.marker_b);
  }
  if (!joints.empty())
    others.insert(others.begin(), fmt::format("{} {}", joints.size() == 1 ? "joint" : "joints", enumerated(joints)));
  return fmt::format(
      "{} contradict each other{}", enumerated(others),
      bodies.empty() ? "" : fmt::format(" ({} {})", bodies.size() == 1 ? "body" : "bodies", enumerated(bodies)));
}

}  // namespace freeplay
