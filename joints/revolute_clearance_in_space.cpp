#include "revolute_clearance_in_space.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "freeplay/kit/planar_marker.h"
#include "journal_start.h"

namespace freeplay {
namespace play {
namespace {

using space::PairInFirstAxes;

/// Journal (radius R_J, marker b) in a bearing (radius R_B, marker a) of length L, in space; the axes are the z axes.
/// No constraint rows. `revolute_play_ends.h` has the kinematics: at each end plane of the bearing, z_a = +-L/2, the
/// axis of the journal has an eccentricity e, a penetration delta = |e| - c and half of the laws' forces,
///
///   on b, at the axis in the end plane:  -F_N(delta, delta')/2 m        m across the journal's axis
///   on b, at C = axis + (R_J - delta/2) n:  F_T(F_N, |v_T|)/2 v_T/|v_T|
///
/// with their opposites on a at the same points. So an untilted journal feels what the planar pin with play gives,
/// and a tilted one touches at one end, or at both ends on opposite sides. Along the axis the journal has the play
/// `axial_clearance` to each side; then a shoulder touches an end face of the bearing with the whole force of the
/// contact law, through P_b and without friction. Each of the four contacts has a history of its own: approach
/// speed, begin and end. Work and stored energy agree exactly at any tilt. Left out: that a tilted round section is an
/// ellipse (1 - cos(tilt) of R_J), the moment of shoulders, the friction on them. Flores and Lankarani 2016, Contact
/// Force Models for Multibody Dynamics; Brutti, Coglitore and Valentini 2011, Nonlinear Dyn 65.
template <Kept way>
class PinInSpace final : public Joint {
 public:
  static constexpr std::size_t contacts_kept = way == Kept::by_shoulders ? places : std::size_t{lower_end} + 1;

  explicit PinInSpace(const Parameters& p) : play_(p, SurfaceShape::cylinder, p.number("clearance.length")), tilt_(p) {
    const double length = p.number("clearance.length");
    if (std::isnan(length))
      throw BadParameter("clearance", "missing-key", "a bearing in a spatial model needs its 'length'");
    const double axial = way == Kept::by_shoulders ? p.number("clearance.axial_clearance") : unbounded;
    bearing_ = {0.5 * length, std::isnan(axial) ? play_.radii.clearance : axial};
  }

  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;
    if constexpr (way == Kept::by_shoulders) layout.coordinate = Coordinate::angle;
    layout.forces_without_coordinate = 1;
    layout.wants_whole_mobility = 1;
    layout.history = static_cast<int>(contacts_kept * slots) + ends * play_.memory();
    layout.forces = 1;
    layout.internal_variables = ends * play_.memory();
    layout.analytic_derivatives = 1;
    layout.free_turns = 1;
    layout.clearance = play_.radii.clearance;
    play_.surfaces.declare(layout);
    layout.events = {end_events, 2 * contacts_kept};
    layout.event_roles = {end_event_roles, 2 * contacts_kept};
    layout.kinks = ends * play_.count_kinks();
    layout.channels = gap_channels;
    layout.channel_roles = way == Kept::by_shoulders ? Span<const ChannelRole>(gap_roles) : along_roles;
  }
  void coordinate(const JointInput& in, CoordinateRow& row) const override {
    if constexpr (way == Kept::by_shoulders) space::AngleAboutZ(in).write(row);
  }
  bool place(double angle, Pose& b_in_a) const override {
    b_in_a = planar::pose(0.0, angle);
    return true;
  }

  void apply(const JointInput& in, JointForces& out) const override {
    out.potential_rate = 0.0;
    const PairInFirstAxes pair = PairInFirstAxes::with_axis(in, 2);
    const RelativeMotion<double> motion = pair.numbers();
    const Normals normals = normal_forces(in, motion);
    if (!normals.any) return;
    for (std::size_t i = 0; i < contacts_kept; ++i) {
      if (!normals.on[i]) continue;
      out.potential += share(i) * normals.force[i].potential;
      out.potential_rate += share(i) * storing_power(play_.normal, normals.gap[i], normals.force[i]);
    }
    if (play_.memory() > 0) return apply_with_memory(in, pair, normals, out);
    pair.write(force(motion, normals, NoMemory{play_}), out);
    if (!out.derivatives.empty()) pair.write_derivatives(force(pair.duals(), normals, NoMemory{play_}), 24, out);
  }

  void initialize(const JointInput& in, Span<double> internal, Span<double> history) const override {
    for (std::size_t k = 0; k < internal.size; ++k)
      internal[k] = play_.start_of(k % static_cast<std::size_t>(play_.memory()));
    const RelativeMotion<double> motion = motion_of(in);
    for (std::size_t i = 0; i < contacts_kept; ++i) play::start(in.t, gap(motion, i), history.part(i * slots, slots));
  }
  void begin_step(const JointInput& in, const MarkerAccelerations& acc, double dt,
                  Span<double> history) const override {
    const PairInFirstAxes pair = PairInFirstAxes::with_axis(in, 2);
    for (std::size_t i = 0; i < contacts_kept; ++i) {
      const Span<double> own = history.part(i * slots, slots);
      if (play::begin_step(contact_input(in, i), dt, own)) own[predicted] = predict(pair, pair.rates(acc), i, dt);
    }
  }
  void events(const JointInput& in, Span<double> g, Span<double> rate) const override {
    const RelativeMotion<double> motion = motion_of(in);
    for (std::size_t i = 0; i < contacts_kept; ++i)
      write_events(contact_input(in, i), gap(motion, i), g.part(2 * i, 2), rate.part(2 * i, 2));
  }
  void on_event(int index, const JointInput& in, Span<double> internal, Span<double> history,
                Span<double> fields) const override {
    const auto place = static_cast<std::size_t>(index / 2);
    const PairInFirstAxes pair = PairInFirstAxes::with_axis(in, 2);
    const RelativeMotion<double> motion = pair.numbers();
    const JointInput one = contact_input(in, place);
    const Span<double> own = history.part(place * slots, slots);
    if (index % 2 == 0) {
      tell_begin(one, gap(motion, place), own, fields);
      if (in.whole_mobility != nullptr) {
        own[impact_time] = impact_duration(play_.normal, gap(motion, place), play_.radii.clearance,
                                           inverse_mass(pair, place, in.whole_mobility), share(place));
      }
    } else {
      tell_end(one, gap(motion, place), own, fields);
      forget(place, internal, history);
    }
    if (!is_end(place)) return;
    const EndGap<double> end = bearing_.end(motion, place, play_);
    fields[1] = along_turn(end, end.slip);
    fields[2] = std::atan2(end.e.y, end.e.x);
  }
  void commit(const JointInput& in, Span<const double>, Span<double> history) const override {
    const RelativeMotion<double> motion = motion_of(in);
    for (std::size_t i = 0; i < contacts_kept; ++i) {
      const Span<double> own = history.part(i * slots, slots);
      const bool touched = own[phase] != flight;
      play::commit(contact_input(in, i), gap(motion, i), play_.normal, share(i), own);
      if (touched && own[phase] == flight) forget(i, in.internal, history);
    }
  }

  void observe(const JointInput& in, Span<const double>, Span<double> channels) const override {
    const PairInFirstAxes pair = PairInFirstAxes::with_axis(in, 2);
    const RelativeMotion<double> motion = pair.numbers();
    const Normals normals = normal_forces(in, motion);
    double deepest = -unbounded, normal = 0.0, tangential = 0.0, touching = 0.0, slip = 0.0;
    std::array<double, std::size_t{ends} * 3 * most_law_variables> unused;
    const Span<double> rates{unused.data(), in.internal.size};
    for (std::size_t i = 0; i < contacts_kept; ++i) {
      if (contact_input(in, i).history[phase] != flight) touching = 1.0;
      if (!is_end(i)) continue;
      deepest = std::max(deepest, normals.gap[i].penetration);
      const EndGap<double> end = bearing_.end(motion, i, play_);
      if (i == loaded_end(normals)) slip = std::sqrt(dot(end.slip, end.slip));
      if (!normals.on[i]) continue;
      normal += share(i) * normals.force[i].normal;
      if (!play_.slides) continue;
      const double whole = normals.force[i].normal;
      const Vec<double> friction = play_.memory() == 0 ? NoMemory{play_}(i, whole, end)
                                                       : WithMemory<double>{*this, in, motion, rates}(i, whole, end);
      tangential += share(i) * along_turn(end, friction);
    }
    for (std::size_t i = 0; i < 3; ++i) channels[i] = in.b->position[i] - in.a->position[i];
    if constexpr (way == Kept::not_along) write_middle(pair, channels);
    channels[3] = deepest;
    channels[4] = normal;
    channels[5] = tangential;
    channels[6] = normals.any ? pair.power(force(in, motion, normals, rates)) : 0.0;
    channels[7] = touching;
    channels[8] = slip;
  }
  void contacts(const JointInput& in, Span<double> numbers) const override {
    const RelativeMotion<double> motion = motion_of(in);
    const Normals normals = normal_forces(in, motion);
    std::fill(numbers.begin(), numbers.end(), 0.0);
    std::array<double, std::size_t{ends} * 3 * most_law_variables> unused;
    const Span<double> rates{unused.data(), in.internal.size};
    for (std::size_t i = 0; i < contacts_kept; ++i) {
      if (!normals.on[i]) continue;
      const ContactForce& f = normals.force[i];
      const Approach& here = normals.gap[i];
      double tangential = 0.0, lost = f.normal * here.rate - storing_power(play_.normal, here, f);
      if (is_end(i) && play_.slides) {
        const EndGap<double> end = bearing_.end(motion, i, play_);
        const Vec<double> friction = play_.memory() == 0
                                         ? NoMemory{play_}(i, f.normal, end)
                                         : WithMemory<double>{*this, in, motion, rates}(i, f.normal, end);
        tangential = along_turn(end, friction);
        lost -= dot(friction, end.slip);
      }
      numbers[3 * i] = share(i) * f.normal;
      numbers[3 * i + 1] = share(i) * tangential;
      numbers[3 * i + 2] = share(i) * lost;
    }
  }
  void kinks(const JointInput& in, Span<double> g) const override {
    const RelativeMotion<double> motion = motion_of(in);
    const std::size_t each = g.size / ends;
    for (std::size_t i = 0, end = 0; i < contacts_kept; ++i) {
      if (!is_end(i)) continue;
      const Span<double> own = g.part(each * end++, each);
      const JointInput one = contact_input(in, i);
      const Approach here = gap(motion, i);
      if (one.history[phase] == flight || !touches(one, here)) continue;
      const EndGap<double> there = bearing_.end(motion, i, play_);
      const double speed = std::sqrt(dot(there.slip, there.slip));
      const double slip = std::copysign(speed, along_turn(there, there.slip));
      play_.write_kinks(here, slip, one, own);
    }
  }
  /// In flight no part of the journal moves by more than the clearance; beside a contact, not towards the bearing.
  double step_limit(const JointInput& in) const override {
    const RelativeMotion<double> motion = motion_of(in);
    bool flies = true;
    for (std::size_t i = 0; i < contacts_kept; ++i) flies = flies && contact_input(in, i).history[phase] == flight;
    double limit = unbounded;
    for (std::size_t i = 0; i < contacts_kept; ++i) {
      const JointInput one = contact_input(in, i);
      if (one.history[phase] != flight) {
        limit = std::min(limit, impact_step(one));
        continue;
      }
      double speed = std::abs(gap(motion, i).rate);
      if (flies && is_end(i)) {
        const EndGap<double> end = bearing_.end(motion, i, play_);
        Vec<double> h = end.h;
        if constexpr (way == Kept::not_along) h = end.g - (end.g.z / motion.r.z) * motion.r;
        speed = std::sqrt(dot(h, h));
      }
      if (speed > 0.0) limit = std::min(limit, play_.radii.clearance / speed);
    }
    return limit;
  }
  const char* warning(const JointInput& in) const override {
    const RelativeMotion<double> motion = motion_of(in);
    for (std::size_t i = 0; i < contacts_kept; ++i) {
      const JointInput one = contact_input(in, i);
      const Approach here = gap(motion, i);
      if (one.history[phase] == flight || !touches(one, here)) continue;
      const char* why = play_.normal.outside_range({here.penetration, here.rate, one.history[approach_speed]});
      if (why != nullptr) return why;
    }
    return nullptr;
  }
  /// Nothing nears a wall by more than the way of the journal, a little more where its axis leans.
  double free_distance(const JointInput& in) const override {
    double free = unbounded;
    const RelativeMotion<double> motion = motion_of(in);
    for (std::size_t i = 0; i < contacts_kept; ++i) {
      if (contact_input(in, i).history[phase] != flight) return 0.0;
      free = std::min(free, -gap(motion, i).penetration);
    }
    return free > 0.0 ? free_way(motion, free, bearing_.lever(motion)) : 0.0;
  }
  void free_levers(const JointInput& in, Span<double> levers) const override {
    levers[0] = levers[1] = 0.0;
    levers[2] = bearing_.lever(motion_of(in));
  }
  void initial_offset(Span<const double> reaction, InitialOffset& out) const override {
    write_journal_start(play_, bearing_, tilt_, way == Kept::by_shoulders, reaction, out);
  }

 private:
  /// The contacts that are on, and the whole force of the law in each.
  struct Normals {
    std::array<Approach, contacts_kept> gap;
    std::array<ContactForce, contacts_kept> force;
    std::array<bool, contacts_kept> on{};
    bool any = false;
  };

  static RelativeMotion<double> motion_of(const JointInput& in) { return PairInFirstAxes::with_axis(in, 2).numbers(); }
  Approach gap(const RelativeMotion<double>& motion, std::size_t place) const {
    return bearing_.approach(motion, place, play_);
  }
  Normals normal_forces(const JointInput& in, const RelativeMotion<double>& motion) const {
    Normals normals{};
    for (std::size_t i = 0; i < contacts_kept; ++i) {
      normals.gap[i] = gap(motion, i);
      const JointInput one = contact_input(in, i);
      if (!touches(one, normals.gap[i])) continue;
      normals.force[i] = normal_force(play_.normal, normals.gap[i], one);
      normals.on[i] = normals.any = true;
    }
    return normals;
  }

  /// The end that carries more, or lies deeper where none touches.
  static std::size_t loaded_end(const Normals& n) {
    const auto load = [&](std::size_t i) { return n.on[i] ? n.force[i].normal : 0.0; };
    const double more = load(lower_end) - load(upper_end);
    const bool lower = more > 0.0 || (more == 0.0 && n.gap[lower_end].penetration > n.gap[upper_end].penetration);
    return lower ? lower_end : upper_end;
  }

  /// Eccentricity of the shaft's axis in the middle of its sleeve, world axes: its origin may be far along.
  void write_middle(const PairInFirstAxes& pair, Span<double> channels) const {
    const Vec<double> e = EndGap<double>(pair.numbers(), 0.0, 0.0, play_).e;
    Eigen::Map<Eigen::Vector3d>(channels.data) = pair.axes() * Eigen::Vector3d(e.x, e.y, 0.0);
  }

  /// Only the ends slide and have a memory.
  static constexpr int ends = 2;

  /// Part of all internal variables, or of their rates, that is of one end.
  template <class T>
  Span<T> part_of(Span<T> all, std::size_t place) const {
    const auto count = static_cast<std::size_t>(play_.memory());
    return all.part(place * count, count);
  }
  template <class T>
  Span<T> forgotten(Span<T> history, std::size_t place) const {
    const std::size_t first = contacts_kept * slots;
    return part_of(history.part(first, history.size - first), place);
  }
  Memory memory(const JointInput& in, std::size_t place) const {
    return {part_of(in.internal, place), forgotten(in.history, place)};
  }
  void forget(std::size_t place, Span<const double> internal, Span<double> history) const {
    if (!is_end(place)) return;
    play_.forget(part_of(internal, place), forgotten(history, place));
  }

  /// The force of friction at an end by the law alone,
  struct NoMemory {
    const SpatialPlay& play;
    template <class T>
    Vec<T> operator()(std::size_t, const T& normal, const EndGap<T>& gap) const {
      return play.friction_force(normal, gap.slip);
    }
  };
  /// and by a law with internal variables, whose rates it writes.
  template <class T>
  struct WithMemory {
    const PinInSpace& joint;
    const JointInput& in;
    const RelativeMotion<T>& motion;
    Span<T> rates;
    Vec<T> operator()(std::size_t place, const T& normal, const EndGap<T>& gap) const {
      const Memory memory = joint.memory(in, place);
      const auto z = memory.numbers<T>();
      return joint.play_.template friction_force<T>(normal, gap.slip, gap.n, gap.n_rate(motion),
                                                    {z.data(), memory.size}, joint.part_of(rates, place));
    }
  };

  RelativeForce<double> force(const JointInput& in, const RelativeMotion<double>& motion, const Normals& normals,
                              Span<double> rates) const {
    if (play_.memory() == 0) return force(motion, normals, NoMemory{play_});
    return force(motion, normals, WithMemory<double>{*this, in, motion, rates});
  }
  void apply_with_memory(const JointInput& in, const PairInFirstAxes& pair, const Normals& normals,
                         JointForces& out) const {
    const RelativeMotion<double> motion = pair.numbers();
    pair.write(force(motion, normals, WithMemory<double>{*this, in, motion, out.internal_rate}), out);
    if (out.derivatives.empty() || !play_.slides) return;
    const std::size_t size = in.internal.size;
    const auto columns = static_cast<Eigen::Index>(24 + size);
    const RelativeMotion<Dual> duals = pair.duals();
    std::array<Dual, std::size_t{ends} * 3 * most_law_variables> rates;
    pair.write_derivatives(force(duals, normals, WithMemory<Dual>{*this, in, duals, {rates.data(), size}}), columns,
                           out);
    for (std::size_t place = 0; place < ends; ++place) {
      if (!normals.on[place]) continue;
      const Memory kept = memory(in, place);
      const std::size_t first = place * kept.size;
      for (std::size_t i = 0; i < kept.size; ++i)
        pair.write_rate_derivatives(first + i, rates[first + i], columns, out);
      const EndGap<double> gap = bearing_.end(motion, place, play_);
      const Vec<double> arm = friction_arm(gap);
      differentiate_by_memory(play_, normals.force[place].normal, gap.slip, gap.n, gap.n_rate(motion), kept,
                              [&](std::size_t j, const Vec<double>& by, Span<const double> rate_by) {
                                RelativeForce<double> part{};
                                part.add(share(place) * by, arm, motion.d);
                                pair.write_internal_column(first + j, part, columns, out);
                                for (std::size_t i = 0; i < kept.size; ++i)
                                  out.derivatives[(12 + first + i) * (24 + size) + 24 + first + j] = rate_by[i];
                              });
    }
  }
  template <class T>
  Vec<T> friction_arm(const EndGap<T>& gap) const {
    return gap.q + (T(play_.radius_b()) - T(0.5) * gap.penetration) * gap.n;
  }

  template <class T, class Friction>
  RelativeForce<T> force(const RelativeMotion<T>& motion, const Normals& normals, const Friction& friction) const {
    RelativeForce<T> total{};
    for (std::size_t i = 0; i < contacts_kept; ++i) {
      if (!normals.on[i]) continue;
      const ContactForce& f = normals.force[i];
      if (!is_end(i)) {
        const ShoulderGap<T> gap = bearing_.shoulder(motion, i);
        const T normal = space::chained(f.normal, f.d_penetration, gap.penetration, f.d_rate, gap.rate);
        total.add({T(0.0), T(0.0), -(T(side(i)) * normal)}, {}, motion.d);
        continue;
      }
      const EndGap<T> gap = bearing_.end(motion, i, play_);
      const T normal = space::chained(f.normal, f.d_penetration, gap.penetration, f.d_rate, gap.rate);
      total.add(T(-share(i)) * (normal * gap.m), gap.q, motion.d);
      if (!play_.slides) continue;
      total.add(T(share(i)) * friction(i, normal, gap), friction_arm(gap), motion.d);
    }
    return total;
  }

  /// v_0 of a contact that begins in this step, from the exact second derivative of delta.
  double predict(const PairInFirstAxes& pair, const Dual::Gradient& rates, std::size_t place, double dt) const {
    const RelativeMotion<Dual> motion = pair.duals();
    const auto rate_of = [&](const Dual& x) { return x.gradient.dot(rates); };
    if (!is_end(place)) {
      const ShoulderGap<Dual> gap = bearing_.shoulder(motion, place);
      const double second = rate_of(gap.rate);
      return predicted_speed({gap.penetration.value, gap.rate.value}, second, {gap.rate.value, 0.0, 0.0},
                             {second, 0.0, 0.0}, dt);
    }
    const Vec<double> e = bearing_.end(pair.numbers(), place, play_).e;
    if (std::sqrt(dot(e, e)) < 1e-12 * play_.radii.clearance) return 0.0;
    const EndGap<Dual> gap = bearing_.end(motion, place, play_);
    const auto vector = [](const Vec<Dual>& v) { return Eigen::Vector3d(v.x.value, v.y.value, v.z.value); };
    const Eigen::Vector3d h = vector(gap.h), second(rate_of(gap.h.x), rate_of(gap.h.y), rate_of(gap.h.z));
    return predicted_speed({gap.penetration.value, gap.rate.value}, rate_of(gap.rate), h,
                           second + vector(motion.w_a).cross(h), dt);
  }

  /// 1/m = w.(W w) of the wrench w on b at its origin for a unit normal force: an end that meets the bearing also turns
  /// the journal.
  double inverse_mass(const PairInFirstAxes& pair, std::size_t place, const double* mobility) const {
    Eigen::Vector3d n(0.0, 0.0, 1.0), arm(0.0, 0.0, 0.0);
    if (is_end(place)) {
      const EndGap<double> end = bearing_.end(pair.numbers(), place, play_);
      n = {end.m.x, end.m.y, end.m.z};
      arm = {end.q.x, end.q.y, end.q.z};
    }
    Eigen::Matrix<double, 6, 1> wrench;
    wrench << pair.axes() * n, pair.axes() * arm.cross(n);
    return wrench.dot(Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(mobility) * wrench);
  }

  /// Size of a tangential vector with the sign of its part along t = z_a x n.
  static double along_turn(const EndGap<double>& end, const Vec<double>& v) {
    return std::copysign(std::sqrt(dot(v, v)), end.n.x * v.y - end.n.y * v.x);
  }

  SpatialPlay play_;
  TiltStart tilt_;
  Bearing bearing_{};
};

}  // namespace
}  // namespace play

JointFace revolute_clearance_in_space() { return joint_face<play::PinInSpace<play::Kept::by_shoulders>>(); }
JointFace cylindrical_clearance_in_space() { return joint_face<play::PinInSpace<play::Kept::not_along>>(); }

}  // namespace freeplay
