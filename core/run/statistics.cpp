#include "run/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace freeplay {
namespace {
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }
}  // namespace

void Statistics::Mean::add(double value, double dt, bool first) {
  maximum = std::max(maximum, std::abs(value));
  if (!first) integral += 0.5 * dt * (last * last + value * value);
  last = value;
}
double Statistics::Mean::rms(double duration) const {
  return duration > 0.0 ? std::sqrt(integral / duration) : std::abs(last);
}

Statistics::Statistics(const Model& model, const Channels& channels)
    : channels_(channels),
      discard_until_(model.settings.start + model.settings.discard),
      joints_(model.joints.size()),
      drivers_(model.drivers.size()),
      paths_(channels.paths.size()),
      body_speed_(model.bodies.size(), -1.0),
      planar_(model.space == Space::planar) {
  for (const ForceElement& element : model.force_elements) {
    const int column =
        element.joint >= 0 ? channels.joints[at(element.joint)].force : channels.forces[at(element.applied)].force;
    forces_.push_back({column});
  }
}

// A step that ends a rounding error before the instant belongs to what follows.
bool Statistics::counts(double t) const {
  return !(t < discard_until_ - 1e-12 * std::max(1.0, std::abs(discard_until_)));
}

void Statistics::add(std::span<const double> row, std::span<const double> driver_work,
                     std::span<const double> joint_loss, std::span<const double> force_work, double position,
                     double velocity) {
  const double t = row[at(channels_.time)];
  if (!counts(t)) return;
  const bool first = !seen_;
  const double dt = first ? 0.0 : t - last_time_;
  const auto value = [&](int column) { return row[at(column)]; };
  seen_ = true;
  last_time_ = t;
  duration_ += dt;
  position_ = std::max(position_, position);
  velocity_ = std::max(velocity_, velocity);
  energy_ = std::max(energy_, std::abs(value(channels_.energy.residual)));
  // Length of the vector from a column on, in the plane of two numbers.
  const auto length = [&](int column) {
    const double flat = std::hypot(value(column), value(column + 1));
    return planar_ ? flat : std::hypot(flat, value(column + 2));
  };
  // Length of the moment of the wrench that begins at a column.
  const auto moment = [&](int column) { return planar_ ? std::abs(value(column + 2)) : length(column + 3); };
  for (std::size_t b = 0; b < body_speed_.size(); ++b) {
    body_speed_[b] = std::max(body_speed_[b], length(channels_.bodies[b] + (planar_ ? 3 : 7)));
  }
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const JointColumns& columns = channels_.joints[j];
    JointSums& sums = joints_[j];
    sums.force.add(length(columns.force), dt, first);
    sums.torque = std::max(sums.torque, moment(columns.force));
    if (first) sums.loss_start = joint_loss[j];
    sums.loss = joint_loss[j] - sums.loss_start;
    if (columns.contact < 0) continue;
    sums.penetration = first ? value(columns.penetration) : std::max(sums.penetration, value(columns.penetration));
    sums.normal = std::max(sums.normal, value(columns.normal_force));
    sums.eccentricity =
        std::max(sums.eccentricity, std::hypot(std::hypot(value(columns.eccentricity_x), value(columns.eccentricity_y)),
                                               columns.eccentricity_z >= 0 ? value(columns.eccentricity_z) : 0.0));
    if (!first) sums.contact_time += 0.5 * dt * (sums.last_contact + value(columns.contact));
    sums.last_contact = value(columns.contact);
  }
  for (std::size_t f = 0; f < forces_.size(); ++f) {
    ForceSums& sums = forces_[f];
    sums.force = std::max(sums.force, length(sums.column));
    sums.torque = std::max(sums.torque, moment(sums.column));
    if (first) sums.work_start = force_work[f];
    sums.work = force_work[f] - sums.work_start;
  }
  for (std::size_t d = 0; d < drivers_.size(); ++d) {
    DriverSums& sums = drivers_[d];
    sums.effort.add(value(channels_.drivers[d].effort), dt, first);
    if (first) sums.work_start = driver_work[d];
    sums.work = driver_work[d] - sums.work_start;
  }
  for (std::size_t p = 0; p < paths_.size(); ++p) {
    const PathColumns& columns = channels_.paths[p];
    paths_[p].position.add(std::hypot(value(columns.error_x), value(columns.error_y)), dt, first);
    paths_[p].angle.add(value(columns.error_angle), dt, first);
  }
}

void Statistics::add_contact(int joint, double time) {
  ++contacts_total_;
  if (time < discard_until_) return;
  ++contacts_;
  ++joints_[at(joint)].contacts;
}

JointStatistics Statistics::joint(int index) const {
  const JointSums& sums = joints_[at(index)];
  if (!seen_) return {nan, nan, nan, nan, nan, nan, nan, 0, nan};
  JointStatistics out{sums.force.maximum, sums.force.rms(duration_), nan, nan, nan, nan, sums.loss, sums.contacts,
                      sums.torque};
  const JointColumns& columns = channels_.joints[at(index)];
  if (columns.contact < 0 || columns.normal_force < 0 || columns.penetration < 0) return out;
  out.max_normal_force = sums.normal;
  out.max_penetration = sums.penetration;
  if (columns.eccentricity_x >= 0) out.max_eccentricity = sums.eccentricity;
  out.contact_fraction = duration_ > 0.0 ? sums.contact_time / duration_ : sums.last_contact;
  return out;
}

ForceStatistics Statistics::force(int index) const {
  if (!seen_) return {nan, nan, nan};
  const ForceSums& sums = forces_[at(index)];
  return {sums.force, sums.torque, sums.work};
}

DriverStatistics Statistics::driver(int index) const {
  if (!seen_) return {nan, nan, nan};
  const DriverSums& sums = drivers_[at(index)];
  return {sums.effort.maximum, sums.effort.rms(duration_), sums.work};
}

PathStatistics Statistics::path(int index) const {
  if (!seen_) return {nan, nan, nan, nan};
  const PathSums& sums = paths_[at(index)];
  return {sums.position.maximum, sums.position.rms(duration_), sums.angle.maximum, sums.angle.rms(duration_)};
}

double Statistics::body_max_speed(int index) const { return seen_ ? body_speed_[at(index)] : nan; }

}  // namespace freeplay
