#include "run/energy_account.h"

namespace freeplay {
namespace {
constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }
}  // namespace

double power(const double* wrench, const MarkerKinematics& k) {
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) sum += wrench[i] * k.velocity[i] + wrench[3 + i] * k.angular_velocity[i];
  return sum;
}

EnergyAccount::EnergyAccount(const System& system)
    : driver_work_(system.model().drivers.size(), 0.0),
      joint_work_(system.model().joints.size(), 0.0),
      joint_loss_(system.model().joints.size(), 0.0),
      driver_power_(system.model().drivers.size(), 0.0),
      joint_power_(system.model().joints.size(), 0.0),
      force_power_(system.model().forces.size(), 0.0),
      stored_start_(system.model().joints.size(), 0.0) {}

void EnergyAccount::add(const System& system, const Evaluation& e, const Channels& channels, std::span<double> row) {
  const double t = row[at(channels.time)], half = started_ ? 0.5 * (t - last_time_) : 0.0;
  last_time_ = t;
  for (std::size_t d = 0; d < driver_work_.size(); ++d) {
    const double now = row[at(channels.drivers[d].power)];
    driver_work_[d] += half * (driver_power_[d] + now);
    driver_power_[d] = now;
  }
  for (std::size_t f = 0; f < force_power_.size(); ++f) {
    const double now = row[at(channels.forces[f].power)];
    applied_work_ += half * (force_power_[f] + now);
    force_power_[f] = now;
  }
  double lost = 0.0;
  for (const ForceBlock& block : system.force_blocks()) {
    const std::size_t j = at(block.joint);
    const JointElement& joint = system.model().joints[j];
    const double now = power(&e.wrench[12 * j], e.markers[at(joint.marker_a)]) +
                       power(&e.wrench[12 * j + 6], e.markers[at(joint.marker_b)]);
    if (!started_) stored_start_[j] = e.potential[j];
    joint_work_[j] += half * (joint_power_[j] + now);
    joint_power_[j] = now;
    joint_loss_[j] = -joint_work_[j] - (e.potential[j] - stored_start_[j]);
    lost += joint_loss_[j];
  }
  double work = applied_work_;
  for (const double w : driver_work_) work += w;
  const double total = row[at(channels.energy.kinetic)] + row[at(channels.energy.potential)];
  if (!started_) initial_ = total;
  started_ = true;
  row[at(channels.energy.dissipated)] = lost;
  row[at(channels.energy.work)] = work;
  row[at(channels.energy.residual)] = total - initial_ + lost - work;
}

}  // namespace freeplay
