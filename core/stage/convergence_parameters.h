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

  // Tolerance in velocity: tau_v = p d_0 beta_v, but at least tau (per second) and at most tau max(1, 1/(n beta_v)).
  /// p [1]. Where the predictor is far off, as in contacts, the step itself errs by much more than this part of d_0.
  double velocity_error_part = 1e-4;
  /// n [1]. So many steps of such errors together move positions by tau. Acts where beta_v < 1 s / n.
  double velocity_error_steps = 5000.0;

  // The first update has no rate of its own; the rate of an earlier stage may stand for it.
  /// Rate assumed where none is remembered, but the forces of the stage before still act [1].
  double assumed_rate = 0.5;
  /// The remembered rate is this times r [1].
  double rate_safety = 10.0;
  /// Least rate that is remembered [1].
  double least_rate = 1e-5;
  /// A remembered rate or noise falls to this part of itself at most, each time that it is measured [1].
  double memory_decay = 0.5;
  /// A remembered rate serves so many stages [1] ...
  int rate_memory = 8;
  /// ... where it is below this [1] ...
  double single_update_rate = 0.1;
  /// ... for first updates of at most so many tolerances: max(beta_q, beta_v) d_0 <= this tau_v [1].
  double single_update_size = 100.0;
  /// r is remembered where the update before was not rounding: d_(k-1) beta_q > this eps [1].
  double measurable_roundings = 8.0;

  // Stale Jacobian.
  /// Factors of an earlier stage are renewed after the second update or a later one where r is above this [1]. Where r
  /// is above it with new factors, too, each update from the fifth on has factors of its own (full Newton).
  double slow_rate = 0.1;

  // Rounding floor: nothing can be gained below it.
  /// Converged, too: e_k beta_q <= this u [1]. Without constraint equations an update with
  /// max(beta_q, beta_v) d_k <= this tau_v is not applied, and the evaluated point serves accelerate().
  double negligible_part = 0.1;
  /// An update of d_k beta_q <= this u moves positions by no more than roundings [1].
  double noise_roundings = 50.0;
  /// Such an update is noise where r is at least this [1]; a larger one then stagnates, see singular_roundings.
  double stagnation_rate = 0.3;
  /// Noise may come of stale factors: they are renewed after more than so many updates that were noise [1].
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
  /// With new factors an update of a larger rate diverges [1] ...
  double divergence_rate = 2.0;
  /// ... and so many of them in a stage end it without a result [1].
  int most_divergent_updates = 2;
  /// Largest |Phi_r| of a redundant equation after the iteration [model sizes]: if it is larger, the rank has changed
  /// or constraints contradict each other.
  double redundancy_tolerance = 1e-9;

  /// Largest last change of internal variables, relative to their size [1]: the next one is about its square.
  double internal_tolerance = 1e-8;

  /// eps [1].
  static constexpr double rounding = std::numeric_limits<double>::epsilon();
};

}  // namespace freeplay
