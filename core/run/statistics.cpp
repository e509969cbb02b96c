#include "run/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/index.h"

namespace freeplay {
namespace {
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double nothing = -std::numeric_limits<double>::infinity();

void raise(std::span<const double> values, std::vector<double>& largest) {
  for (std::size_t i = 0; i < values.size(); ++i) largest[i] = std::max(largest[i], values[i]);
}
}  // namespace

void Statistics::Mean::add(double value, double dt, bool first) {
  if (!first) integral += 0.5 * dt * (last * last + value * value);
  last = value;
}
double Statistics::Mean::rms(double duration) const { return std::sqrt(integral / duration); }

Statistics::Statistics(const Model& model, const Channels& channels)
    : channels_(channels),
      peaks_(model, channels),
      noise_(model, peaks_.size()),
      values_(peaks_.size()),
      largest_(peaks_.size(), nothing),
      before_(peaks_.size(), nothing),
      written_(peaks_.size(), nothing),
      discard_until_(model.settings.start + model.settings.discard),
      joints_(model.joints.size()),
      forces_(model.force_elements.size()),
      drivers_(model.drivers.size()),
      paths_(channels.paths.size()) {}

// A step that ends a rounding error before the instant belongs to what follows.
bool Statistics::counts(double t) const {
  return !(t < discard_until_ - 1e-12 * std::max(1.0, std::abs(discard_until_)));
}

bool Statistics::begins_inside(double from, double to) const {
  return !counts(from) && counts(to) && discard_until_ - from < (1.0 - 1e-9) * (to - from);
}

void Statistics::take_largest(double t) {
  if (!counts(t)) return raise(values_, before_);
  raise(values_, largest_);
  noise_.see(t, values_);
}

void Statistics::note(std::span<const double> row) {
  peaks_.of(row, values_);
  take_largest(row[at(channels_.time)]);
}

void Statistics::note_written(std::span<const double> row) {
  note(row);
  if (counts(row[at(channels_.time)])) raise(values_, written_);
}

void Statistics::add(std::span<const double> row, std::span<const double> driver_work,
                     std::span<const double> joint_loss, std::span<const double> force_work, double position,
                     double velocity) {
  note(row);
  const double t = row[at(channels_.time)];
  if (!counts(t)) return;
  const bool first = !seen_;
  const double dt = first ? 0.0 : t - last_time_;
  const auto value = [&](int column) { return row[at(column)]; };
  seen_ = true;
  ++instants_;
  last_time_ = t;
  duration_ += dt;
  position_ = std::max(position_, position);
  velocity_ = std::max(velocity_, velocity);
  energy_ = std::max(energy_, std::abs(value(channels_.energy.residual)));
  for (int j = 0; j < static_cast<int>(joints_.size()); ++j) {
    const JointColumns& columns = channels_.joints[at(j)];
    JointSums& sums = joints_[at(j)];
    sums.force.add(values_[peaks_.force(j)], dt, first);
    if (first) sums.loss_start = joint_loss[at(j)];
    sums.loss = joint_loss[at(j)] - sums.loss_start;
    if (columns.contact < 0) continue;
    if (!first) sums.contact_time += 0.5 * dt * (sums.last_contact + value(columns.contact));
    sums.last_contact = value(columns.contact);
  }
  for (std::size_t f = 0; f < forces_.size(); ++f) {
    if (first) forces_[f].work_start = force_work[f];
    forces_[f].work = force_work[f] - forces_[f].work_start;
  }
  for (int d = 0; d < static_cast<int>(drivers_.size()); ++d) {
    DriverSums& sums = drivers_[at(d)];
    sums.effort.add(values_[peaks_.effort(d)], dt, first);
    if (first) sums.work_start = driver_work[at(d)];
    sums.work = driver_work[at(d)] - sums.work_start;
  }
  for (int p = 0; p < static_cast<int>(paths_.size()); ++p) {
    paths_[at(p)].position.add(values_[peaks_.position_error(p)], dt, first);
    paths_[at(p)].angle.add(values_[peaks_.angle_error(p)], dt, first);
  }
}

void Statistics::add_contact(int joint, double time) {
  ++contacts_total_;
  if (!counts(time)) return;
  ++contacts_;
  ++joints_[at(joint)].contacts;
}

JointStatistics Statistics::joint(int index) const {
  const JointSums& sums = joints_[at(index)];
  if (!any()) return {nan, nan, nan, nan, nan, nan, nan, 0, nan};
  JointStatistics out{
      largest_[peaks_.force(index)], sums.force.rms(duration_), nan, nan, nan, nan, sums.loss, sums.contacts,
      largest_[peaks_.torque(index)]};
  const JointColumns& columns = channels_.joints[at(index)];
  if (columns.contact < 0 || columns.normal_force < 0 || columns.penetration < 0) return out;
  out.max_normal_force = largest_[peaks_.normal_force(index)];
  out.max_penetration = largest_[peaks_.penetration(index)];
  if (columns.eccentricity_x >= 0) out.max_eccentricity = largest_[peaks_.eccentricity(index)];
  out.contact_fraction = sums.contact_time / duration_;
  return out;
}

ForceStatistics Statistics::force(int index) const {
  if (!any()) return {nan, nan, nan};
  return {largest_[peaks_.applied_force(index)], largest_[peaks_.applied_torque(index)], forces_[at(index)].work};
}

DriverStatistics Statistics::driver(int index) const {
  if (!any()) return {nan, nan, nan};
  const DriverSums& sums = drivers_[at(index)];
  return {largest_[peaks_.effort(index)], sums.effort.rms(duration_), sums.work};
}

PathStatistics Statistics::path(int index) const {
  if (!any()) return {nan, nan, nan, nan};
  const PathSums& sums = paths_[at(index)];
  return {largest_[peaks_.position_error(index)], sums.position.rms(duration_), largest_[peaks_.angle_error(index)],
          sums.angle.rms(duration_)};
}

double Statistics::body_max_speed(int index) const { return any() ? largest_[peaks_.speed(index)] : nan; }

}  // namespace freeplay
