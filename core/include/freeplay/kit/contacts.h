// Contacts of a joint with play, any number of them, in the plane or in space: a joint says where they are, a class of
// kinematics how bodies move, all else is here.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "freeplay/kit/contact_events.h"
#include "freeplay/kit/contact_parts.h"
#include "freeplay/kit/contact_phase.h"
#include "freeplay/kit/dual.h"

namespace freeplay::play {

/// A joint whose contacts stand where `Geometry` says:
///
///   static constexpr std::size_t contacts;                              how many
///   template <class T> Place<T> place(const Motion<T>&, std::size_t contact) const;
///   double play;                                                        scale of a flight [m]
///   std::array<double, n> stand(const Motion<double>&) const;           first channels: where b stands in its play
///   bool between_walls() const;                                         endless ones, the joint's PlayShape
///
/// One whose b may go away from the surface further than `play` has
///
///   static constexpr bool leaves = true;                                steps grow with the distance then
///
/// One whose contacts share the laws' forces has
///
///   static constexpr double share;                                      part of them that each contact has
///
/// One of spatial models whose contacts are points of b before flat walls, by which runs leave it alone in flight, has
///
///   std::array<double, 3> levers() const;                               most of their coordinates in the axes of b [m]
///
/// One that depends on what was before, as on turns that were counted, keeps numbers of its own in the history:
///
///   static constexpr std::size_t kept;                                  how many
///   void keep_first(const Motion<double>&, Span<double>) const;         at the start
///   void keep(const Motion<double>&, Span<double>) const;               after a step was accepted
///   Geometry with(Span<const double>) const;                            the geometry that has them
///
/// With delta, n, and C, where both forces act, delta' = n.v and v_T = v - delta' n, v: velocity of b less that of a at
/// C, and the forces F_N and F_T of the laws,
///
///   F_b = share (-F_N n + F_T),  F_a = -F_b          for delta > 0, else zero
///
/// for each contact by itself, with phase, approach speed and memory of friction of its own. Nothing switches when
/// further contacts close, so that forces are as smooth as the law.
template <class Geometry, class Kinematics>
class Contacts : public Joint {
 public:
  using Laws = typename Kinematics::Laws;
  template <class T>
  using Motion = typename Kinematics::template Motion<T>;

  static constexpr std::size_t count = Geometry::contacts, contact_channels = 3;
  static constexpr double share = share_of<Geometry>();
  static_assert(
      requires(const Geometry& g) { double{g.play}; },
      "a geometry has a number `play`: how far the bodies move freely [m]");
  static constexpr bool keeps = requires { Geometry::kept; };
  static constexpr bool has_levers = requires(const Geometry& g) { g.levers(); };

  Contacts(const Geometry& geometry, const Laws& laws) : geometry_(geometry), laws_(laws) {}

  void apply(const JointInput& in, JointForces& out) const override {
    out.potential_rate = 0.0;
    if (all_fly(in)) return;
    const Pair pair(in);
    const Loads loads = load(in, pair.numbers(), Which::touching);
    if (!loads.any) return;
    typename Kinematics::template Force<double> total{};
    for (std::size_t i = 0; i < count; ++i) {
      if (!loads.on[i]) continue;
      const Contact<double>& at = loads.at[i];
      out.potential += share * loads.normal[i].potential;
      out.potential_rate += share * storing_power(laws_.normal, at.approach(), loads.normal[i]);
      const Sideways friction =
          Kinematics::friction(laws_, loads.normal[i].normal, at, memory(in, i), part_of(out.internal_rate, i));
      if constexpr (stores) {
        const Stored more = stored(in, i, part_of(out.internal_rate, i));
        out.potential += share * more.energy;
        out.potential_rate += share * more.rate;
      }
      total.add(share * Kinematics::force(at, loads.normal[i].normal, friction), at);
    }
    pair.write(total, out);
    if (!out.derivatives.empty()) differentiate(in, pair, loads, out);
  }

  void initialize(const JointInput& in, Span<double> internal, Span<double> history) const override {
    for (std::size_t k = 0; k < internal.size; ++k) internal[k] = laws_.start_of(k % each_memory());
    std::fill(history.begin(), history.end(), 0.0);
    const Pair pair(in);
    const Motion<double>& motion = pair.numbers();
    if constexpr (keeps) geometry_.keep_first(motion, kept(history));
    const Geometry& geometry = with(history);
    for (std::size_t i = 0; i < count; ++i) play::start(in.t, gap(geometry, motion, i), history.part(i * slots, slots));
  }
  void begin_step(const JointInput& in, const MarkerAccelerations& acc, double dt,
                  Span<double> history) const override {
    bool any = false;
    std::array<bool, count> begins{};
    for (std::size_t i = 0; i < count; ++i)
      any = (begins[i] = play::begin_step(contact_input(in, i), dt, history.part(i * slots, slots))) || any;
    if (any) predict(in, acc, dt, begins, history);
  }
  void events(const JointInput& in, Span<double> g, Span<double> rate) const override {
    const Pair pair(in);
    const Geometry& geometry = with(in.history);
    for (std::size_t i = 0; i < count; ++i)
      write_events(contact_input(in, i), gap(geometry, pair.numbers(), i), g.part(2 * i, 2), rate.part(2 * i, 2));
  }
  void on_event(int index, const JointInput& in, Span<double> internal, Span<double> history,
                Span<double> fields) const override {
    const auto i = static_cast<std::size_t>(index / 2);
    const Pair pair(in);
    const Contact<double> at = contact(with(in.history), pair.numbers(), i);
    const JointInput one = contact_input(in, i);
    const Span<double> own = history.part(i * slots, slots);
    if (index % 2 == 0) {
      tell_begin(one, at.approach(), own, fields);
      const double moved = in.whole_mobility == nullptr ? 0.0 : Kinematics::inverse_mass(pair, at, in.whole_mobility);
      if (moved > 0.0) own[impact_time] = impact_duration(laws_.normal, at.approach(), geometry_.play, moved, share);
    } else {
      tell_end(one, at.approach(), own, fields);
      forget(i, in, internal, history);
    }
    fields[1] = Kinematics::signed_size(at.slip);
    fields[2] = Kinematics::direction(pair, at);
  }
  void commit(const JointInput& in, Span<const double>, Span<double> history) const override {
    const Pair pair(in);
    const Motion<double>& motion = pair.numbers();
    const Geometry& geometry = with(in.history);
    for (std::size_t i = 0; i < count; ++i) {
      const Span<double> own = history.part(i * slots, slots);
      const bool touched = own[phase] != flight;
      play::commit(contact_input(in, i), gap(geometry, motion, i), laws_.normal, share, own);
      if (touched && own[phase] == flight) forget(i, in, in.internal, history);
    }
    if constexpr (keeps) geometry_.keep(motion, kept(history));
  }

  /// Where b stands, deepest delta, sums of F_N, F_T and of the power of the forces, whether any contact is on, v_T of
  /// the one that carries most; then, of several, delta, F_N and F_T of each.
  void observe(const JointInput& in, Span<const double>, Span<double> channels) const override {
    const Pair pair(in);
    const auto stand = with(in.history).stand(pair.numbers());
    std::copy(stand.begin(), stand.end(), channels.begin());
    const Loads loads = load(in, pair.numbers(), Which::all);
    double deepest = -unbounded, normal = 0.0, tangential = 0.0, power = 0.0, touching = 0.0;
    const std::size_t first = stand.size(), first_own = first + sum_channels;
    for (std::size_t i = 0; i < count; ++i) {
      const Contact<double>& at = loads.at[i];
      if (contact_input(in, i).history[phase] != flight) touching = 1.0;
      deepest = std::max(deepest, at.penetration);
      double own_normal = 0.0, own_tangential = 0.0;
      if (loads.on[i]) {
        const Sideways friction = share * friction_alone(in, loads, i);
        normal += own_normal = share * loads.normal[i].normal;
        tangential += own_tangential = Kinematics::signed_size(friction);
        power += Kinematics::power(friction, at.slip) - own_normal * at.rate;
      }
      if (count == 1) continue;
      const double own[] = {at.penetration, own_normal, own_tangential};
      std::copy(std::begin(own), std::end(own), channels.begin() + first_own + i * contact_channels);
    }
    const double all[] = {deepest, normal,   tangential,
                          power,   touching, Kinematics::signed_size(loads.at[most_loaded(loads)].slip)};
    static_assert(std::size(all) == sum_channels);
    std::copy(std::begin(all), std::end(all), channels.begin() + first);
  }
  void contacts(const JointInput& in, Span<double> numbers) const override {
    const Pair pair(in);
    const Loads loads = load(in, pair.numbers(), Which::touching);
    std::fill(numbers.begin(), numbers.end(), 0.0);
    for (std::size_t i = 0; i < count; ++i) {
      if (!loads.on[i]) continue;
      const ContactForce& f = loads.normal[i];
      const Contact<double>& at = loads.at[i];
      double rates[Kinematics::most_memory];
      const Sideways friction = Kinematics::friction(laws_, f.normal, at, memory(in, i), {rates, each_memory()});
      numbers[3 * i] = share * f.normal;
      numbers[3 * i + 1] = share * Kinematics::signed_size(friction);
      numbers[3 * i + 2] = share * (f.normal * at.rate - storing_power(laws_.normal, at.approach(), f) -
                                    Kinematics::power(friction, at.slip));
      if constexpr (stores) numbers[3 * i + 2] -= share * stored(in, i, {rates, each_memory()}).rate;
    }
  }
  void kinks(const JointInput& in, Span<double> g) const override {
    const Pair pair(in);
    const Geometry& geometry = with(in.history);
    const std::size_t each = g.size / count;
    for (std::size_t i = 0; i < count; ++i) {
      const JointInput one = contact_input(in, i);
      if (one.history[phase] == flight) continue;
      const Contact<double> at = contact(geometry, pair.numbers(), i);
      if (touches(one, at.approach()))
        laws_.write_kinks(at.approach(), Kinematics::signed_size(at.slip), one, g.part(each * i, each));
    }
  }
  /// In flight no contact nears its surface by more than the play, or than its distance, whichever way an end may lie.
  double step_limit(const JointInput& in) const override {
    const Pair pair(in);
    const Geometry& geometry = with(in.history);
    double limit = unbounded;
    for (std::size_t i = 0; i < count; ++i) {
      const JointInput one = contact_input(in, i);
      const Contact<double> at = contact(geometry, pair.numbers(), i);
      const double speed = geometry_.between_walls() ? std::abs(at.rate) : std::sqrt(dot(at.velocity, at.velocity));
      if (one.history[phase] != flight) {
        limit = std::min(limit, impact_step(one));
      } else if (speed > 0.0) {
        const double free = leaves_surface<Geometry>() ? std::max(geometry_.play, -at.penetration) : geometry_.play;
        limit = std::min(limit, free / speed);
      }
    }
    return limit;
  }
  /// Between walls no depth changes by more than the shift across and the way of the contact in a turn; before those of
  /// a body in space, than the shift and what its levers make of a turn.
  double free_distance(const JointInput& in) const override {
    if (Kinematics::planar ? !geometry_.between_walls() : !has_levers) return 0.0;
    const Pair pair(in);
    double free = unbounded;
    for (std::size_t i = 0; i < count; ++i) {
      if (in.history[i * slots + phase] != flight) return 0.0;
      free = std::min(free, -contact(with(in.history), pair.numbers(), i).penetration);
    }
    return std::max(0.0, free);
  }
  void free_levers(const JointInput&, Span<double> levers) const override {
    if constexpr (has_levers) std::ranges::copy(geometry_.levers(), levers.begin());
  }
  const char* warning(const JointInput& in) const override {
    if (all_fly(in)) return nullptr;
    const Pair pair(in);
    const Geometry& geometry = with(in.history);
    for (std::size_t i = 0; i < count; ++i) {
      const JointInput one = contact_input(in, i);
      const Approach here = gap(geometry, pair.numbers(), i);
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
    layout.internal_variables = static_cast<std::int32_t>(count * each_memory());
    layout.history = static_cast<std::int32_t>(count * (slots + each_memory()));
    if constexpr (keeps) layout.history += static_cast<std::int32_t>(Geometry::kept);
    layout.kinks = static_cast<std::int32_t>(count) * laws_.count_kinks();
    layout.clearance = geometry_.play;
    layout.free_turns = !Kinematics::planar && has_levers ? 1 : 0;
  }
  const Geometry& geometry() const { return geometry_; }
  const Laws& laws() const { return laws_; }

 private:
  using Pair = typename Kinematics::Pair;
  using Dual = typename Kinematics::Dual;
  using Sideways = typename Kinematics::Sideways;
  template <class T>
  using Contact = typename Kinematics::template Contact<T>;

  static constexpr std::size_t sum_channels = 6;
  static constexpr bool stores = requires { &Kinematics::stored; };  // memory may store energy
  static constexpr bool has_turning_rates = requires(const Motion<double>& m) { m.w_a; };

  static Contact<double> contact(const Geometry& geometry, const Motion<double>& motion, std::size_t i) {
    return {geometry.place(motion, i), motion};
  }
  static Approach gap(const Geometry& geometry, const Motion<double>& motion, std::size_t i) {
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

  /// All contacts, those that are on, and the whole normal forces of the law there.
  struct Loads {
    std::array<Contact<double>, count> at;
    std::array<ContactForce, count> normal{};
    std::array<bool, count> on{};
    bool any = false;
  };
  /// Those of which the kinematics are wanted: most corners of most joints fly most of the time.
  enum class Which : bool { touching, all };
  Loads load(const JointInput& in, const Motion<double>& motion, Which which) const {
    const Geometry& geometry = with(in.history);
    Loads loads;
    for (std::size_t i = 0; i < count; ++i) {
      const auto place = geometry.place(motion, i);
      const JointInput one = contact_input(in, i);
      loads.on[i] = touches(one, {place.penetration, 0.0});
      if (!loads.on[i] && which == Which::touching) continue;
      loads.at[i] = Contact<double>(place, motion);
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

  // --- friction, and what a contact remembers ----------------------------------------------------------------------

  std::size_t each_memory() const { return static_cast<std::size_t>(laws_.memory()); }
  template <class T>
  Span<T> part_of(Span<T> all, std::size_t i) const {
    return all.part(i * each_memory(), each_memory());
  }
  template <class T>
  Span<T> forgotten(Span<T> history, std::size_t i) const {
    return history.part(count * slots + i * each_memory(), each_memory());
  }
  typename Kinematics::Memory memory(const JointInput& in, std::size_t i) const {
    return {part_of(in.internal, i), forgotten(in.history, i)};
  }
  /// A contact ends: what its memory stored is lost, and what it forgets is at its start again.
  void forget(std::size_t i, const JointInput& in, Span<const double> internal, Span<double> history) const {
    const Span<const double> own = part_of(internal, i);
    const Span<double> zero = forgotten(history, i);
    if constexpr (stores) {
      const double none[Kinematics::most_memory]{};
      if (in.dissipated != nullptr && own.size > 0)
        *in.dissipated +=
            share * Kinematics::stored(laws_, typename Kinematics::Memory(own, zero), {none, own.size}).energy;
    }
    for (std::size_t k = 0; k < own.size; ++k)
      if (laws_.forgets(k)) zero[k] = own[k] - laws_.start_of(k);
  }
  Stored stored(const JointInput& in, std::size_t i, Span<const double> rates) const {
    return each_memory() == 0 ? Stored{} : Kinematics::stored(laws_, memory(in, i), rates);
  }
  Sideways friction_alone(const JointInput& in, const Loads& loads, std::size_t i) const {
    double unused[Kinematics::most_memory];
    return Kinematics::friction(laws_, loads.normal[i].normal, loads.at[i], memory(in, i), {unused, each_memory()});
  }

  void differentiate(const JointInput& in, const Pair& pair, const Loads& loads, JointForces& out) const {
    const Motion<Dual> motion = pair.duals();
    const std::size_t columns = 24 + count * each_memory();
    const Geometry& geometry = with(in.history);
    typename Kinematics::template Force<Dual> total;
    for (std::size_t i = 0; i < count; ++i) {
      if (!loads.on[i]) continue;
      const Contact<Dual> at{geometry.place(motion, i), motion};
      const LoadedContact<Kinematics> one{laws_, loads.at[i],       loads.normal[i], memory(in, i),
                                          share, i * each_memory(), columns};
      total.add(Kinematics::differentiate(one, pair, at, out), at);
    }
    Kinematics::write_derivatives(pair, total, columns, out);
  }

  // --- beginnings --------------------------------------------------------------------------------------------------

  /// v_0 of the contacts that begin in this step, from the exact second derivative of delta.
  void predict(const JointInput& in, const MarkerAccelerations& acc, double dt, const std::array<bool, count>& which,
               Span<double> history) const {
    const Pair pair(in);
    const Motion<double>& now = pair.numbers();
    const Geometry& geometry = with(in.history);
    std::array<bool, count> near{};
    bool any = false;
    for (std::size_t i = 0; i < count; ++i) {
      near[i] = which[i];
      if constexpr (has_turning_rates) {
        if (near[i] && geometry_.between_walls()) near[i] = may_touch(contact(geometry, now, i), now, acc, dt);
      }
      any = any || near[i];
    }
    if (!any) return;
    const Motion<Dual> motion = pair.duals();
    const typename Dual::Gradient rates = pair.rates(acc);
    const auto rate_of = [&](const Dual& x) { return x.gradient.dot(rates); };
    for (std::size_t i = 0; i < count; ++i) {
      if (!near[i]) continue;
      const Contact<Dual> at{geometry.place(motion, i), motion};
      const auto velocity = Kinematics::each_of(at.velocity, [](const Dual&x) { return x.value; }),
                 second = Kinematics::each_of(at.velocity, rate_of);
      // Of a normal that is no unit vector, as where a depth counts an angle.
      double size = 1.0;
      if constexpr (keeps) size = Kinematics::size_of(at.normal);
      history[i * slots + predicted] = predicted_speed(at.approach(), rate_of(at.rate), dt,
                                                       [&](double s) { return size * (velocity + s * second).norm(); });
    }
  }
  /// Whether a depth that stands at a flat wall can grow to zero within dt. Its second derivative is at most that of
  /// the contact's point, of the lever r_b on b and r_a on a,
  ///
  ///   |a_b - a_a| + r_b (|alpha_b| + w_b^2) + r_a (|alpha_a| + 3 w_a^2) + 2 |w_a| |v|
  static bool may_touch(const Contact<double>& at, const Motion<double>& m, const MarkerAccelerations& acc, double dt) {
    const auto length = [](double x, double y, double z) { return std::abs(x) + std::abs(y) + std::abs(z); };
    const double w_a = Kinematics::most_of(m.w_a), w_b = Kinematics::most_of(m.w_b),
                 second = length(acc.b[0] - acc.a[0], acc.b[1] - acc.a[1], acc.b[2] - acc.a[2]) +
                          Kinematics::most_of(at.arm) * (length(acc.b[3], acc.b[4], acc.b[5]) + w_b * w_b) +
                          Kinematics::most_of(at.from_a) * (length(acc.a[3], acc.a[4], acc.a[5]) + 3.0 * w_a * w_a) +
                          2.0 * w_a * Kinematics::most_of(at.velocity);
    return !(at.penetration + dt * (std::abs(at.rate) + 0.5 * dt * second) < 0.0);
  }

  Geometry geometry_;
  Laws laws_;
};

}  // namespace freeplay::play
