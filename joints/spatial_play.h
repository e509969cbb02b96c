// A joint with play in space: what its kinds share.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "freeplay/kit/contact_memory.h"
#include "freeplay/kit/contact_phase.h"
#include "freeplay/kit/friction_slopes.h"
#include "relative_motion.h"

namespace freeplay::play {

using space::Dual;
using space::Vec;

/// Internal variables that a friction law may have here: they are turned on the stack.
inline constexpr int most_law_variables = most_internal_variables;

inline constexpr Channel gap_channels[] = {{"ex", "m"}, {"ey", "m"},    {"ez", "m"},      {"delta", "m"}, {"fn", "N"},
                                           {"ft", "N"}, {"power", "W"}, {"contact", "1"}, {"vt", "m/s"}};
inline constexpr ChannelRole gap_roles[] = {
    ChannelRole::eccentricity_x, ChannelRole::eccentricity_y, ChannelRole::eccentricity_z,
    ChannelRole::penetration,    ChannelRole::normal_force,   ChannelRole::friction_force,
    ChannelRole::none,           ChannelRole::in_contact,     ChannelRole::slip_speed};

/// The laws of all contacts of a joint, and how friction acts across their normals. Throws BadParameter.
struct SpatialLaws {
  /// Without the sizes of the surfaces, `sized`, there is no friction: its arms are not known.
  SpatialLaws(const Parameters& p, const ContactPair& pair, bool sized)
      : normal(p.contact_law("clearance.contact", pair)),
        friction(p.friction_law("clearance.friction")),
        law_variables(friction.internal_variables()) {
    if (law_variables > most_law_variables)
      throw BadParameter("clearance.friction", "out-of-range",
                         "this law has more internal variables than the joint keeps");
    rules = MemoryRules<most_law_variables>(friction);
    slides = sized && !is_inert(friction);
  }
  /// Of the memory() numbers of a contact.
  double start_of(std::size_t k) const { return k % 3 == 0 ? rules.start[k / 3] : 0.0; }
  bool forgets(std::size_t k) const { return rules.forgets(k / 3); }
  /// The contact of these numbers ends: what it forgets is at its start again, `zero` from there on.
  void forget(Span<const double> own, Span<double> zero) const {
    for (std::size_t k = 0; k < own.size; ++k)
      if (forgets(k)) zero[k] = own[k] - start_of(k);
  }
  /// Of one contact: where its laws have kinks. Without sliding the law of friction is not asked.
  std::int32_t count_kinks() const { return slides ? play::count_kinks(normal, friction) : normal.switches(); }
  void write_kinks(const Approach& gap, double slip, const JointInput& in, Span<double> g) const {
    if (slides) return play::write_kinks(normal, friction, gap, slip, in, g);
    normal.decide({gap.penetration, gap.rate, in.history[approach_speed]}, g);
  }

  /// Friction on b for the normal force and the slip velocity of b on a, both in the tangential plane:
  ///
  ///   F_T v/|v|, F_T the law's force at the speed |v|; near v = 0 its limit, the slope of the law times v
  template <class T>
  Vec<T> friction_force(const T& normal, const Vec<T>& slip) const {
    const T squared = dot(slip, slip);
    if (space::value_of(squared) < 1e-24)
      return T(friction.evaluate({space::value_of(normal), 0.0, {}}, {}).d_slip) * slip;
    using std::sqrt;
    const T speed = sqrt(squared);
    const FrictionForce f = friction.evaluate({space::value_of(normal), space::value_of(speed), {}}, {});
    return (space::chained(f.tangential, f.d_normal, normal, f.d_slip, speed) / speed) * slip;
  }

  /// Internal variables of one contact: a vector in the axes of marker a for each of the law's; of one that is no
  /// deflection the first number alone.
  int memory() const { return 3 * law_variables; }

  /// The same for a law with internal variables, whose memory is a vector z across the normal n for each: z along the
  /// slip direction u is what the law keeps; z beside it, along p = n x u, is that of a law which slips as fast, less
  /// what slip alone does,
  ///
  ///   F = F(v, z.u) u + (F(v, z.p) - F(v, 0)) p
  ///   z' = z'(v, z.u) u + (z'(v, z.p) - z'(v, 0)) p - (n'.z) n
  ///
  /// with the law's F and z'. For bristles this is z' = v - sigma_0 |v| z/g in the plane of the contact, alike in all
  /// directions; the last term carries z along as n turns. In planar motion it is the law itself, which must be odd in
  /// slip and memory. A variable that is no deflection, as a way slid, has no direction: s goes into all three, and
  /// s' = s'(v, z.u, s) must be even in both. `z` and `z_rate` hold memory() numbers.
  template <class T>
  Vec<T> friction_force(const T& normal, const Vec<T>& slip, const Vec<T>& n, const Vec<T>& n_rate, Span<const T> z,
                        Span<T> z_rate) const;

  ContactLawRef normal;
  FrictionLawRef friction;
  int law_variables;
  MemoryRules<most_law_variables> rules{};
  bool slides;  ///< is there friction?

 private:
  /// The law's force and rates where its internal variables are `state`.
  double evaluate(double normal, double speed, const double* state, double* rate) const {
    const auto count = static_cast<std::size_t>(law_variables);
    return friction.evaluate({normal, speed, {state, count}}, {rate, count}).tangential;
  }
  Dual evaluate(const Dual& normal, const Dual& speed, const Dual* state, Dual* rate) const;
};

/// A pin or a ball: its radii, too, and its start. Throws BadParameter.
struct SpatialPlay : SpatialLaws {
  /// `length`: of the bearing [m], NaN without one.
  SpatialPlay(const Parameters& p, SurfaceShape shape, double length) : SpatialPlay(p, read_radii(p), shape, length) {}
  double radius_a() const { return radii.known() ? radii.bearing : 0.0; }
  double radius_b() const { return radii.known() ? radii.journal : 0.0; }

  Radii radii;
  Surfaces surfaces;
  Start start;

 private:
  SpatialPlay(const Parameters& p, const Radii& r, SurfaceShape shape, double length)
      : SpatialPlay(p, r, pair_of(p, r, shape, length)) {}
  SpatialPlay(const Parameters& p, const Radii& r, const ContactPair& pair)
      : SpatialLaws(p, pair, r.known()), radii(r), surfaces(pair), start(p) {
    require_radii(radii, friction);
  }
  static ContactPair pair_of(const Parameters& p, const Radii& r, SurfaceShape shape, double length) {
    ContactPair pair{r.bearing, r.journal, r.clearance, length, {}, {}};
    pair.bearing_shape = pair.journal_shape = shape;
    read_materials(p, pair);
    return pair;
  }
};

/// |e| - c without the loss of digits of a difference of nearly equal numbers.
template <class T>
T depth(const T& squared, const T& distance, double clearance) {
  return (squared - T(clearance * clearance)) / (distance + T(clearance));
}

/// The part of v across the unit vector n.
template <class T>
Vec<T> across(const Vec<T>& v, const Vec<T>& n) {
  return v - dot(v, n) * n;
}

inline Dual SpatialLaws::evaluate(const Dual& normal, const Dual& speed, const Dual* state, Dual* rate) const {
  const auto count = static_cast<std::size_t>(law_variables);
  double z[most_law_variables], rates[most_law_variables];
  for (std::size_t i = 0; i < count; ++i) z[i] = state[i].value;
  const FrictionForce f = friction.evaluate({normal.value, speed.value, {z, count}}, {rates, count});
  for (std::size_t i = 0; i < count; ++i) rate[i] = rates[i];
  Dual force(f.tangential, f.d_normal * normal.gradient + f.d_slip * speed.gradient);
  FrictionSlopes slopes(friction, normal.value, speed.value, {z, count});
  const auto add_rates = [&](const Dual::Gradient& gradient) {
    for (std::size_t i = 0; i < count; ++i) rate[i].gradient += slopes.rates()[i] * gradient;
  };
  slopes.by_normal_force();
  add_rates(normal.gradient);
  slopes.by_slip();
  add_rates(speed.gradient);
  for (std::size_t k = 0; k < count; ++k) {
    force.gradient += slopes.by_variable(k) * state[k].gradient;
    add_rates(state[k].gradient);
  }
  return force;
}

template <class T>
Vec<T> SpatialLaws::friction_force(const T& normal, const Vec<T>& slip, const Vec<T>& n, const Vec<T>& n_rate,
                                   Span<const T> z, Span<T> z_rate) const {
  using std::sqrt;
  const auto count = static_cast<std::size_t>(law_variables);
  const auto variable = [&](std::size_t i) { return Vec<T>{z[3 * i], z[3 * i + 1], z[3 * i + 2]}; };
  const T squared = dot(slip, slip);
  T speed(0.0);
  Vec<T> u;
  if (space::value_of(squared) > 1e-24) {
    speed = sqrt(squared);
    u = (T(1.0) / speed) * slip;
  } else {
    // At rest all directions across n are alike.
    const Eigen::Vector3d normal_of(space::value_of(n.x), space::value_of(n.y), space::value_of(n.z));
    const Eigen::Vector3d any = normal_of.unitOrthogonal();
    u = {T(any.x()), T(any.y()), T(any.z())};
  }
  const Vec<T> p = cross(n, u);
  T along[most_law_variables], beside[most_law_variables], none[most_law_variables];
  T along_rate[most_law_variables], beside_rate[most_law_variables], none_rate[most_law_variables];
  for (std::size_t i = 0; i < count; ++i) {
    if (!rules.is_deflection(i)) {
      along[i] = beside[i] = none[i] = z[3 * i];
      continue;
    }
    along[i] = dot(variable(i), u);
    beside[i] = dot(variable(i), p);
    none[i] = T(0.0);
  }
  const T force = evaluate(normal, speed, along, along_rate);
  const T sideways = evaluate(normal, speed, beside, beside_rate) - evaluate(normal, speed, none, none_rate);
  for (std::size_t i = 0; i < count; ++i) {
    if (!rules.is_deflection(i)) {
      z_rate[3 * i] = along_rate[i], z_rate[3 * i + 1] = z_rate[3 * i + 2] = T(0.0);
      continue;
    }
    const Vec<T> rate = along_rate[i] * u + (beside_rate[i] - none_rate[i]) * p - dot(n_rate, variable(i)) * n;
    z_rate[3 * i] = rate.x, z_rate[3 * i + 1] = rate.y, z_rate[3 * i + 2] = rate.z;
  }
  return force * u + sideways * p;
}

/// The same with the vectors of which delta is made: x' and x''.
inline double predicted_speed(const Approach& gap, double second, const Eigen::Vector3d& rate,
                              const Eigen::Vector3d& rate_of_rate, double dt) {
  return predicted_speed(gap, second, dt, [&](double s) { return (rate + s * rate_of_rate).norm(); });
}

/// What a contact remembers: vectors.
using Memory = MemoryOf<std::size_t{3} * most_law_variables>;

/// Derivatives of friction with memory by the numbers of the memory: use(j, dF/dz_j, dz'/dz_j) for each.
template <class Use>
void differentiate_by_memory(const SpatialLaws& laws, double normal, const Vec<double>& slip, const Vec<double>& n,
                             const Vec<double>& n_rate, const Memory& memory, const Use& use) {
  auto z = memory.numbers<double>();
  double high[3 * most_law_variables], low[3 * most_law_variables];
  const std::size_t size = memory.size;
  for (std::size_t j = 0; j < size; ++j) {
    const double middle = z[j], step = 1e-5 * std::max(std::abs(middle), 1e-6);
    const auto at = [&](double value, double* rate) {
      z[j] = value;
      return laws.friction_force<double>(normal, slip, n, n_rate, {z.data(), size}, {rate, size});
    };
    const Vec<double> above = at(middle + step, high), below = at(middle - step, low);
    z[j] = middle;
    for (std::size_t i = 0; i < size; ++i) high[i] = (high[i] - low[i]) / (2.0 * step);
    use(j, (0.5 / step) * (above - below), Span<const double>{high, size});
  }
}

}  // namespace freeplay::play
