#include "run/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/index.h"

namespace freeplay {
namespace {
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double small_part = 1e-4;  // of an integral
constexpr double unlike = 4.0;       // lengths of steps, one by the other
}  // namespace

void Statistics::Mean::add(double value, double dt, bool first, bool by_parabolas) {
  const double square = value * value;
  if (!first) integral += 0.5 * dt * (last * last + square);
  if (by_parabolas && !first && known > 1 && dt > 0.0) {
    // A step takes half of what the parabola through its start takes off, and half of that through its end; at the
    // ends of a stretch all of the only one. No more than a part of what is there, and in steps of unlike lengths of
    // what is in each.
    const double bend = ((square - last * last) / dt - (last * last - before) / length) / (length + dt);
    double most = 0.25 * (before + 2.0 * last * last + square) / ((length + dt) * (length + dt));
    if (std::max(length, dt) > unlike * std::min(length, dt)) {
      most = std::min(
          {most, 0.25 * (before + last * last) / (length * length), 0.25 * (last * last + square) / (dt * dt)});
    }
    const double off = std::clamp(bend / 12.0, -most, most);
    // Of a step far longer than the one that began the stretch this parabola says nothing: the next one says all.
    const bool alone = known == 2 && dt > unlike * length;
    const double earlier = off * length * length * length, later = alone ? 0.0 : off * dt * dt * dt;
    integral -= (known == 2 ? 2.0 : 1.0) * earlier + later;
    pending = later;
    if (alone) known = 1;
  }
  known = first ? 1 : known + 1;
  before = last * last;
  length = dt;
  last = value;
}

void Statistics::Mean::begin_anew() {
  integral -= pending;
  pending = 0.0;
  known = 1;
}

bool Statistics::Mean::wants_middle() const {
  return known == 2 && 0.5 * length * (before + last * last) > small_part * integral;
}

// What the parabola through the three lies beside the straight line.
void Statistics::Mean::add_middle(double value) {
  if (known == 2) integral += length * (2.0 * value * value - before - last * last) / 3.0;
}

double Statistics::Mean::rms(double duration) const { return std::sqrt(std::max(integral - pending, 0.0) / duration); }

Statistics::Statistics(const Model& model, const Channels& channels, bool long_steps)
    : channels_(channels),
      largest_(model, channels),
      discard_until_(model.settings.start + model.settings.discard),
      joints_(model.joints.size()),
      forces_(model.force_elements.size()),
      drivers_(model.drivers.size()),
      paths_(channels.paths.size()),
      long_steps_(long_steps),
      mean_noise_(discard_until_, model.settings.end, joints_.size() + drivers_.size() + 2 * paths_.size()) {}

// A step that ends a rounding error before the instant belongs to what follows.
bool Statistics::counts(double t) const {
  return !(t < discard_until_ - 1e-12 * std::max(1.0, std::abs(discard_until_)));
}

bool Statistics::begins_inside(double from, double to) const {
  return !seen_ && !counts(from) && counts(to) && discard_until_ - from < (1.0 - 1e-9) * (to - from);
}

void Statistics::note(std::span<const double> row) {
  const double t = row[at(channels_.time)];
  largest_.see(row, t, counts(t));
}

void Statistics::note_inside(std::span<const double> row) {
  note(row);
  const double t = row[at(channels_.time)];
  if (long_steps_ && seen_ && t > last_time_) add_inside(row, t);
}

void Statistics::note_written(std::span<const double> row) {
  note_inside(row);
  if (counts(row[at(channels_.time)])) largest_.note_written();
}

void Statistics::note_written_later(std::span<const double> row) {
  if (counts(row[at(channels_.time)])) largest_.note_written_later(row);
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
  add_means(row, dt, first);
  if (mean_noise_.is_due(t)) {
    double* to = mean_noise_.note(t).data();
    each_mean(*this, [&](const Mean& mean, std::size_t) { *to++ = mean.integral; });
  }
  for (int j = 0; j < static_cast<int>(joints_.size()); ++j) {
    JointSums& sums = joints_[at(j)];
    if (first) sums.loss_start = joint_loss[at(j)];
    sums.loss = joint_loss[at(j)] - sums.loss_start;
  }
  for (std::size_t f = 0; f < forces_.size(); ++f) {
    if (first) forces_[f].work_start = force_work[f];
    forces_[f].work = force_work[f] - forces_[f].work_start;
  }
  for (int d = 0; d < static_cast<int>(drivers_.size()); ++d) {
    DriverSums& sums = drivers_[at(d)];
    if (first) sums.work_start = driver_work[at(d)];
    sums.work = driver_work[at(d)] - sums.work_start;
  }
}

// Of the row that was noted last.
void Statistics::add_inside(std::span<const double> row, double t) {
  add_means(row, t - last_time_, false);
  duration_ += t - last_time_;
  last_time_ = t;
}

// Of the row that was noted last.
void Statistics::add_means(std::span<const double> row, double dt, bool first) {
  const std::span<const double> values = largest_.last();
  each_mean(*this, [&](Mean& mean, std::size_t place) { mean.add(values[place], dt, first, long_steps_); });
  for (int j = 0; j < static_cast<int>(joints_.size()); ++j) {
    JointSums& sums = joints_[at(j)];
    if (channels_.joints[at(j)].contact < 0) continue;
    const double contact = row[at(channels_.joints[at(j)].contact)];
    if (!first) sums.contact_time += 0.5 * dt * (sums.last_contact + contact);
    sums.last_contact = contact;
  }
}

bool Statistics::end_stretch(std::span<const double> row,
                             const std::function<std::span<const double>(double)>& row_at) {
  note(row);
  const double t = row[at(channels_.time)];
  if (!seen_ || !counts(t)) return false;
  add_inside(row, t);
  if (const double length = wants_middle(); length > 0.0) {
    if (const std::span<const double> half_way = row_at(t - 0.5 * length); !half_way.empty()) {
      note(half_way);
      const std::span<const double> values = largest_.last();
      each_mean(*this, [&](Mean& mean, std::size_t place) { mean.add_middle(values[place]); });
      note(row);  // the step ends with it
    }
  }
  begin_stretch();
  return true;
}

double Statistics::wants_middle() const {
  double length = 0.0;
  each_mean(*this, [&](const Mean& mean, std::size_t) {
    if (mean.wants_middle()) length = mean.length;
  });
  return length;
}

void Statistics::begin_stretch() {
  each_mean(*this, [](Mean& mean, std::size_t) { mean.begin_anew(); });
}

void Statistics::add_contact(int joint, double time) {
  ++contacts_total_;
  if (!counts(time)) return;
  ++contacts_;
  ++joints_[at(joint)].contacts;
}

JointStatistics Statistics::joint(int index) const {
  const PeakValues& places = largest_.places();
  const std::span<const double> largest = largest_.in_window();
  const JointSums& sums = joints_[at(index)];
  if (!any()) return {nan, nan, nan, nan, nan, nan, nan, 0, nan};
  JointStatistics out{
      largest[places.force(index)], sums.force.rms(duration_), nan, nan, nan, nan, sums.loss, sums.contacts,
      largest[places.torque(index)]};
  const JointColumns& columns = channels_.joints[at(index)];
  if (columns.contact < 0 || columns.normal_force < 0 || columns.penetration < 0) return out;
  out.max_normal_force = largest[places.normal_force(index)];
  out.max_penetration = largest[places.penetration(index)];
  if (columns.eccentricity_x >= 0) out.max_eccentricity = largest[places.eccentricity(index)];
  out.contact_fraction = sums.contact_time / duration_;
  return out;
}

ForceStatistics Statistics::force(int index) const {
  const PeakValues& places = largest_.places();
  const std::span<const double> largest = largest_.in_window();
  if (!any()) return {nan, nan, nan};
  return {largest[places.applied_force(index)], largest[places.applied_torque(index)], forces_[at(index)].work};
}

DriverStatistics Statistics::driver(int index) const {
  const PeakValues& places = largest_.places();
  const std::span<const double> largest = largest_.in_window();
  if (!any()) return {nan, nan, nan};
  const DriverSums& sums = drivers_[at(index)];
  return {largest[places.effort(index)], sums.effort.rms(duration_), sums.work};
}

PathStatistics Statistics::path(int index) const {
  const PeakValues& places = largest_.places();
  const std::span<const double> largest = largest_.in_window();
  if (!any()) return {nan, nan, nan, nan};
  const PathSums& sums = paths_[at(index)];
  return {largest[places.position_error(index)], sums.position.rms(duration_), largest[places.angle_error(index)],
          sums.angle.rms(duration_)};
}

double Statistics::body_max_speed(int index) const {
  return any() ? largest_.in_window()[largest_.places().speed(index)] : nan;
}

}  // namespace freeplay
