// System: one look at a point, of which only the terms that are wanted are filled.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/angle.h"
#include "base/index.h"
#include "system/finite.h"
#include "system/system.h"

namespace freeplay {
namespace {

double rate_of(const double* row, const MarkerKinematics& a, const MarkerKinematics& b) {
  double rate = 0.0;
  for (int i = 0; i < 3; ++i) {
    rate += row[i] * a.velocity[i] + row[3 + i] * a.angular_velocity[i] + row[6 + i] * b.velocity[i] +
            row[9 + i] * b.angular_velocity[i];
  }
  return rate;
}

bool same(std::span<const double> a, std::span<const double> b) {
  return b.empty() || std::memcmp(a.data(), b.data(), b.size_bytes()) == 0;
}

}  // namespace

bool Evaluation::has_rows_at(const Point& point) const {
  return (filled & term_position) != 0 && time == point.t && same(q, point.q);
}

bool Evaluation::is_at(const Point& point, unsigned terms) const {
  return (terms & ~filled) == 0 && time == point.t && same(q, point.q) && same(v, point.v) &&
         same(z, point.z.first(z.size())) && same(h, point.h);
}

void System::complete_rates(unsigned terms, Evaluation& e) const {
  fill_rates(terms & ~e.filled, e);
  e.filled |= terms;
}

// What rows that are made one by one have written of nu and gamma already stays.
void System::fill_rates(unsigned terms, Evaluation& e) const {
  if ((terms & term_velocity) != 0) {
    declared_.fill_nu(e);
    move_rows_with_driven(e.v, e.nu, e);
  }
  if ((terms & term_acceleration) != 0) {
    declared_.fill_gamma(mounts_, e);
    move_rows_with_driven(e.driven_a, e.gamma, e);
  }
}

bool System::evaluate(const Point& point, unsigned terms, KeptEvaluation& known, KeptEvaluation& out) const {
  constexpr unsigned of_joints = term_coordinate | term_event | term_turn;
  if (!known->is_at(point, terms & ~of_joints)) {
    return evaluate(point, terms, static_cast<Evaluation&>(out));
  }
  swap(out, known);
  return (terms & of_joints) == 0 || evaluate_coordinates(point, terms & of_joints, out);
}

bool System::complete(const Point& point, Evaluation& e) const {
  return evaluate_coordinates(point, term_coordinate, e);
}

bool System::evaluate(const Point& point, unsigned terms, Evaluation& e) const {
  const Profile::Timer timer(e.profile(), Phase::assembly);
  // At the end of a step velocities are projected where everything else stays.
  const bool all_placed = driven_.empty() || e.driven_time == point.t;
  // nu depends on time and coordinates alone; rows that are made one by one are made anew.
  const bool all_declared = with_rows_.empty() && model_.gears.empty() && driver_rows_.empty();
  const unsigned placed = term_position | (all_declared ? term_velocity : 0u);
  const unsigned kept = all_placed && e.has_rows_at(point) ? e.filled & placed : 0u;
  e.filled = 0;
  if (!fill(point, terms, kept, e)) return false;
  e.filled = terms;
  e.time = point.t;
  std::copy_n(point.z.begin(), e.z.size(), e.z.begin());  // the integrator may carry integrals after them
  std::copy_n(point.h.begin(), e.h.size(), e.h.begin());
  return true;
}

bool System::fill(const Point& point, unsigned terms, unsigned kept, Evaluation& e) const {
  return by_space([&]<class Bodies>(Bodies) { return fill_in<Bodies>(point, terms, kept, e); });
}

template <>
void System::place_markers<planar::Bodies>(const Point& point, bool still, Evaluation& e) const {
  const planar::Mount* const mounts = mounts_.data();
  planar::Arm* const arms = e.arms.data();
  MarkerKinematics* const markers = e.markers.data();
  std::ranges::copy(point.v, e.v.begin());
  if (still) {
    for (std::size_t b = 0; b < at(layout_.free_bodies()); ++b) {
      const double v[3] = {point.v[3 * b], point.v[3 * b + 1], point.v[3 * b + 2]};
      const MarkersOfBody own = markers_of_body_[b];
      for (int i = own.first; i < own.end; ++i) {
        const int m = moving_markers_[at(i)];
        arms[m].w = v[2];
        planar::marker_velocity(v, arms[m], markers[m]);
      }
    }
    return;
  }
  std::ranges::copy(point.q, e.q.begin());
  for (std::size_t b = 0; b < at(layout_.free_bodies()); ++b) {
    // Numbers of their own, which no marker can change.
    const double q[3] = {point.q[3 * b], point.q[3 * b + 1], point.q[3 * b + 2]};
    const double v[3] = {point.v[3 * b], point.v[3 * b + 1], point.v[3 * b + 2]};
    if (e.turns[b].angle != q[2]) e.turns[b] = turn(planar::Bodies{}, q, v);
    const planar::Turn turned = e.turns[b];
    const MarkersOfBody own = markers_of_body_[b];
    for (int i = own.first; i < own.end; ++i) {
      const int m = moving_markers_[at(i)];
      planar::Arm arm;
      planar::marker_arm(mounts[m], q, v, turned, arm);
      arms[m] = arm;
      planar::marker_kinematics(mounts[m], v, turned, arm, markers[m]);
    }
  }
}

template <>
void System::place_markers<spatial::Bodies>(const Point& point, bool, Evaluation& e) const {
  const auto q = [&](std::size_t body) { return &point.q[7 * body]; };
  const auto v = [&](std::size_t body) { return &point.v[6 * body]; };
  std::ranges::copy(point.q, e.q.begin());
  std::ranges::copy(point.v, e.v.begin());
  for (std::size_t b = 0; b < e.spatial_turns.size(); ++b) e.spatial_turns[b] = turn(spatial::Bodies{}, q(b), v(b));
  for (const int m : moving_markers_) {
    const std::size_t body = at(spatial_mounts_[at(m)].body);
    marker_kinematics(spatial_mounts_[at(m)], q(body), v(body), e.spatial_turns[body], e.markers[at(m)],
                      e.spatial_arms[at(m)]);
  }
}

template <class Bodies>
bool System::fill_in(const Point& point, unsigned terms, unsigned kept, Evaluation& e) const {
  e.fault.kind = Fault::Kind::none;
  const bool still = kept != 0;
  place_markers<Bodies>(point, still, e);
  if (variant_ == Variant::closed) {
    for (std::size_t j = 0; j < model_.joints.size(); ++j) {
      if (!model_.joints[j].has_play) continue;
      MarkerKinematics& k = e.shifted[j] = e.markers[at(model_.joints[j].marker_b)];
      for (int i = 0; i < 3; ++i) {
        k.position[i] -= offsets_[j].position[i];
        k.velocity[i] -= offsets_[j].velocity[i];
      }
    }
  }
  const bool moves = !driven_.empty() || (terms & (term_position | term_force)) != 0;
  if (!model_.drivers.empty() && moves && e.motion_time != point.t) {
    std::swap(e.motion, e.other_motion);
    std::swap(e.motion_time, e.other_motion_time);
    if (e.motion_time != point.t) {
      e.motion_time = std::numeric_limits<double>::quiet_NaN();
      if (!motions_->evaluate(point.t, {e.motion.data(), e.motion.size()}, e.motion_work, e.fault.motion)) {
        e.fault.kind = Fault::Kind::motion;
        return false;
      }
      e.motion_time = point.t;
    }
  }
  if (!driven_.empty()) place_driven(point, e);
  if (!evaluate_coordinates(point, terms, e)) return false;
  if ((terms & term_position) != 0) {
    if (!still) declared_.fill_rows(mounts_, e);
    if (!with_rows_.empty() && !evaluate_rows<Bodies>(point, e)) return false;
    if (!model_.gears.empty()) evaluate_gear_rows<Bodies>(e);
    if (!driver_rows_.empty()) evaluate_driver_rows<Bodies>(e);
    fill_rates(terms & ~kept, e);
  }
  if ((terms & term_force) != 0) {
    if (!evaluate_forces<Bodies>(point, (terms & term_derivative) != 0, e)) return false;
    const bool applied = !effort_drivers_.empty() || !model_.forces.empty();
    if (applied && !evaluate_applied<Bodies>(point, e)) return false;
    if (Bodies::velocities == spatial::velocities) add_gyroscopic(point, (terms & term_derivative) != 0, e);
  }
  return true;
}

// The moment -w x (I w) of a turning body, in principal axes, and its derivative by w.
void System::add_gyroscopic(const Point& point, bool derivatives, Evaluation& e) const {
  for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
    const spatial::Vector w = spatial::vector(&point.v[6 * b + 3]), inertia = spatial::vector(&mass_[6 * b + 3]);
    const spatial::Vector spin = inertia.cwiseProduct(w);
    Eigen::Map<spatial::Vector>(&e.force[6 * b + 3]) -= w.cross(spin);
    if (!derivatives) continue;
    double* by_w = &e.gyroscopic_v[9 * b];  // row-major
    for (int c = 0; c < 3; ++c) {
      const spatial::Vector unit = spatial::Vector::Unit(c);
      const spatial::Vector column = -(unit.cross(spin) + inertia[c] * w.cross(unit));
      for (int r = 0; r < 3; ++r) by_w[3 * r + c] = column[r];
    }
  }
}

bool System::evaluate_coordinates(const Point& point, unsigned terms, Evaluation& e) const {
  declared_.fill_coordinates(point, mounts_, terms, e);
  for (const int j : with_coordinate_) {
    const JointRecord& record = records_[at(j)];
    if ((record.coordinate_terms & terms) == 0) continue;
    const JointInput in = input(record, point, e);
    CoordinateRow& row = e.coordinate_rows[at(j)] = CoordinateRow{};
    if (!record.joint.coordinate(in, row, e.fault.message)) return blame(j, e);
    if (!std::isfinite(row.value) && markers_are_finite(record, e)) {
      return refuse(j, "it returned a coordinate that is not a finite number", e);
    }
    if (record.turn >= 0) {
      // The turn nearest to the last accepted angle: a step never turns a joint by more than half a revolution.
      row.value = nearest_turn(row.value, point.h[at(record.turn)]);
    }
    e.coordinate[at(j)] = row.value;
    e.coordinate_rate[at(j)] = rate_of(row.jacobian, *in.a, *in.b);
  }
  return true;
}

/// A joint said itself, in the fault's message, why it failed.
bool System::blame(int joint, Evaluation& e) {
  e.fault.kind = Fault::Kind::plugin;
  e.fault.joint = joint;
  return false;
}

/// Notes what a joint has done wrong. A point that is no number itself is the fault of the iteration alone.
bool System::refuse(int joint, const char* why, Evaluation& e) {
  e.fault.message.id[0] = '\0';
  abi::copy_text(e.fault.message.text, sizeof e.fault.message.text, why);
  return blame(joint, e);
}

bool System::markers_are_finite(const JointRecord& record, const Evaluation& e) {
  return is_finite(e.markers[at(record.marker_a)]) && is_finite(e.markers[at(record.marker_b)]);
}

}  // namespace freeplay
