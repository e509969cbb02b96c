// Joints that keep the contract, and can be made to break one of its rules.
#pragma once

#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

#include "component/joint_ref.h"
#include "freeplay/eigen.h"

namespace freeplay::test {

/// One way to be wrong.
enum class Flaw {
  none,
  // rows
  jacobian_entry,
  jacobian_lever,
  nu,
  gamma,
  coordinate_row,
  coordinate_bias,
  twice_the_same_row,
  place_off_the_rows,
  place_off_the_coordinate,
  place_stretches,
  no_pin,
  other_rows,
  other_coordinate,
  wrong_when_turned,
  wrong_when_turning,
  wrong_when_fast,
  wrong_when_late,
  wrong_when_far,
  declares_in_turn,
  // forces
  no_reaction,
  no_moment,
  negative_damping,
  silent_potential,
  potential_rate,
  derivative_entry,
  derivative_by_speed,
  derivative_by_z,
  force_with_derivatives,
  undeclared_forces,
  bristle_pushes,
  // memory
  counts_calls,
  keeps_contact,
  event_rate,
  // calls
  not_a_number,
  throws,
  allocates,
  writes_beside_rows,
  writes_beside_rates,
  writes_beside_history,
  step_limit_zero,
  free_too_far,
  bounds_too_wide,
  timed_force,
  earlier_corner,
  wandering_corner,
  offset_nowhere,
  negative_rows
};

using Vector2 = Eigen::Vector2d;
inline Vector2 xy(const double (&x)[3]) { return {x[0], x[1]}; }

/// The distance of the origins follows L(t) = 0.3 + 0.1 sin(2 t), and the markers do not turn against each other:
///   Phi_1 = (d.d - L^2)/2,  Phi_2 = theta_b - theta_a;   coordinate |d|
class Tether final : public Joint {
 public:
  explicit Tether(Flaw flaw = Flaw::none) : flaw_(flaw) {}

  void declare(JointLayout& layout) const override {
    layout.coordinate = Coordinate::position;
    layout.constraint_rows = flaw_ == Flaw::negative_rows ? -2 : 2;
    layout.pin = flaw_ == Flaw::no_pin ? 1 : 0;
    layout.planar_coordinate = flaw_ == Flaw::other_coordinate ? 1 : 0;
  }
  void coordinate(const JointInput& in, CoordinateRow& row) const override {
    const Vector2 d = xy(in.b->position) - xy(in.a->position), rate = xy(in.b->velocity) - xy(in.a->velocity);
    const double distance = d.norm(), along = d.dot(rate) / distance;
    row.value = distance;
    row.bias = (rate.squaredNorm() - along * along) / distance;
    if (flaw_ == Flaw::coordinate_bias) row.bias = -row.bias;
    write(row.jacobian, d / distance);
    if (flaw_ == Flaw::coordinate_row) row.jacobian[11] += 1e-3;
  }
  void constrain(const JointInput& in, ConstraintRows& rows) const override {
    const Vector2 d = xy(in.b->position) - xy(in.a->position), rate = xy(in.b->velocity) - xy(in.a->velocity);
    const double s = std::sin(2.0 * in.t), c = std::cos(2.0 * in.t);
    const double length = 0.3 + 0.1 * s, speed = 0.2 * c, second = -0.4 * s;
    rows.phi[0] = 0.5 * (d.squaredNorm() - length * length);
    write(rows.jacobian.data, d);
    rows.nu[0] = length * speed;
    rows.gamma[0] = speed * speed + length * second - rate.squaredNorm();
    rows.phi[1] = turn(in);
    rows.jacobian[12 + 5] = -1.0;
    rows.jacobian[12 + 11] = 1.0;
    break_rows(rows);
  }

 private:
  static double turn(const JointInput& in) {
    const double *a = in.a->rotation, *b = in.b->rotation;
    return std::atan2(a[0] * b[3] - a[3] * b[0], a[0] * b[0] + a[3] * b[3]);
  }
  static void write(double* row, const Vector2& direction) {
    for (int i = 0; i < 2; ++i) {
      row[i] = -direction[i];
      row[6 + i] = direction[i];
    }
  }
  void break_rows(ConstraintRows& rows) const {
    if (flaw_ == Flaw::jacobian_entry) rows.jacobian[7] *= 1.001;
    if (flaw_ == Flaw::jacobian_lever) rows.jacobian[5] += 0.01;
    if (flaw_ == Flaw::nu) rows.nu[0] = -rows.nu[0];
    if (flaw_ == Flaw::gamma) rows.gamma[0] += 0.01;
    if (flaw_ == Flaw::twice_the_same_row) {
      rows.phi[1] = rows.phi[0];
      rows.nu[1] = rows.nu[0];
      rows.gamma[1] = rows.gamma[0];
      for (std::size_t i = 0; i < 12; ++i) rows.jacobian[12 + i] = rows.jacobian[i];
    }
    if (flaw_ == Flaw::writes_beside_rows) rows.jacobian[24] = 0.0;
  }
  Flaw flaw_;
};

/// A hinge, which can place a body.
class Swivel final : public Joint {
 public:
  explicit Swivel(Flaw flaw = Flaw::none) : flaw_(flaw) {}
  void declare(JointLayout& layout) const override {
    layout.coordinate = Coordinate::angle;
    layout.constraint_rows = 2;
    layout.pin = 1;
    static constexpr PlanarRow origins[] = {PlanarRow::origins}, others[] = {PlanarRow::across, PlanarRow::turn};
    layout.planar_rows = flaw_ == Flaw::other_rows ? Span<const PlanarRow>(others) : Span<const PlanarRow>(origins);
    layout.planar_coordinate = 1;
    if (flaw_ == Flaw::declares_in_turn) layout.history = ++declared_ % 2;
  }
  void coordinate(const JointInput& in, CoordinateRow& row) const override {
    const double *a = in.a->rotation, *b = in.b->rotation;
    row.value = std::atan2(a[0] * b[3] - a[3] * b[0], a[0] * b[0] + a[3] * b[3]);
    row.jacobian[5] = -1.0;
    row.jacobian[11] = 1.0;
  }
  void constrain(const JointInput& in, ConstraintRows& rows) const override {
    for (std::size_t i = 0; i < 2; ++i) {
      rows.phi[i] = in.b->position[i] - in.a->position[i];
      rows.jacobian[12 * i + i] = -1.0;
      rows.jacobian[12 * i + 6 + i] = 1.0;
    }
    if (is_beyond(in)) rows.jacobian[0] = 0.0;
  }
  bool place(double angle, Pose& pose) const override {
    const double turned = flaw_ == Flaw::place_off_the_coordinate ? -angle : angle;
    const double c = std::cos(turned), s = std::sin(turned);
    pose = {{flaw_ == Flaw::place_off_the_rows ? 1e-6 : 0.0, 0.0, 0.0}, {c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0}};
    if (flaw_ == Flaw::place_stretches) pose.rotation[1] *= 2.0;
    return true;
  }

 private:
  /// In a state that a narrow choice of states does not reach.
  bool is_beyond(const JointInput& in) const {
    if (flaw_ == Flaw::wrong_when_turned) return std::abs(in.coordinate) > 2.5;
    if (flaw_ == Flaw::wrong_when_turning) return in.a->angular_velocity[2] > 5.0;
    if (flaw_ == Flaw::wrong_when_fast) return std::abs(in.b->velocity[0]) > 2.5;
    if (flaw_ == Flaw::wrong_when_late) return in.t > 10.0;
    if (flaw_ == Flaw::wrong_when_far) return (xy(in.b->position) - xy(in.a->position)).norm() > 2.5;
    return false;
  }
  Flaw flaw_;
  mutable int declared_ = 0;
};

/// A ball in a cage of radius c, in the plane; e = P_b - P_a, n = e/|e|, delta = |e| - c > 0:
///   F_b = -(k delta + d delta' + k_z (delta - z)) n,   z' = (delta - z)/tau, without contact z' = -z/tau
/// `relaxing` has z, otherwise k_z = 0. History: contacts so far, deepest penetration.
class Cage final : public Joint {
 public:
  explicit Cage(Flaw flaw = Flaw::none, bool relaxing = false, double stiffness = 2e4)
      : flaw_(flaw), relaxing_(relaxing), k_(stiffness) {}

  void declare(JointLayout& layout) const override;
  void apply(const JointInput& in, JointForces& out) const override;
  void initialize(const JointInput&, Span<double> z, Span<double> h) const override {
    for (double& x : z) x = 0.0;
    for (double& x : h) x = 0.0;
  }
  void events(const JointInput& in, Span<double> g, Span<double> rate) const override {
    const Gap gap(in);
    g[0] = gap.delta;
    rate[0] = flaw_ == Flaw::event_rate ? 2.0 * gap.rate : gap.rate;
  }
  void on_event(int, const JointInput&, Span<double>, Span<double> history, Span<double> fields) const override {
    history[0] += 1.0;
    fields[0] = history[0];
  }
  void commit(const JointInput& in, Span<const double>, Span<double> history) const override {
    history[1] = std::max(history[1], Gap(in).delta);
    if (flaw_ == Flaw::keeps_contact) deepest_ = std::max(deepest_, Gap(in).delta);
    if (flaw_ == Flaw::writes_beside_history) history[2] = 0.0;
  }
  void observe(const JointInput& in, Span<const double>, Span<double> channels) const override {
    channels[0] = flaw_ == Flaw::keeps_contact ? deepest_ : Gap(in).delta;
  }
  double step_limit(const JointInput&) const override { return flaw_ == Flaw::step_limit_zero ? 0.0 : unbounded; }
  double next_corner(double t) const override {
    return flaw_ == Flaw::earlier_corner ? t : flaw_ == Flaw::wandering_corner ? t + 1.0 : unbounded;
  }
  double free_distance(const JointInput& in) const override {
    const double left = clearance_ - Gap(in).distance;
    return !(left > 0.0) || relaxing_ ? 0.0 : flaw_ == Flaw::free_too_far ? 2.0 * left : left;
  }
  void initial_offset(Span<const double>, InitialOffset& out) const override {
    out.position[0] = flaw_ == Flaw::offset_nowhere ? std::numeric_limits<double>::quiet_NaN() : 0.001;
  }

 private:
  static constexpr double clearance_ = 0.01, damping_ = 0.5, relaxing_stiffness_ = 8e3, tau_ = 0.02;

  struct Gap {
    explicit Gap(const JointInput& in)
        : e(xy(in.b->position) - xy(in.a->position)),
          e_rate(xy(in.b->velocity) - xy(in.a->velocity)),
          distance(e.norm()),
          delta(distance - clearance_),
          n(e / distance),
          rate(n.dot(e_rate)) {}
    Vector2 e, e_rate;
    double distance, delta;
    Vector2 n;
    double rate;
  };
  void break_forces(const JointInput& in, JointForces& out) const;
  void differentiate(const Gap& gap, double force, Span<double> table) const;

  Flaw flaw_;
  bool relaxing_;
  double k_;
  mutable int calls_ = 0;
  mutable double deepest_ = 0.0;
};

template <class J>
JointRef handle(const J& joint) {
  return JointRef(abi::joint_table<J>, &joint);
}

}  // namespace freeplay::test
