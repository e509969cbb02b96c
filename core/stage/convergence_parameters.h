// ConvergenceParameters: when the Newton iteration of a stage stops, when its Jacobian is made anew, when it is given
// up.
//
// Update k of an iteration changes accelerations by da_k, positions by beta_q da_k and velocities by beta_v da_k.
// Symbols:
//
//   d_k    |da_k|, largest part, lengths in model sizes [1/s^2]; k = 0, 1, ...
//   r      contraction rate d_k / d_(k-1) [1]
//   e_k    error left after update k: r / (1 - r) d_k, the rest of a geometric series [1/s^2]
//   eps    rounding of a number of size 1 [1]
//   u      rounding of the coordinates: eps, times their size where they are many units large [model sizes]
//   tau    tolerance in position [model sizes]
//   tau_v  tolerance in velocity [model sizes/s]
#pragma once

#include <limits>

namespace freeplay {

struct ConvergenceParameters {
  /// tau [model sizes]. Converged: e_k beta_q <= tau and e_k beta_v <= tau_v.
  double tolerance = 1e-10;
  /// Updates after the first [1]. A stage that needs more is given up, and the step is halved.
  int max_iterations = 20;

  // Tolerance in velocity: tau_v = p d_0 beta_v, at least tau per second, at most tau / (n beta_v).
  /// p [1]. Where the predictor is far off, as in contacts, the step itself errs by much more than this part of d_0.
  double velocity_error_part = 1e-4;
  /// n [1]. So many steps of such errors together move positions by tau. Acts in steps shorter than 1 s / n.
  double velocity_error_steps = 5000.0;

  // The first update has no rate of its own; the rate of an earlier stage may stand for it.
  /// Rate assumed of a first update where none is known, with the forces of the stage before [1].
  double assumed_rate = 0.5;
  /// r of a stage counts as safety r in the following ones [1].
  double rate_safety = 10.0;
  /// Least rate that is remembered [1].
  double least_rate = 1e-5;
  /// Part of what is remembered (rates, noise) that a better value leaves of it [1].
  double memory_decay = 0.5;
  /// Stages for which a remembered rate may be used [1].
  int rate_memory = 8;
  /// It may be used where it is below this [1] ...
  double single_update_rate = 0.1;
  /// ... and the first update is at most so many tolerances: max(beta_q, beta_v) d_0 <= this tau_v [1].
  double single_update_size = 100.0;
  /// Rates are measured where the update before was larger than this, d_(k-1) beta_q > this eps [1]: smaller ones are
  /// rounding.
  double measurable_roundings = 8.0;

  // Stale Jacobian.
  /// Factors of an earlier point are renewed after the second update where r is larger [1]. Where r is larger with new
  /// factors, each update from the fourth on has its own (full Newton).
  double slow_rate = 0.1;

  // Rounding floor: nothing can be gained below it.
  /// Converged, too: e_k beta_q <= this u [1]. Without constraint equations an update with
  /// max(beta_q, beta_v) d_k <= this tau_v is not applied, and the evaluated point serves accelerate().
  double negligible_part = 0.1;
  /// An update of d_k beta_q <= this u moves positions by roundings alone [1].
  double noise_roundings = 50.0;
  /// Such an update with r at or above this is noise [1]; a larger one stagnates, see singular_roundings.
  double stagnation_rate = 0.3;
  /// Noise may also come of stale factors: they are renewed after so many noisy updates [1].
  int most_noisy_updates = 3;
  /// d_0 is noise where d_0 <= this times the noise of new factors, seen with the same forces [1] ...
  double noise_margin = 2.0;
  /// ... not more than so many stages ago [1].
  int noise_memory = 64;
  /// |Phi_r| is rounding up to so many roundings of its largest term, |Phi_q| u [1]; see RoundingFloor.
  double phi_roundings = 16.0;
  /// A coordinate below so many units rounds as a number of one unit does [1].
  double coordinate_units = 10.0;
  /// A stage that stagnates with new factors is accepted where all |Phi_r| are at most so many eps model sizes, or
  /// rounding as above, and the rest of the update (its motion equations) is below tau [1]. Acts at singular positions.
  double singular_roundings = 8.0;

  // Constraint drift: what rounding adds up to over stages.
  /// |Phi_r| up to so many times its rounding is drift [1]: positions are moved back after the stage, accelerations
  /// take the part of one stage.
  double drift_roundings = 4.0;

  // Failure.
  /// A rate above this with new factors diverges [1] ...
  double divergence_rate = 2.0;
  /// ... at the so many-th time [1]: the stage is given up.
  int most_divergent_updates = 2;
  /// |Phi_r| of a redundant equation that was left out [model sizes]: more says that constraints contradict each other.
  double redundancy_tolerance = 1e-9;

  /// Last change of internal variables, relative to their size [1]: the next one is about its square.
  double internal_tolerance = 1e-8;

  /// eps [1].
  static constexpr double rounding = std::numeric_limits<double>::epsilon();
};

}  // namespace freeplay
