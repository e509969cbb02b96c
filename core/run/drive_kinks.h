// DriveKinks: when the speed or acceleration that a driver prescribes may jump, or a load.
#pragma once

#include <vector>

#include "base/formula_course.h"
#include "model/model.h"

namespace freeplay {

/// Kinks of expressions, ends of tables and points of straight ones, found as a run goes on.
class DriveKinks {
 public:
  enum class Of { motions, loads };
  /// `model` must live as long as this. Of prescribed motions, or of efforts and applied forces.
  explicit DriveKinks(const Model& model, Of of = Of::motions);

  /// Whether there can be one.
  bool any() const { return !formulas_.empty() || !tables_.empty(); }
  /// The first kink after t, if it is `until` or earlier; else a later time, or infinity. Times grow from step to step.
  double next(double t, double until);
  /// Whether a formula has one at the very end of the run, which next() need not see: nothing changes its sign before.
  bool one_at_end() const { return one_at_end_; }

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.formulas_);
  }

 private:
  [[gnu::cold]] void add(const Expression& expression, const Settings& settings);

  std::vector<FormulaCourse> formulas_;
  std::vector<const TimeTable*> tables_;
  bool one_at_end_ = false;
};

}  // namespace freeplay
