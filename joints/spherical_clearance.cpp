#include <algorithm>
#include <array>
#include <cmath>

#include "freeplay/plugin.h"
#include "spatial_play.h"

namespace freeplay {
namespace play {
namespace {

using space::PairInFirstAxes;
using space::RelativeForce;
using space::RelativeMotion;

constexpr Event ball_events[] = {{"contact_begin", Crossing::rising, 1, event_fields},
                                 {"contact_end", Crossing::falling, 1, event_fields}};

/// Ball (radius R_J, marker b) in a socket (radius R_B, marker a) with play c = R_B - R_J. No constraint rows. With
/// e = P_b - P_a [m] and angular velocities w [rad/s]:
///
///   n = e/|e|    delta = |e| - c    delta' = n.e'    v_T = e' - delta' n + (R_J w_b - R_B w_a) x n
///   F_b = -F_N n + F_T v_T/|v_T|,  F_a = -F_b        for delta > 0, else zero
///
/// Both forces act at one point C = P_b + (R_J - delta/2) n, half-way between the two surfaces, so that the pair has
/// neither a resultant nor a moment. F_T <= 0 is the law's force at the speed |v_T|. Approach speed and history are as
/// in the planar pin with play; a planar motion has its forces. Where only c is known, radii count as zero and there is
/// no friction. Flores, Ambrosio, Claro and Lankarani 2008.
class SphericalClearance final : public Joint {
 public:
  explicit SphericalClearance(const Parameters& p) : play_(p, SurfaceShape::sphere, not_a_number) {}

  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;
    layout.forces_without_coordinate = 1;
    layout.history = static_cast<int>(slots) + play_.memory();
    layout.forces = 1;
    layout.internal_variables = play_.memory();
    layout.analytic_derivatives = 1;
    layout.clearance = play_.radii.clearance;
    play_.surfaces.declare(layout);
    layout.events = ball_events;
    layout.event_roles = begin_and_end;
    layout.kinks = play_.count_kinks();
    layout.channels = gap_channels;
    layout.channel_roles = gap_roles;
  }
  void apply(const JointInput& in, JointForces& out) const override {
    out.potential_rate = 0.0;
    if (flies(in)) return;
    const PairInFirstAxes pair = seen_from_a(in);
    const Gap<double> gap(pair.numbers(), play_);
    if (!touches(in, gap.approach())) return;
    const ContactForce f = normal_force(play_.normal, gap.approach(), in);
    out.potential = f.potential;
    out.potential_rate = storing_power(play_.normal, gap.approach(), f);
    if (play_.memory() > 0) return apply_with_memory(in, pair, gap, f, out);
    pair.write(force(gap, f).total, out);
    if (!out.derivatives.empty()) pair.write_derivatives(force(Gap<Dual>(pair.duals(), play_), f).total, 24, out);
  }

  void initialize(const JointInput& in, Span<double> internal, Span<double> history) const override {
    for (std::size_t k = 0; k < internal.size; ++k) internal[k] = play_.start_of(k);
    play::start(in.t, approach(in), history);
  }
  void begin_step(const JointInput& in, const MarkerAccelerations& acc, double dt,
                  Span<double> history) const override {
    if (!play::begin_step(in, dt, history)) return;
    const Eigen::Vector3d e = space::position(*in.b) - space::position(*in.a),
                          rate = space::velocity(*in.b) - space::velocity(*in.a),
                          second(acc.b[0] - acc.a[0], acc.b[1] - acc.a[1], acc.b[2] - acc.a[2]);
    const Approach gap = approach(in);
    const double distance = e.norm();
    if (distance < 1e-12 * play_.radii.clearance) return;
    // delta'' = n.e'' + (e'.e' - delta'^2)/|e|
    const double bent = e.dot(second) / distance + (rate.squaredNorm() - gap.rate * gap.rate) / distance;
    history[predicted] = predicted_speed(gap, bent, rate, second, dt);
  }
  void events(const JointInput& in, Span<double> g, Span<double> rate) const override {
    write_events(in, approach(in), g, rate);
  }
  void on_event(int index, const JointInput& in, Span<double> internal, Span<double> history,
                Span<double> fields) const override {
    const PairInFirstAxes pair = seen_from_a(in);
    const Gap<double> gap(pair.numbers(), play_);
    if (index == 0) {
      tell_begin(in, gap.approach(), history, fields);
      if (in.mobility != nullptr) {
        const Eigen::Vector3d n = pair.axes() * Eigen::Vector3d(gap.n.x, gap.n.y, gap.n.z);
        const double inverse_mass = n.dot(Eigen::Map<const RowMajor3>(in.mobility) * n);
        history[impact_time] = impact_duration(play_.normal, gap.approach(), play_.radii.clearance, inverse_mass, 1.0);
      }
    } else {
      tell_end(in, gap.approach(), history, fields);
      forget(internal, history);
    }
    fields[1] = std::sqrt(dot(gap.slip, gap.slip));
  }
  void commit(const JointInput& in, Span<const double>, Span<double> history) const override {
    const bool touched = history[phase] != flight;
    play::commit(in, approach(in), play_.normal, 1.0, history);
    if (touched && history[phase] == flight) forget(in.internal, history);
  }

  void observe(const JointInput& in, Span<const double>, Span<double> channels) const override {
    const PairInFirstAxes pair = seen_from_a(in);
    const Gap<double> gap(pair.numbers(), play_);
    Forces<double> f{};
    double normal = 0.0;
    if (touches(in, gap.approach())) {
      const ContactForce contact = normal_force(play_.normal, gap.approach(), in);
      normal = contact.normal;
      std::array<double, 3 * most_law_variables> unused;
      f = play_.memory() == 0 ? force(gap, contact)
                              : force(pair.numbers(), gap, contact, memory(in), {unused.data(), in.internal.size});
    }
    for (std::size_t i = 0; i < 3; ++i) channels[i] = in.b->position[i] - in.a->position[i];
    channels[3] = gap.penetration;
    channels[4] = normal;
    channels[5] = std::sqrt(dot(f.friction, f.friction));
    channels[6] = pair.power(f.total);
    channels[7] = in.history[phase] == flight ? 0.0 : 1.0;
    channels[8] = std::sqrt(dot(gap.slip, gap.slip));
  }
  void kinks(const JointInput& in, Span<double> g) const override {
    if (in.history[phase] == flight) return;
    const PairInFirstAxes pair = seen_from_a(in);
    const Gap<double> gap(pair.numbers(), play_);
    const Approach here = gap.approach();
    if (touches(in, here)) play_.write_kinks(here, std::sqrt(dot(gap.slip, gap.slip)), in, g);
  }
  /// In flight the ball moves by no more than the clearance.
  double step_limit(const JointInput& in) const override {
    if (in.history[phase] != flight) return impact_step(in);
    const double speed = (space::velocity(*in.b) - space::velocity(*in.a)).norm();
    return speed > 0.0 ? play_.radii.clearance / speed : unbounded;
  }
  double free_distance(const JointInput& in) const override {
    if (in.history[phase] != flight) return 0.0;
    return std::max(0.0, play_.radii.clearance - (space::position(*in.b) - space::position(*in.a)).norm());
  }
  const char* warning(const JointInput& in) const override {
    const Approach gap = approach(in);
    if (in.history[phase] == flight || !touches(in, gap)) return nullptr;
    return play_.normal.outside_range({gap.penetration, gap.rate, in.history[approach_speed]});
  }
  void initial_offset(Span<const double> reaction, InitialOffset& out) const override {
    out = play_.start.offset;
    if (!play_.start.loaded) return;
    const Eigen::Vector3d load(reaction[0], reaction[1], reaction[2]);
    const double size = load.norm();
    if (size < 1e-12) return;
    // The socket pushes the ball along -n.
    const double clearance = play_.radii.clearance,
                 distance = clearance + resting_penetration(play_.normal, clearance, size);
    for (int i = 0; i < 3; ++i) out.position[i] = -distance * load[i] / size;
  }
  bool place(double, Pose& b_in_a) const override {
    b_in_a = {{}, {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}};
    return true;
  }

 private:
  /// Where the ball stands in the socket, and how it moves; axes of marker a.
  template <class T>
  struct Gap {
    Gap(const RelativeMotion<T>& motion, const SpatialPlay& play) {
      using std::sqrt;
      const T squared = dot(motion.d, motion.d), distance = sqrt(squared);
      penetration = depth(squared, distance, play.radii.clearance);
      if (space::value_of(distance) >= 1e-12 * play.radii.clearance) n = (T(1.0) / distance) * motion.d;
      rate = dot(n, motion.u);
      slip = across(motion.u, n) + cross(T(play.radius_b()) * motion.w_b - T(play.radius_a()) * motion.w_a, n);
    }
    Approach approach() const { return {space::value_of(penetration), space::value_of(rate)}; }
    /// n' in the axes of a, for the motion that made this; zero at the centre.
    Vec<T> n_rate(const RelativeMotion<T>& motion) const {
      using std::sqrt;
      const T distance = sqrt(dot(motion.d, motion.d));
      if (!(space::value_of(distance) > 0.0)) return {};
      return (T(1.0) / distance) * across(motion.u - cross(motion.w_a, motion.d), n);
    }
    Vec<T> n{T(1.0), T(0.0), T(0.0)}, slip;
    T penetration, rate;
  };
  template <class T>
  struct Forces {
    RelativeForce<T> total;
    Vec<T> friction;
  };

  /// Orientations do not count.
  static PairInFirstAxes seen_from_a(const JointInput& in) {
    return {in, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero()};
  }
  Approach approach(const JointInput& in) const { return Gap<double>(seen_from_a(in).numbers(), play_).approach(); }

  template <class T>
  Forces<T> force(const Gap<T>& gap, const ContactForce& f) const {
    const T normal = space::chained(f.normal, f.d_penetration, gap.penetration, f.d_rate, gap.rate);
    return play_.slides ? forces(gap, normal, play_.friction_force(normal, gap.slip)) : forces(gap, normal, {});
  }
  /// Friction with memory, too: `rates` are those of its internal variables.
  template <class T>
  Forces<T> force(const RelativeMotion<T>& motion, const Gap<T>& gap, const ContactForce& f, const Memory& memory,
                  Span<T> rates) const {
    const T normal = space::chained(f.normal, f.d_penetration, gap.penetration, f.d_rate, gap.rate);
    const auto z = memory.numbers<T>();
    return forces(gap, normal,
                  play_.friction_force<T>(normal, gap.slip, gap.n, gap.n_rate(motion), {z.data(), memory.size}, rates));
  }
  void apply_with_memory(const JointInput& in, const PairInFirstAxes& pair, const Gap<double>& gap,
                         const ContactForce& f, JointForces& out) const {
    const Memory kept = memory(in);
    const RelativeMotion<double> motion = pair.numbers();
    pair.write(force(motion, gap, f, kept, out.internal_rate).total, out);
    if (out.derivatives.empty()) return;
    const auto columns = static_cast<Eigen::Index>(24 + kept.size);
    const RelativeMotion<Dual> duals = pair.duals();
    std::array<Dual, 3 * most_law_variables> rates;
    pair.write_derivatives(force<Dual>(duals, Gap<Dual>(duals, play_), f, kept, {rates.data(), kept.size}).total,
                           columns, out);
    for (std::size_t i = 0; i < kept.size; ++i) pair.write_rate_derivatives(i, rates[i], columns, out);
    differentiate_by_memory(play_, f.normal, gap.slip, gap.n, gap.n_rate(motion), kept,
                            [&](std::size_t j, const Vec<double>& by, Span<const double> rate_by) {
                              const Forces<double> part = forces(gap, 0.0, by);
                              pair.write_internal_column(j, part.total, columns, out);
                              for (std::size_t i = 0; i < kept.size; ++i)
                                out.derivatives[(12 + i) * (24 + kept.size) + 24 + j] = rate_by[i];
                            });
  }
  Memory memory(const JointInput& in) const { return {in.internal, in.history.part(slots, in.internal.size)}; }
  void forget(Span<const double> internal, Span<double> history) const {
    play_.forget(internal, history.part(slots, internal.size));
  }
  template <class T>
  Forces<T> forces(const Gap<T>& gap, const T& normal, const Vec<T>& friction) const {
    Forces<T> forces{{-(normal * gap.n) + friction, {}, {}}, friction};
    const Vec<T> turning = cross(gap.n, friction);
    const T half = T(0.5) * gap.penetration;
    forces.total.moment_a = -((T(play_.radius_a()) + half) * turning);
    forces.total.moment_b = (T(play_.radius_b()) - half) * turning;
    return forces;
  }

  SpatialPlay play_;
};

constexpr auto spherical_clearance_parameters = joined(radius_rows, law_rows, start_rows);

}  // namespace
}  // namespace play

Component spherical_clearance() {
  using namespace play;
  return joint<SphericalClearance>(
      {.name = "spherical-clearance",
       .space = Space::spatial,
       .summary = "Ball and socket with play: the ball floats in the socket and touches it by a contact law.",
       .formula =
           "e = P_b - P_a, n = e/|e|; delta = |e| - c, delta' = n.e', v_T = e' - delta' n + (R_J w_b - R_B w_a) x "
           "n; force on the ball -F_N n + F_T v_T/|v_T| for delta > 0, at the middle of the two surface points. "
           "`ft` is the size of the friction force.",
       .validity =
           "Clearance small against the radii; one contact point; friction laws with internal variables that are "
           "odd in slip and memory.",
       .references = "Flores, Ambrosio, Claro and Lankarani 2008, Kinematics and Dynamics of Multibody Systems with "
                     "Imperfect Joints",
       .parameters = {spherical_clearance_parameters.data(), spherical_clearance_parameters.size()},
       .ideal = "spherical",
       .block = "clearance",
       .first_end = "socket",
       .second_end = "ball"});
}

}  // namespace freeplay
