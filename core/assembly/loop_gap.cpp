#include "assembly/loop_gap.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "assembly/even_spread.h"
#include "base/index.h"
#include "linear/stacked_rows.h"

namespace freeplay {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int most_steps = 200;
constexpr double longest = 0.3;         // step: over the size of the model, and in rad
constexpr double last = 1e-9;           // step, likewise
constexpr double closed_enough = 1e-6;  // of the size: rows that hold while one joint is open
constexpr double clearly_more = 1.01;

class Opening {
 public:
  explicit Opening(ClosedMechanism& mechanism) : mechanism_(mechanism), system_(mechanism.system) {}

  // Rows of joints but for gears, those of one joint, or none.
  using Choice = std::vector<Eigen::Index>;
  Choice rows_of(const ClosedMechanism::Rows& rows, int joint, bool inside) const {
    Choice chosen;
    for (std::size_t i = 0; i < rows.row.size(); ++i) {
      const int r = rows.row[i];
      const bool any = r >= 0 && r < system_.layout().first_driver_row();
      const Slice slice = joint < 0 ? Slice{0, system_.layout().first_driver_row()} : system_.layout().rows(joint);
      const bool own = any && r >= slice.offset && r < slice.offset + slice.size;
      if (own == inside) chosen.push_back(static_cast<Eigen::Index>(i));
    }
    return chosen;
  }

  // Moves to where the rows of a joint (-1: of all joints) miss least while all others hold; what the two miss.
  std::pair<double, double> settle(int joint) {
    const std::span<double> q = mechanism_.state.q();
    const auto columns = static_cast<Eigen::Index>(system_.layout().nv());
    double open = 0.0, others = 0.0;
    for (int step = 0; step < most_steps; ++step) {
      const ClosedMechanism::Rows rows = mechanism_.position_rows();
      mechanism_.keep_turns();
      const Choice own = rows_of(rows, joint, true), rest = rows_of(rows, joint, false);
      const MatrixXd all = rows.matrix;
      const VectorXd miss = rows.residual(own), rest_miss = rows.residual(rest);
      open = miss.norm();
      others = rest.empty() ? 0.0 : rest_miss.lpNorm<Eigen::Infinity>();
      // The curvature that Gauss and Newton leave out is that of circles of the model's size.
      const double damping = std::sqrt(open * system_.size());
      MatrixXd damped = MatrixXd::Zero(static_cast<Eigen::Index>(own.size()) + columns, columns);
      damped.topRows(static_cast<Eigen::Index>(own.size())) = all(own, Eigen::all);
      for (int i = 0; i < static_cast<int>(columns); ++i) {
        damped(static_cast<Eigen::Index>(own.size()) + i, i) =
            system_.coordinates().is_turn(i) ? damping : damping / system_.size();
      }
      VectorXd wanted = VectorXd::Zero(damped.rows());
      wanted.head(static_cast<Eigen::Index>(own.size())) = -miss;
      StackedRows stack(columns);
      stack.add(all(rest, Eigen::all), -rest_miss);
      stack.add(damped, wanted);
      VectorXd increment = stack.solution();
      double size = 0.0;
      for (int i = 0; i < static_cast<int>(columns); ++i) {
        size = std::max(size, std::abs(increment[i]) / (system_.coordinates().is_turn(i) ? 1.0 : system_.size()));
      }
      if (!(size > last)) break;
      increment *= std::min(1.0, longest / size);
      const std::vector<double> before(q.begin(), q.end());
      system_.coordinates().retract(before, {increment.data(), at(static_cast<int>(columns))}, q);
    }
    return {open, others};
  }

  // One that something leads is named where no other misses as much.
  int worst_joint() const {
    const ClosedMechanism::Rows rows = mechanism_.position_rows();
    const auto leads = [&](int j) {
      return std::ranges::count(mechanism_.leads, j, &ClosedMechanism::Lead::joint) > 0;
    };
    int worst = -1;
    double largest = 0.0;
    for (int j = 0; j < static_cast<int>(mechanism_.model().joints.size()); ++j) {
      if (mechanism_.model().joints[at(j)].gear >= 0 || system_.layout().rows(j).size == 0) continue;
      const double miss = rows.residual(rows_of(rows, j, true)).norm();
      const bool as_large = miss * clearly_more > largest && worst >= 0 && leads(worst) && !leads(j);
      if (miss > clearly_more * largest || as_large) largest = miss, worst = j;
    }
    return worst;
  }

 private:
  ClosedMechanism& mechanism_;
  const System& system_;
};

}  // namespace

double farthest_body(const ClosedMechanism& mechanism) {
  const std::span<const double> q = mechanism.state.q();
  const std::size_t width = at(mechanism.system.layout().body_coordinates());
  const std::size_t ways = mechanism.model().space == Space::planar ? 2 : 3;
  double most = 0.0;
  for (std::size_t first = 0; first + width <= q.size(); first += width) {
    double squares = 0.0;
    for (std::size_t i = first; i < first + ways; ++i) squares += q[i] * q[i];
    most = std::max(most, std::sqrt(squares));
  }
  return most;
}

std::optional<LoopGap> loop_gap(ClosedMechanism& mechanism) {
  if (mechanism.system.layout().nv() > 200) return std::nullopt;
  const std::vector<double> q(mechanism.state.q().begin(), mechanism.state.q().end());
  const std::vector<double> h(mechanism.state.h().begin(), mechanism.state.h().end());
  Opening opening(mechanism);
  std::optional<LoopGap> gap;
  // Links in line may stand folded where they should be stretched: the smallest of several ways to open.
  for (const double turn : {0.0, 0.2, 0.7, 1.5}) {
    mechanism.system.coordinates().retract(q, spread_turns(mechanism.system, turn), mechanism.state.q());
    std::ranges::copy(h, mechanism.state.h().begin());
    opening.settle(-1);
    const int joint = opening.worst_joint();
    if (joint < 0) continue;
    const auto [open, others] = opening.settle(joint);
    if (!(others <= closed_enough * std::max(1.0, mechanism.system.size()))) continue;
    if (farthest_body(mechanism) > LoopGap::far_away * std::max(mechanism.system.size(), open)) continue;
    if (!gap || open < (1.0 - 1e-6) * gap->size) {
      gap = LoopGap{joint, open, miss_of(joint, mechanism, mechanism.position_rows())};
    }
  }
  std::ranges::copy(q, mechanism.state.q().begin());
  std::ranges::copy(h, mechanism.state.h().begin());
  mechanism.position_rows();
  return gap;
}

}  // namespace freeplay
