#include "stage/convergence_monitor.h"

#include <cmath>
#include <utility>

namespace freeplay {

Convergence ConvergenceMonitor::judge(double size, double coordinate_rounding, bool internal_converged) {
  const double before = std::exchange(size_, size);
  ++updates_;
  if (updates_ == 1) measure_predictor(size);
  if (!std::isfinite(size)) return Convergence::not_finite;
  rate_ = updates_ == 1 ? 1.0 : size / before;
  if (updates_ > 1) remember_rate(before);
  // Both count: they remember what they see.
  const bool accurate = is_accurate(coordinate_rounding), noise = is_noise(coordinate_rounding);
  if (!internal_converged) return go_on();
  if (accurate || size == 0.0) return Convergence::converged;
  if (noise) return Convergence::at_rounding;
  return fresh_ && updates_ > 1 && rate_ >= parameters_.stagnation_rate ? Convergence::stagnated : go_on();
}

Convergence ConvergenceMonitor::go_on() {
  const bool diverges = fresh_ && updates_ > 1 && rate_ > parameters_.divergence_rate;
  if (diverges && ++divergent_updates_ >= parameters_.most_divergent_updates) return Convergence::diverged;
  if (fresh_ && updates_ > 3 && rate_ > parameters_.slow_rate) record_->usable = false;  // full Newton from here
  return needs_jacobian() ? Convergence::stale_jacobian : Convergence::contracting;
}

void ConvergenceMonitor::measure_predictor(double size) {
  const ConvergenceParameters& p = parameters_;
  const double most = p.tolerance * std::max(1.0, 1.0 / (p.velocity_error_steps * beta_v_));
  velocity_tolerance_ = std::clamp(p.velocity_error_part * size * beta_v_, p.tolerance, most);
  predictor_error_ = size * largest_beta() / velocity_tolerance_;
}

void ConvergenceMonitor::remember_rate(double size_before) {
  const ConvergenceParameters& p = parameters_;
  if (!(size_before * beta_q_ > p.measurable_roundings * p.rounding)) return;
  record_->rate = std::max({p.rate_safety * rate_, p.memory_decay * record_->rate, p.least_rate});
  record_->rate_age = 0;
}

// The rest of a geometric series of the rate r; of an update that does not contract, the update itself.
double ConvergenceMonitor::error_left() {
  const ConvergenceParameters& p = parameters_;
  double rate = rate_;
  if (updates_ == 1) {
    const bool expected = record_->rate < p.single_update_rate &&
                          size_ * largest_beta() <= p.single_update_size * velocity_tolerance_ &&
                          ++record_->rate_age <= p.rate_memory;
    rate = expected ? record_->rate : p.assumed_rate;
  }
  return rate < 1.0 ? rate / (1.0 - rate) * size_ : size_;
}

bool ConvergenceMonitor::is_accurate(double coordinate_rounding) {
  const double left = error_left();
  // With other forces than in the stage before a first update says nothing of what is left.
  if (updates_ == 1 && !same_forces_) return false;
  return (left * beta_q_ <= parameters_.tolerance && left * beta_v_ <= velocity_tolerance_) ||
         left * beta_q_ <= parameters_.negligible_part * coordinate_rounding;
}

bool ConvergenceMonitor::is_noise(double coordinate_rounding) {
  const ConvergenceParameters& p = parameters_;
  const bool tiny = size_ * beta_q_ <= p.noise_roundings * coordinate_rounding;
  if (updates_ == 1) {
    return tiny && size_ <= p.noise_margin * record_->noise && ++record_->noise_age <= p.noise_memory;
  }
  if (!(tiny && rate_ >= p.stagnation_rate)) return size_ * beta_q_ <= coordinate_rounding;
  if (fresh_) {
    record_->noise = std::max(size_, p.memory_decay * record_->noise);
    record_->noise_age = 0;
  } else if (++record_->noisy_updates > p.most_noisy_updates) {
    // Stagnation at rounding is noise, or comes of stale factors: new ones decide.
    record_->noisy_updates = 0;
    record_->usable = false;
  }
  return true;
}

}  // namespace freeplay
