#include "run/energy_account.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"

namespace freeplay {
namespace {
constexpr double same_length = 1e-6;      // of steps, relative
constexpr double bends_little = 1e-6;     // third differences of powers, relative: the cubic errs by a fortieth of that
constexpr double nearly_straight = 3e-3;  // what is left of a smooth power is then a small part of that
constexpr double noticed_work = 1e-8;  // what powers off a straight line may make, of the energy at the start and moved
}  // namespace

double power(const double* wrench, const MarkerKinematics& k) {
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) sum += wrench[i] * k.velocity[i] + wrench[3 + i] * k.angular_velocity[i];
  return sum;
}

EnergyAccount::EnergyAccount(const System& system)
    : system_(system),
      driver_work_(system.model().drivers.size(), 0.0),
      joint_loss_(system.model().joints.size(), 0.0),
      stored_start_(system.model().joints.size(), 0.0),
      force_work_(system.model().force_elements.size(), 0.0) {
  const std::size_t count = driver_work_.size() + system.model().forces.size() + system.forces().blocks().size();
  for (auto* numbers :
       {&power_, &integral_, &power_before_, &power_earlier_, &integral_before_, &power_end_, &integral_inside_})
    numbers->resize(count);
}

void EnergyAccount::flow(const Evaluation& e, std::span<const double> lambda, std::span<double> out) const {
  const Model& model = system_.model();
  std::size_t flow = 0;
  for (int d = 0; d < static_cast<int>(model.drivers.size()); ++d) {
    const int r = system_.layout().driver_row(d);
    const double effort = r < 0 ? e.motion[at(d)].value : -lambda[at(r)];
    const bool driven = r >= system_.layout().nc();  // its coordinate is not always looked at
    out[flow++] = effort * (driven ? e.motion[at(d)].rate : e.coordinate_rate[at(model.drivers[at(d)].joint)]);
  }
  for (std::size_t f = 0; f < model.forces.size(); ++f) {
    out[flow++] = power(&e.applied[6 * f], e.markers[at(model.forces[f].marker)]);
  }
  for (std::size_t f = 0; f < system_.forces().blocks().size(); ++f) {
    const std::size_t j = at(system_.forces().blocks()[f].joint);
    const double rate = e.potential_rate[j], *wrench = &e.wrench[12 * j];
    double given = std::isnan(rate) ? 0.0 : rate;
    if (e.acts[f] != 0) {
      given += power(wrench, e.markers[at(model.joints[j].marker_a)]) +
               power(wrench + 6, e.markers[at(model.joints[j].marker_b)]);
    }
    out[flow++] = given;
  }
}

/// -lambda^T nu over the rows of joints: what the force of a row that moves by itself puts in.
double EnergyAccount::row_power(const Evaluation& e, std::span<const double> lambda) const {
  if (!system_.constraints().rows_move()) return 0.0;
  // What driven bodies move in a row is not its own motion.
  double power = -system_.driven().power(e, lambda);
  for (std::size_t r = 0; r < at(system_.layout().first_driver_row()); ++r) power -= lambda[r] * e.nu[r];
  return power;
}

void EnergyAccount::start(const Evaluation& e, std::span<const double> lambda, const Channels& channels,
                          std::span<const double> row) {
  initial_ = row[at(channels.energy.kinetic)] + row[at(channels.energy.potential)];
  stored_start_.assign(e.potential.begin(), e.potential.end());
  renew(e, lambda);
}

void EnergyAccount::take(double dt, const Evaluation& e, std::span<const double> lambda,
                         std::span<const double> integrals) {
  flow(e, lambda, power_end_);
  take(dt, e, lambda, power_end_, integrals);
}

void EnergyAccount::take(double dt, const Evaluation& e, std::span<const double> lambda, std::span<const double> powers,
                         std::span<const double> integrals) {
  steps_alike_ = is_like_last(dt, e) ? steps_alike_ + 1 : 1;
  dt_ = dt;
  std::swap(power_earlier_, power_before_);
  for (std::size_t i = 0; i < power_.size(); ++i) {
    power_before_[i] = power_[i];
    power_[i] = powers[i];
    integral_before_[i] = integral_[i];
    integral_[i] = integrals[i];
    exchanged_ += std::abs(integral_[i] - integral_before_[i]);
  }
  row_power_before_ = row_power_;
  row_work_before_ = row_work_;
  look(e, lambda);
  const double row_work = 0.5 * dt * (row_power_before_ + row_power_);
  row_work_ += row_work;
  exchanged_ += std::abs(row_work);
}

bool EnergyAccount::is_like_last(double dt, const Evaluation& e) const {
  return steps_alike_ > 0 && std::abs(dt - dt_) <= same_length * dt && e.acting == acting_;
}

bool EnergyAccount::add_smooth(double dt, const Evaluation& e, std::span<const double> lambda) {
  if (steps_alike_ < 2 || !is_like_last(dt, e)) return false;
  flow(e, lambda, power_end_);
  double third = 0.0, size = 0.0;  // of their differences
  for (std::size_t i = 0; i < power_.size(); ++i) {
    const double end = power_end_[i], start = power_[i];
    third += std::abs(end - power_earlier_[i] - 3.0 * (start - power_before_[i]));
    size += std::abs(end) + std::abs(start);
    integral_inside_[i] =
        integral_[i] + dt / 24.0 * (9.0 * end + 19.0 * start - 5.0 * power_before_[i] + power_earlier_[i]);
  }
  if (!(third <= bends_little * size)) return false;
  take(dt, e, lambda, power_end_, integral_inside_);
  return true;
}

void EnergyAccount::add(double dt, std::span<const double> half_way, const Evaluation& e,
                        std::span<const double> lambda) {
  take(dt, e, lambda, integral_);
  for (std::size_t i = 0; i < power_.size(); ++i) {
    const double work = dt / 6.0 * (power_before_[i] + 4.0 * half_way[i] + power_[i]);
    integral_[i] += work;
    exchanged_ += std::abs(work);
  }
}

void EnergyAccount::add_part(double dt, std::span<const double> begin, std::span<const double> half_way,
                             std::span<const double> end) {
  for (std::size_t i = 0; i < integral_inside_.size(); ++i) {
    integral_inside_[i] += dt / 6.0 * (begin[i] + 4.0 * half_way[i] + end[i]);
  }
}

bool EnergyAccount::add_history_loss(int joint, double loss, const Evaluation& e, std::size_t& flow) {
  const std::span<const ForceBlock> blocks = system_.forces().blocks();
  const auto block = std::ranges::find(blocks, joint, &ForceBlock::joint);
  if (block == blocks.end() || std::isnan(e.potential_rate[at(joint)])) return false;
  flow = integral_.size() - blocks.size() + static_cast<std::size_t>(block - blocks.begin());
  integral_[flow] -= loss;
  exchanged_ += std::abs(loss);
  return true;
}

double EnergyAccount::largest_power(const Evaluation& start, std::span<const double> lambda_start,
                                    const Evaluation& end, std::span<const double> lambda_end) {
  flow(start, lambda_start, integral_inside_);
  flow(end, lambda_end, power_end_);
  double sum = std::max({0.0, row_power(start, lambda_start), row_power(end, lambda_end)});
  const std::vector<Driver>& drivers = system_.model().drivers;
  for (std::size_t i = 0; i < power_end_.size(); ++i) {
    // Whatever state a step ends in, a prescribing driver holds against it: its power there explains nothing.
    const bool holds = i < drivers.size() && prescribes(drivers[i].kind);
    sum += std::max({0.0, integral_inside_[i], holds ? 0.0 : power_end_[i]});
  }
  return sum;
}

double EnergyAccount::lost_less_given(const Evaluation& e) const {
  double sum = -initial_ - row_work_;
  for (const double integral : integral_) sum -= integral;
  for (const ForceBlock& block : system_.forces().blocks()) {
    const std::size_t j = at(block.joint);
    if (std::isnan(e.potential_rate[j])) sum -= e.potential[j] - stored_start_[j];
  }
  return sum;
}

// Of a step of length dt, with these powers at its start, at its fraction s (which may lie a little beyond 1) and at
// its end: from the nearer end, whose integral is known, over the parabola through the three.
double EnergyAccount::integral_at(double s, double dt, const Ends& integral, double begin, double here, double end) {
  const double slope = end - begin, room = s * (1.0 - s), off = here - begin - s * slope;
  const double bend = std::abs(room) > 1e-9 ? off / room : 0.0;
  const auto from_start = [&](double x) { return x * (begin + x * (0.5 * slope + bend * (0.5 - x / 3.0))); };
  if (s <= 0.5) return integral.start + dt * from_start(s);
  return integral.end - dt * (from_start(1.0) - from_start(s));
}

bool EnergyAccount::integrate_to(double s, double dt, const Evaluation& here, std::span<const double> lambda_here,
                                 const Evaluation& end, std::span<const double> lambda_end,
                                 std::span<const double> integral_end, std::span<double> out) {
  flow(here, lambda_here, integral_inside_);
  flow(end, lambda_end, power_before_);
  double off = 0.0, size = 0.0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double begins = power_[i], is = integral_inside_[i], ends = power_before_[i];
    off += std::abs(is - begins - s * (ends - begins));
    size += std::abs(begins) + std::abs(is) + std::abs(ends);
    out[i] = integral_at(s, dt, {integral_[i], integral_end[i]}, begins, is, ends);
  }
  return off <= nearly_straight * size;
}

void EnergyAccount::fill_inside(double s, const Evaluation& e, std::span<const double> lambda, const Channels& channels,
                                std::span<double> row) {
  flow(e, lambda, integral_inside_);
  for (std::size_t i = 0; i < integral_inside_.size(); ++i) {
    integral_inside_[i] =
        integral_at(s, dt_, {integral_before_[i], integral_[i]}, power_before_[i], integral_inside_[i], power_[i]);
  }
  fill(e, channels, row, integral_inside_, row_work_inside(s, e, lambda));
}

bool EnergyAccount::bends(double s, const Evaluation& e, std::span<const double> lambda) {
  if (system_.forces().blocks().empty()) return false;
  flow(e, lambda, integral_inside_);
  double off = 0.0;
  for (std::size_t i = power_.size() - system_.forces().blocks().size(); i < power_.size(); ++i) {
    off += std::abs(integral_inside_[i] - power_before_[i] - s * (power_[i] - power_before_[i]));
  }
  return off * dt_ > noticed_work * (std::abs(initial_) + exchanged_);
}

void EnergyAccount::fill_bent(double s, const Evaluation& e, std::span<const double> lambda, const Channels& channels,
                              std::span<double> row) {
  flow(e, lambda, integral_inside_);
  const bool from_start = s <= 0.5;
  const double length = from_start ? s * dt_ : (s - 1.0) * dt_;
  for (std::size_t i = 0; i < integral_inside_.size(); ++i) {
    const double end = from_start ? power_before_[i] : power_[i];
    integral_inside_[i] = (from_start ? integral_before_[i] : integral_[i]) +
                          length / 6.0 * (end + 4.0 * power_end_[i] + integral_inside_[i]);
  }
  fill(e, channels, row, integral_inside_, row_work_inside(s, e, lambda));
}

void EnergyAccount::fill(const Evaluation& e, const Channels& channels, std::span<double> row,
                         std::span<const double> integral, double row_work) {
  fill_sums(e, channels, row, integral, row_work);
  for (const AskedColumn& asked : channels.driver_work) row[at(asked.column)] = driver_work_[at(asked.element)];
  for (const AskedColumn& asked : channels.force_work) row[at(asked.column)] = force_work_[at(asked.element)];
  for (const AskedColumn& asked : channels.joint_loss) row[at(asked.column)] = joint_loss_[at(asked.element)];
  channels.fill_formulas(row);
}

double EnergyAccount::find_losses(const Evaluation& e, std::span<const double> integral) {
  const std::span<const ForceBlock> blocks = system_.forces().blocks();
  const double* given = integral.last(blocks.size()).data();
  double lost = 0.0;
  for (const ForceBlock& block : blocks) {
    const std::size_t j = at(block.joint);
    double& loss = joint_loss_[j];
    loss = -*given++;
    if (std::isnan(e.potential_rate[j])) loss -= e.potential[j] - stored_start_[j];
    lost += loss;
  }
  return lost;
}

void EnergyAccount::fill_sums(const Evaluation& e, const Channels& channels, std::span<double> row,
                              std::span<const double> integral, double row_work) {
  std::size_t flow = 0;
  double work = row_work;
  for (double& driver : driver_work_) work += driver = integral[flow++];
  const std::size_t first_force = flow;
  for (std::size_t f = 0; f < system_.model().forces.size(); ++f) work += integral[flow++];
  const double lost = find_losses(e, integral);
  for (std::size_t i = 0; i < force_work_.size(); ++i) {
    const ForceElement& element = system_.model().force_elements[i];
    if (element.joint < 0) {
      force_work_[i] = integral[first_force + at(element.applied)];
    } else {  // what it gave of its store, less what it lost
      const std::size_t j = at(element.joint);
      force_work_[i] = stored_start_[j] - e.potential[j] - joint_loss_[j];
    }
  }
  const double total = row[at(channels.energy.kinetic)] + row[at(channels.energy.potential)];
  row[at(channels.energy.dissipated)] = lost;
  row[at(channels.energy.work)] = work;
  row[at(channels.energy.residual)] = total - initial_ + lost - work;
}

}  // namespace freeplay
