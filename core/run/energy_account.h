// EnergyAccount: work put in and energy dissipated since the start, by element.
#pragma once

#include <span>
#include <vector>

#include "run/channel.h"
#include "system/system.h"

namespace freeplay {

/// Power of a wrench (force and moment) at a marker [W].
double power(const double* wrench, const MarkerKinematics& k);

/// Powers are integrated over accepted steps by the trapezoidal rule. Booked are work of drivers and applied forces and
/// the loss of joints: minus the power of their wrenches, less what they store. What an integrator or a projection
/// loses is never booked; it is the residual.
class EnergyAccount {
 public:
  explicit EnergyAccount(const System& system);

  /// First call: the start. `row` needs the observed columns; fills dissipated, work and residual.
  void add(const System& system, const Evaluation& e, const Channels& channels, std::span<double> row);

  std::span<const double> driver_work() const { return driver_work_; }  ///< [J]
  std::span<const double> joint_loss() const { return joint_loss_; }    ///< [J]

 private:
  bool started_ = false;
  double last_time_ = 0.0, initial_ = 0.0, applied_work_ = 0.0;
  std::vector<double> driver_work_, joint_work_, joint_loss_, driver_power_, joint_power_, force_power_, stored_start_;
};

}  // namespace freeplay
