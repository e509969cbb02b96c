// LocalError: errors of one step in parts of what the run allows.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "stage/equations.h"
#include "stage/index_one_solver.h"

namespace freeplay {

class LocalError {
 public:
  LocalError(StageEquations& equations, IndexOneSolver& index_one);

  /// From now on errors are in units of `position` [m], angles by the model's size, and in velocity of `velocity` [m/s]
  /// plus the part `relative` of the largest velocity. Until then all norms are 0.
  void allow(double position, double velocity, double relative) {
    position_ = position, velocity_ = velocity, relative_ = relative;
  }
  /// The state at the start of the attempt. The rounding of velocities is no error.
  void begin_attempt(std::span<const double> v, std::span<const double> z) {
    equations_.rows().begin_attempt();
    for (std::size_t i = 0; i < most_z_.size(); ++i) most_z_[i] = std::max(most_z_[i], std::abs(z[i]));
    velocity_now_ =
        velocity_ + std::max(relative_, velocity_rounding) * equations_.system().size() * equations_.norm(v);
  }
  /// See StageSolver::error_norm.
  double norm(std::span<const double> position, std::span<const double> velocity);
  double velocity_norm(std::span<const double> velocity) { return part_of_allowed(velocity, velocity_now_); }
  /// See StageSolver::internal_error_norm.
  double internal_norm(double dt, const StateView& end, std::span<const double> error);
  /// Index into v of the largest part of the last norm.
  int worst_component() const { return worst_component_; }

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.position_, self.velocity_, self.relative_, self.velocity_now_, self.worst_component_, self.most_z_);
  }

 private:
  static constexpr double velocity_rounding = 2e-14;  // relative
  /// Of the largest amount that an internal variable had so far. Without this bound a method that is not stable could
  /// let an internal variable that moves nothing grow without end, until it does act.
  static constexpr double internal_allowed = 0.5;

  /// Largest error in units of `allowed`, a length or its rate. Close to a singular position of the constraints the
  /// part along the motion counts; the part across is taken away when the end of the step is projected, up to its
  /// square over the size of the model.
  double part_of_allowed(std::span<const double> error, double allowed);
  /// The same of internal variables that move nothing at the end of the step, but may later, as the strain of a clutch
  /// that slips once it holds. What they would do then is not known, so that each may err by the part of itself that a
  /// position may err by of the model's size. The equations were evaluated at the end of the step.
  double part_of_idle(const StateView& end, std::span<const double> error);
  struct Answer {
    double wrenches[12];
    double rate;
  };
  /// A joint's wrenches and the rate of its internal variable i with other_z_; false where it refuses.
  bool ask(int joint, int i, const Point& at, Answer& answer);
  /// The same with another value of that variable.
  bool ask_at(double z, int joint, int i, const Point& at, Answer& answer);

  StageEquations& equations_;
  IndexOneSolver& index_one_;
  double position_ = 0.0, velocity_ = 0.0, relative_ = 0.0;
  double velocity_now_ = 0.0;  // allowed in the present attempt
  int worst_component_ = -1;
  std::vector<double> motion_;                                         // part of an error along the motion
  std::vector<double> most_z_;                                         // largest amounts of accepted states
  std::vector<double> other_a_, other_lambda_, other_z_, other_rate_;  // with the internal variables in error
  std::vector<int> with_memory_;  // joints with internal variables, but for those with play
};

}  // namespace freeplay
