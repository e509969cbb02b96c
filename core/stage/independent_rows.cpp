#include "stage/independent_rows.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"

namespace freeplay {
namespace {

// In a stage that is off the constraints the choice stays: loads and accelerations are then smooth within a step.
constexpr double on_constraints = 1e-10;
constexpr double far_more_independent = 4.0;  // volume of the rows, by that of those that are kept

}  // namespace

IndependentRows::IndependentRows(const ConstraintJacobian& jacobian)
    : jacobian_(jacobian), rank_of_(jacobian.layout().nc(), jacobian.layout().nv()) {
  dependent_.assign(static_cast<std::size_t>(jacobian.layout().nc()), 0);
}

bool IndependentRows::find(const ConstraintValues& e) {
  jacobian_.list(e.jacobian, entries_);
  rank_of_.analyse(entries_);
  return adopt();
}

void IndependentRows::find_more(const ConstraintValues& e, double error) {
  jacobian_.list(e.jacobian, entries_);
  error_ = error;
  const LeftOutRows now = express();
  if (now.rest > std::max(RowRank::tolerance, error) && rank_of_.analyse(entries_, error) > rank_) {
    adopt();
  } else if (error <= on_constraints) {
    exchange_rows(now);
  }
}

LeftOutRows IndependentRows::express() {
  expressed_choice_ = choice_;
  return rank_of_.express(entries_, dependent_, error_);
}

// Row by row: each exchange multiplies the volume of the rows that are kept (Gu and Eisenstat 1996, SIAM J Sci Comput
// 17, 848). In a singular position, where they have none, no exchange helps.
void IndependentRows::exchange_rows(LeftOutRows now) {
  for (std::size_t i = 0; i < dependent_.size() && now.largest > far_more_independent; ++i) {
    if (!std::isfinite(now.largest)) return;
    dependent_[at(now.kept)] = 1;
    dependent_[at(now.left_out)] = 0;
    ++choice_;
    now = express();
  }
}

void IndependentRows::least_norm(std::span<double> lambda) {
  if (expressed_choice_ != choice_) express();
  rank_of_.least_norm(lambda, jacobian_.layout().first_driver_row());
}

bool IndependentRows::adopt() {
  // Fewer than before: this is a singular position.
  if (rank_ >= 0 && rank_of_.rank() < rank_) regularity_ = last_regularity_ = 0.0;
  rank_ = rank_of_.rank();
  const bool same = std::ranges::equal(rank_of_.dependent(), dependent_);
  std::ranges::copy(rank_of_.dependent(), dependent_.begin());
  any_dependent_ = rank_ < jacobian_.layout().nc();
  if (!same) ++choice_;
  return !same;
}

int IndependentRows::weakest(const ConstraintValues& e) {
  jacobian_.list(e.jacobian, entries_);
  rank_of_.analyse(entries_);
  return rank_of_.weakest();
}

}  // namespace freeplay
