#include "stage/independent_rows.h"

#include <algorithm>

namespace freeplay {

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
  if (rank_of_.analyse(entries_, error) > rank_) adopt();
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
