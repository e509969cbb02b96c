// Evaluation: results and work space of System::evaluate().
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "base/index.h"
#include "system/constraints.h"
#include "system/driven_motion.h"
#include "system/evaluation_context.h"
#include "system/fault.h"
#include "system/forces.h"
#include "system/motion_values.h"

namespace freeplay {

class System;

/// What the parts of the equations have found at one point. Sized once. `context` must outlive it; null: outside of a
/// run, where every joint is awake.
struct Evaluation : MarkerValues, JointValues, DriverValues, DrivenValues, ConstraintValues, ForceValues {
  explicit Evaluation(const System& system, EvaluationContext* context = nullptr);

  EvaluationContext* context = nullptr;
  Profile* profile() const { return context == nullptr ? nullptr : context->profile; }
  Fault fault;

  /// Prescribed motions that are kept for a time are invalid from now on.
  void forget_motions() { motion_time = other_motion_time = driven_time = std::numeric_limits<double>::quiet_NaN(); }
  /// Whether phi and Phi_q are those of this time and these coordinates.
  bool has_rows_at(const Point& point) const;
  /// Whether these terms were filled at this very point.
  bool is_at(const Point& point, unsigned terms) const;

  /// Terms that were filled for `time`, for the coordinates and velocities of unknowns, and for these z and h; none
  /// where the evaluation failed.
  unsigned filled = 0;
  double time = 0.0;
  std::vector<double> z, h;

  /// All that may be read again without being filled before.
  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive.doubles(self.markers, self.arms, self.spatial_arms, self.turns, self.spatial_turns, self.shifted);
    archive.doubles(self.coordinate_rows, self.motion, self.other_motion);
    archive(self.q, self.v, self.driven_a, self.phi, self.nu, self.gamma, self.jacobian);
    archive(self.force, self.force_q, self.force_v, self.gyroscopic_v, self.internal_derivatives);
    archive(self.coordinate, self.coordinate_rate, self.potential, self.potential_rate, self.wrench);
    archive(self.internal_rate, self.applied, self.acts, self.acting);
    if (!self.functions.empty()) archive(self.functions);
    archive(self.driven_time, self.motion_time, self.other_motion_time, self.filled, self.time, self.z, self.h);
  }
};

/// An Evaluation that is swapped with another one by pointer, without a copy.
class KeptEvaluation {
 public:
  explicit KeptEvaluation(const System& system, EvaluationContext* context = nullptr)
      : evaluation_(std::make_unique<Evaluation>(system, context)) {}
  operator Evaluation&() { return *evaluation_; }
  operator const Evaluation&() const { return *evaluation_; }
  Evaluation* operator->() { return evaluation_.get(); }
  const Evaluation* operator->() const { return evaluation_.get(); }
  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(*self.evaluation_);
  }
  friend void swap(KeptEvaluation& a, KeptEvaluation& b) noexcept { a.evaluation_.swap(b.evaluation_); }

 private:
  std::unique_ptr<Evaluation> evaluation_;
};

inline bool Joints::evaluate_coordinates(const Point& point, unsigned terms, Evaluation& e) const {
  declared_.fill(point, markers_.mounts(), terms, e, e);
  return asked_.empty() || ask_for_coordinates(point, terms, e);
}

inline JointInput Joints::input(const JointRecord& record, const Point& point, const Evaluation& e) {
  return {point.t,
          &e.markers[at(record.marker_a)],
          record.stands_off ? &e.shifted[at(record.index)] : &e.markers[at(record.marker_b)],
          e.coordinate[at(record.index)],
          e.coordinate_rate[at(record.index)],
          {point.z.data() + record.internal.offset, at(record.internal.size)},
          {point.h.data() + record.history.offset, at(record.history.size)},
          e.context == nullptr ? 0.0 : e.context->per_contact,
          nullptr,
          nullptr,
          nullptr,
          {e.functions.data() + record.functions.offset, at(record.functions.size)}};
}

}  // namespace freeplay
