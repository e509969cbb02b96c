// ConvergenceMonitor: judges the Newton iteration of a stage by the sizes of its updates.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "stage/convergence_parameters.h"

namespace freeplay {

/// What is known of iterations with one Jacobian, over the stages that it serves.
struct JacobianRecord {
  bool usable = false;       ///< false: factored anew before the next update
  double rate = 1.0;         ///< contraction rate that is to be expected; 1: not seen with these forces
  int rate_age = 0;          ///< stages since it was measured
  double noise = 0.0;        ///< size of updates that were noise with new factors [1/s^2]
  int noise_age = 0;         ///< stages since it was seen
  int noisy_updates = 0;     ///< with these factors, old
  std::uint64_t acting = 0;  ///< ForceValues::acting of the last update

  /// Factors for other equations: what was seen of noise is of no use.
  void begin() {
    usable = false;
    noise = 0.0;
    noisy_updates = 0;
  }
  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.usable, self.rate, self.rate_age, self.noise, self.noise_age, self.noisy_updates, self.acting);
  }
};

/// What an update says of its iteration.
enum class Convergence {
  converged,       ///< the error that is left is within the tolerance
  at_rounding,     ///< the update is noise: the iteration stands at the rounding floor
  contracting,     ///< go on
  stale_jacobian,  ///< go on with new factors
  stagnated,       ///< larger than noise, and hardly shrinks with new factors: accept rounding of Phi, else go_on()
  diverged,        ///< grows again and again with new factors
  not_finite       ///< a number in the state is infinite or none
};

class ConvergenceMonitor {
 public:
  explicit ConvergenceMonitor(const ConvergenceParameters& parameters) : parameters_(parameters) {}

  const ConvergenceParameters& parameters() const { return parameters_; }

  /// A stage with these betas [s^2, s], whose Jacobian has this record. It must stay valid until the next begin().
  void begin(double beta_q, double beta_v, JacobianRecord& record) {
    record_ = &record;
    beta_q_ = beta_q;
    beta_v_ = beta_v;
    updates_ = divergent_updates_ = 0;
    fresh_ = false;
    rate_ = 1.0;
    forget_updates();
  }
  /// Before an update: the iteration goes on only with factors of the present point.
  bool needs_jacobian() const { return !record_->usable || (!fresh_ && rate_ > parameters_.slow_rate && updates_ > 1); }
  void jacobian_renewed() {
    fresh_ = true;
    record_->rate = 1.0;
  }
  /// Before an update: the forces that act (ForceValues::acting). Rates and noise seen with others are of no use.
  void forces_act(std::uint64_t acting) {
    same_forces_ = acting == record_->acting;
    if (updates_ == 0 && !same_forces_) record_->rate = 1.0, record_->noise = 0.0;
    record_->acting = acting;
  }
  /// Of an update of the size d_k [1/s^2], with coordinates that round to u [model sizes] and internal variables that
  /// are within their tolerance, or not.
  Convergence judge(double size, double coordinate_rounding, bool internal_converged);
  /// After `stagnated`, where Phi is more than rounding: the iteration goes on.
  Convergence go_on();
  /// Other equations than before are solved from here on: the next update has a rate of 0.
  void forget_updates() { size_ = std::numeric_limits<double>::infinity(); }
  /// The last update is so small that to leave it out changes nothing.
  bool is_negligible() const {
    return updates_ > 1 && size_ * largest_beta() <= parameters_.negligible_part * velocity_tolerance_;
  }
  /// Error of the predictor: d_0 max(beta_q, beta_v), in parts of tau_v.
  double predictor_error() const { return predictor_error_; }
  double velocity_tolerance() const { return velocity_tolerance_; }  ///< tau_v [model sizes/s]
  double largest_beta() const { return std::max(beta_q_, beta_v_); }

  /// All else is of one stage.
  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.velocity_tolerance_, self.predictor_error_);
  }

 private:
  void measure_predictor(double size);
  void remember_rate(double size_before);
  double error_left();
  bool is_accurate(double coordinate_rounding);
  bool is_noise(double coordinate_rounding);

  const ConvergenceParameters parameters_;
  JacobianRecord* record_ = nullptr;
  double beta_q_ = 0.0, beta_v_ = 0.0;
  double velocity_tolerance_ = 0.0, predictor_error_ = 0.0;
  double size_ = 0.0, rate_ = 1.0;  // of the last update
  int updates_ = 0, divergent_updates_ = 0;
  bool fresh_ = false;  // the factors were made in this stage
  bool same_forces_ = false;
};

}  // namespace freeplay
