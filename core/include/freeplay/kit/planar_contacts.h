// Contacts of a joint with play in the plane, any number of them: a joint says where they are, all else is here.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "freeplay/kit/contact_events.h"
#include "freeplay/kit/contact_phase.h"
#include "freeplay/kit/friction_slopes.h"
#include "freeplay/kit/planar_pair.h"

namespace freeplay::play {

/// Laws of all contacts of a joint. Throws BadParameter.
struct PlanarLaws {
  PlanarLaws(const Parameters& p, const ContactPair& pair)
      : PlanarLaws(p.contact_law("clearance.contact", pair), p.friction_law("clearance.friction")) {}
  PlanarLaws(const ContactLawRef& contact_law, const FrictionLawRef& friction_law)
      : normal(contact_law), friction(friction_law) {
    if (friction.internal_variables() > static_cast<int>(most_internal_variables))
      throw BadParameter("clearance.friction", "out-of-range",
                         "this law has more internal variables than the joint keeps");
    variables = static_cast<std::size_t>(friction.internal_variables());
  }
  ContactLawRef normal;
  FrictionLawRef friction;
  std::size_t variables = 0;
};

/// A joint whose contacts stand where `Geometry` says:
///
///   static constexpr std::size_t contacts;                              how many
///   template <class T> ContactPlace<T> place(const PlanarMotion<T>&, std::size_t contact) const;
///   double play;                                                        scale of a flight [m]
///   std::array<double, 2> stand(const PlanarMotion<double>&) const;     first channels: where b stands in its play
///   bool between_walls() const;                                         endless ones, the joint's PlayShape
///
/// One that depends on what was before, as on turns that were counted, keeps numbers of its own in the history:
///
///   static constexpr std::size_t kept;                                  how many
///   void keep_first(const PlanarMotion<double>&, Span<double>) const;   at the start
///   void keep(const PlanarMotion<double>&, Span<double>) const;         after a step was accepted
///   Geometry with(Span<const double>) const;                            the geometry that has them
///
/// With delta, n, and C, where both forces act, delta' = n.v and v_T = t.v, v: velocity of b less that of a at C,
///
///   F_b = -F_N n + F_T t,  F_a = -F_b          for delta > 0, else zero
///
/// for each contact by itself, with phase, approach speed and memory of friction of its own. Nothing switches when
/// further contacts close, so that forces are as smooth as the law.
template <class Geometry>
class PlanarContacts : public Joint {
 public:
  static constexpr std::size_t count = Geometry::contacts;
  static constexpr std::size_t joint_channels = 8, contact_channels = 3;
  static constexpr bool keeps = requires { Geometry::kept; };

  PlanarContacts(const Geometry& geometry, const PlanarLaws& laws) : geometry_(geometry), laws_(laws) {}

  void apply(const JointInput& in, JointForces& out) const override {
    out.potential_rate = 0.0;
    if (all_fly(in)) return;
    const PlanarPair pair(in);
    const Loads loads = load(in, pair.numbers(), Which::touching);
    for (std::size_t i = 0; i < count; ++i) {
      if (!loads.on[i]) continue;
      out.potential += loads.normal[i].potential;
      out.potential_rate += storing_power(laws_.normal, loads.at[i].approach(), loads.normal[i]);
    }
    if (!loads.any) return;
    PlanarPair::Force<double> total;
    for (std::size_t i = 0; i < count; ++i) {
      if (!loads.on[i]) continue;
      const FrictionForce f = friction(in, loads, i, part_of(out.internal_rate, i));
      total.add(force(loads.at[i], loads.normal[i].normal, f.tangential), loads.at[i]);
    }
    pair.write(total, out);
    if (!out.derivatives.empty()) differentiate(in, pair, loads, out);
  }

  void initialize(const JointInput& in, Span<double> internal, Span<double> history) const override {
    std::fill(internal.begin(), internal.end(), 0.0);
    std::fill(history.begin(), history.end(), 0.0);
    const PlanarMotion<double> motion = PlanarPair(in).numbers();
    if constexpr (keeps) geometry_.keep_first(motion, kept(history));
    const Geometry& geometry = with(history);
    for (std::size_t i = 0; i < count; ++i) play::start(in.t, gap(geometry, motion, i), history.part(i * slots, slots));
  }
  void begin_step(const JointInput& in, const MarkerAccelerations& acc, double dt,
                  Span<double> history) const override {
    for (std::size_t i = 0; i < count; ++i) {
      const Span<double> own = history.part(i * slots, slots);
      if (play::begin_step(contact_input(in, i), dt, own)) own[predicted] = predict(in, acc, i, dt);
    }
  }
  void events(const JointInput& in, Span<double> g, Span<double> rate) const override {
    const PlanarMotion<double> motion = PlanarPair(in).numbers();
    const Geometry& geometry = with(in.history);
    for (std::size_t i = 0; i < count; ++i)
      write_events(contact_input(in, i), gap(geometry, motion, i), g.part(2 * i, 2), rate.part(2 * i, 2));
  }
  void on_event(int index, const JointInput& in, Span<double> internal, Span<double> history,
                Span<double> fields) const override {
    const auto i = static_cast<std::size_t>(index / 2);
    const PlanarPair pair(in);
    const PlanarContact<double> at = contact(with(in.history), pair.numbers(), i);
    const JointInput one = contact_input(in, i);
    const Span<double> own = history.part(i * slots, slots);
    if (index % 2 == 0) {
      tell_begin(one, at.approach(), own, fields);
      if (const double moved = inverse_mass(in, pair, at); moved > 0.0)
        own[impact_time] = impact_duration(laws_.normal, at.approach(), geometry_.play, moved, 1.0);
    } else {
      tell_end(one, at.approach(), own, fields);
      forget(i, internal, history);
    }
    fields[1] = at.slip;
    const Eigen::Vector2d normal = pair.in_world(at.normal);
    fields[2] = std::atan2(normal.y(), normal.x());
  }
  void commit(const JointInput& in, Span<const double>, Span<double> history) const override {
    const PlanarMotion<double> motion = PlanarPair(in).numbers();
    const Geometry& geometry = with(in.history);
    for (std::size_t i = 0; i < count; ++i) {
      const Span<double> own = history.part(i * slots, slots);
      const bool touched = own[phase] != flight;
      play::commit(contact_input(in, i), gap(geometry, motion, i), laws_.normal, 1.0, own);
      if (touched && own[phase] == flight) forget(i, in.internal, history);
    }
    if constexpr (keeps) geometry_.keep(motion, kept(history));
  }

  /// Where b stands, deepest delta, sums of F_N, F_T and of the power of the forces, whether any contact is on, v_T of
  /// the one that carries most; then, of several, delta, F_N and F_T of each.
  void observe(const JointInput& in, Span<const double>, Span<double> channels) const override {
    const PlanarMotion<double> motion = PlanarPair(in).numbers();
    const Loads loads = load(in, motion, Which::all);
    double deepest = -unbounded, normal = 0.0, tangential = 0.0, power = 0.0, touching = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      const PlanarContact<double>& at = loads.at[i];
      if (contact_input(in, i).history[phase] != flight) touching = 1.0;
      deepest = std::max(deepest, at.penetration);
      double own_normal = 0.0, own_tangential = 0.0;
      if (loads.on[i]) {
        own_normal = loads.normal[i].normal;
        own_tangential = friction_alone(in, loads, i);
      }
      normal += own_normal;
      tangential += own_tangential;
      power += own_tangential * at.slip - own_normal * at.rate;
      if (count == 1) continue;
      const Span<double> own = channels.part(joint_channels + i * contact_channels, contact_channels);
      own[0] = at.penetration;
      own[1] = own_normal;
      own[2] = own_tangential;
    }
    const std::array<double, 2> stand = with(in.history).stand(motion);
    const double all[] = {stand[0],   stand[1], deepest,  normal,
                          tangential, power,    touching, loads.at[most_loaded(loads)].slip};
    static_assert(std::size(all) == joint_channels);
    std::copy(std::begin(all), std::end(all), channels.begin());
  }
  void contacts(const JointInput& in, Span<double> numbers) const override {
    const Loads loads = load(in, PlanarPair(in).numbers(), Which::touching);
    std::fill(numbers.begin(), numbers.end(), 0.0);
    for (std::size_t i = 0; i < count; ++i) {
      if (!loads.on[i]) continue;
      const ContactForce& f = loads.normal[i];
      const PlanarContact<double>& at = loads.at[i];
      const double tangential = friction_alone(in, loads, i);
      numbers[3 * i] = f.normal;
      numbers[3 * i + 1] = tangential;
      numbers[3 * i + 2] = f.normal * at.rate - storing_power(laws_.normal, at.approach(), f) - tangential * at.slip;
    }
  }
  void kinks(const JointInput& in, Span<double> g) const override {
    const PlanarMotion<double> motion = PlanarPair(in).numbers();
    const Geometry& geometry = with(in.history);
    const std::size_t each = g.size / count;
    for (std::size_t i = 0; i < count; ++i) {
      const JointInput one = contact_input(in, i);
      if (one.history[phase] == flight) continue;
      const PlanarContact<double> at = contact(geometry, motion, i);
      const Approach here = at.approach();
      if (touches(one, here)) write_kinks(laws_.normal, laws_.friction, here, at.slip, one, g.part(each * i, each));
    }
  }
  /// In flight no contact nears its surface by more than the play, whichever way an end may lie.
  double step_limit(const JointInput& in) const override {
    const PlanarMotion<double> motion = PlanarPair(in).numbers();
    const Geometry& geometry = with(in.history);
    double limit = unbounded;
    for (std::size_t i = 0; i < count; ++i) {
      const JointInput one = contact_input(in, i);
      const PlanarContact<double> at = contact(geometry, motion, i);
      const double speed = geometry_.between_walls() ? std::abs(at.rate) : std::sqrt(dot(at.velocity, at.velocity));
      if (one.history[phase] != flight) {
        limit = std::min(limit, impact_step(one));
      } else if (speed > 0.0) {
        limit = std::min(limit, geometry_.play / speed);
      }
    }
    return limit;
  }
  /// Between walls no depth changes by more than the shift across and the way of the contact in a turn.
  double free_distance(const JointInput& in) const override {
    if (!geometry_.between_walls()) return 0.0;
    const PlanarMotion<double> motion = PlanarPair(in).numbers();
    double free = unbounded;
    for (std::size_t i = 0; i < count; ++i) {
      if (in.history[i * slots + phase] != flight) return 0.0;
      free = std::min(free, -contact(with(in.history), motion, i).penetration);
    }
    return std::max(0.0, free);
  }
  const char* warning(const JointInput& in) const override {
    if (all_fly(in)) return nullptr;
    const PlanarMotion<double> motion = PlanarPair(in).numbers();
    const Geometry& geometry = with(in.history);
    for (std::size_t i = 0; i < count; ++i) {
      const JointInput one = contact_input(in, i);
      const Approach here = gap(geometry, motion, i);
      if (one.history[phase] == flight || !touches(one, here)) continue;
      const char* why = laws_.normal.outside_range({here.penetration, here.rate, one.history[approach_speed]});
      if (why != nullptr) return why;
    }
    return nullptr;
  }

 protected:
  /// All of the layout that follows from the contacts; the joint adds its coordinate, events, channels and roles.
  void declare_contacts(JointLayout& layout) const {
    layout.time_scale = unbounded;
    layout.forces = 1;
    layout.forces_without_coordinate = 1;
    layout.analytic_derivatives = 1;
    layout.wants_whole_mobility = 1;
    layout.internal_variables = static_cast<std::int32_t>(count * laws_.variables);
    layout.history = static_cast<std::int32_t>(count * (slots + laws_.variables));
    if constexpr (keeps) layout.history += static_cast<std::int32_t>(Geometry::kept);
    layout.kinks = static_cast<std::int32_t>(count) * count_kinks(laws_.normal, laws_.friction);
    layout.clearance = geometry_.play;
  }
  const Geometry& geometry() const { return geometry_; }
  const PlanarLaws& laws() const { return laws_; }

 private:
  using Dual = PlanarPair::Dual;

  static PlanarContact<double> contact(const Geometry& geometry, const PlanarMotion<double>& motion, std::size_t i) {
    return {geometry.place(motion, i), motion};
  }
  static Approach gap(const Geometry& geometry, const PlanarMotion<double>& motion, std::size_t i) {
    return contact(geometry, motion, i).approach();
  }
  /// The geometry that this history places.
  decltype(auto) with(Span<const double> history) const {
    if constexpr (keeps) {
      return geometry_.with(kept(history));
    } else {
      return (geometry_);
    }
  }
  template <class T>
  static Span<T> kept(Span<T> history) {
    return history.part(history.size - Geometry::kept, Geometry::kept);
  }

  /// Where steps end at events nothing can touch then.
  static bool all_fly(const JointInput& in) {
    if (in.per_contact == 0.0) return false;
    for (std::size_t i = 0; i < count; ++i)
      if (in.history[i * slots + phase] != flight) return false;
    return true;
  }

  /// All contacts, those that are on, and the normal forces there.
  struct Loads {
    std::array<PlanarContact<double>, count> at;
    std::array<ContactForce, count> normal{};
    std::array<bool, count> on{};
    bool any = false;
  };
  /// Those of which the kinematics are wanted: most corners of most joints fly most of the time.
  enum class Which : bool { touching, all };
  Loads load(const JointInput& in, const PlanarMotion<double>& motion, Which which) const {
    const Geometry& geometry = with(in.history);
    Loads loads;
    for (std::size_t i = 0; i < count; ++i) {
      const ContactPlace<double> place = geometry.place(motion, i);
      const JointInput one = contact_input(in, i);
      loads.on[i] = touches(one, {place.penetration, 0.0});
      if (!loads.on[i] && which == Which::touching) continue;
      loads.at[i] = PlanarContact<double>(place, motion);
      if (!loads.on[i]) continue;
      loads.normal[i] = normal_force(laws_.normal, loads.at[i].approach(), one);
      loads.any = true;
    }
    return loads;
  }
  /// The contact that carries most, or lies deepest where none is on.
  static std::size_t most_loaded(const Loads& loads) {
    std::size_t most = 0;
    for (std::size_t i = 1; i < count; ++i) {
      const double more = loads.normal[i].normal - loads.normal[most].normal;
      if (more > 0.0 || (more == 0.0 && loads.at[i].penetration > loads.at[most].penetration)) most = i;
    }
    return most;
  }
  template <class T>
  static Vec2<T> force(const PlanarContact<T>& at, const T& normal, const T& tangential) {
    return tangential * at.tangent - normal * at.normal;
  }

  // --- friction, and what a contact remembers ----------------------------------------------------------------------

  template <class T>
  Span<T> part_of(Span<T> all, std::size_t i) const {
    return all.part(i * laws_.variables, laws_.variables);
  }
  template <class T>
  Span<T> forgotten(Span<T> history, std::size_t i) const {
    return history.part(count * slots + i * laws_.variables, laws_.variables);
  }
  /// Internal variables less what they were when the last contact ended: not every end is marked by an event that
  /// could clear them.
  struct Memory {
    Memory(Span<const double> internal, Span<const double> forgotten) : size(internal.size) {
      for (std::size_t k = 0; k < size; ++k) z[k] = internal[k] - forgotten[k];
    }
    operator Span<const double>() const { return {z, size}; }
    double z[most_internal_variables];
    std::size_t size;
  };
  Memory memory(const JointInput& in, std::size_t i) const {
    return {part_of(in.internal, i), forgotten(in.history, i)};
  }
  void forget(std::size_t i, Span<const double> internal, Span<double> history) const {
    const Span<const double> own = part_of(internal, i);
    std::copy(own.begin(), own.end(), forgotten(history, i).begin());
  }
  FrictionForce friction(const JointInput& in, const Loads& loads, std::size_t i, Span<double> rate) const {
    const Memory kept = memory(in, i);
    return laws_.friction.evaluate({loads.normal[i].normal, loads.at[i].slip, kept}, rate);
  }
  double friction_alone(const JointInput& in, const Loads& loads, std::size_t i) const {
    double unused[most_internal_variables];
    return friction(in, loads, i, {unused, laws_.variables}).tangential;
  }

  // --- derivatives -------------------------------------------------------------------------------------------------

  void differentiate(const JointInput& in, const PlanarPair& pair, const Loads& loads, JointForces& out) const {
    const PlanarMotion<Dual> motion = pair.duals();
    const std::size_t n = laws_.variables, columns = 24 + count * n;
    const Geometry& geometry = with(in.history);
    double unused[most_internal_variables];
    PlanarPair::Force<Dual> total;
    for (std::size_t i = 0; i < count; ++i) {
      if (!loads.on[i]) continue;
      const PlanarContact<Dual> at{geometry.place(motion, i), motion};
      const ContactForce& law = loads.normal[i];
      const FrictionForce f = friction(in, loads, i, {unused, n});
      const Dual normal = space::chained(law.normal, law.d_penetration, at.penetration, law.d_rate, at.rate);
      const Dual tangential = space::chained(f.tangential, f.d_normal, normal, f.d_slip, at.slip);
      total.add(force(at, normal, tangential), at);
      if (n > 0) differentiate_memory(in, pair, loads, i, normal, at.slip, out);
    }
    pair.write_derivatives(total, columns, out);
  }
  void differentiate_memory(const JointInput& in, const PlanarPair& pair, const Loads& loads, std::size_t i,
                            const Dual& normal, const Dual& slip, JointForces& out) const {
    const std::size_t n = laws_.variables, columns = 24 + count * n, first = i * n;
    const Memory kept = memory(in, i);
    FrictionSlopes slopes(laws_.friction, normal.value, slip.value, kept);
    Dual::Gradient rows[most_internal_variables];
    slopes.by_normal_force();
    for (std::size_t k = 0; k < n; ++k) rows[k] = slopes.rates()[k] * normal.gradient;
    slopes.by_slip();
    for (std::size_t k = 0; k < n; ++k)
      pair.write_rate(first + k, rows[k] + slopes.rates()[k] * slip.gradient, columns, out);
    for (std::size_t k = 0; k < n; ++k) {
      PlanarPair::Force<double> part;
      part.add(force(loads.at[i], 0.0, slopes.by_variable(k)), loads.at[i]);
      pair.write_column(first + k, part, columns, out);
      for (std::size_t row = 0; row < n; ++row)
        out.derivatives[(12 + first + row) * columns + 24 + first + k] = slopes.rates()[row];
    }
  }

  // --- beginnings --------------------------------------------------------------------------------------------------

  /// v_0 of a contact that begins in this step, from the exact second derivative of delta.
  double predict(const JointInput& in, const MarkerAccelerations& acc, std::size_t i, double dt) const {
    const PlanarPair pair(in);
    const PlanarContact<double> here = contact(with(in.history), pair.numbers(), i);
    if (geometry_.between_walls() && !may_touch(here, pair.numbers(), acc, dt)) return 0.0;
    const PlanarMotion<Dual> motion = pair.duals();
    const Dual::Gradient rates = pair.rates(acc);
    const PlanarContact<Dual> at{with(in.history).place(motion, i), motion};
    const auto rate_of = [&](const Dual& x) { return x.gradient.dot(rates); };
    // Of a normal that is no unit vector, as where a depth counts an angle.
    const double size = std::hypot(at.normal.x.value, at.normal.y.value);
    const Eigen::Vector2d velocity(at.velocity.x.value, at.velocity.y.value);
    const Eigen::Vector2d second(rate_of(at.velocity.x), rate_of(at.velocity.y));
    return predicted_speed(at.approach(), rate_of(at.rate), dt,
                           [&](double s) { return (keeps ? size : 1.0) * (velocity + s * second).norm(); });
  }
  /// Whether a depth that stands at a flat wall can grow to zero within dt. Its second derivative is at most that of
  /// the contact's point, of the lever r_b on b and r_a on a,
  ///
  ///   |a_b - a_a| + r_b (|alpha_b| + w_b^2) + r_a (|alpha_a| + 3 w_a^2) + 2 |w_a| |v|
  static bool may_touch(const PlanarContact<double>& at, const PlanarMotion<double>& m, const MarkerAccelerations& acc,
                        double dt) {
    const auto length = [](double x, double y) { return std::abs(x) + std::abs(y); };
    const double w_a = std::abs(m.w_a),
                 second = length(acc.b[0] - acc.a[0], acc.b[1] - acc.a[1]) +
                          length(at.arm.x, at.arm.y) * (std::abs(acc.b[5]) + m.w_b * m.w_b) +
                          length(at.from_a.x, at.from_a.y) * (std::abs(acc.a[5]) + 3.0 * w_a * w_a) +
                          2.0 * w_a * length(at.velocity.x, at.velocity.y);
    return !(at.penetration + dt * (std::abs(at.rate) + 0.5 * dt * second) < 0.0);
  }
  /// 1/m = w.(W w) of the wrench w on b at its origin for a unit force at the contact; 0: not known.
  static double inverse_mass(const JointInput& in, const PlanarPair& pair, const PlanarContact<double>& at) {
    if (in.whole_mobility == nullptr) return 0.0;
    const Eigen::Vector2d force = pair.in_world(at.normal);
    const double wrench[6] = {force.x(), force.y(), 0.0, 0.0, 0.0, cross(at.arm, at.normal)};
    double sum = 0.0;
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t k = 0; k < 6; ++k) sum += wrench[i] * in.whole_mobility[6 * i + k] * wrench[k];
    return sum;
  }

  Geometry geometry_;
  PlanarLaws laws_;
};

}  // namespace freeplay::play
