// Points of one body before flat walls of another in space, any number of them: a joint says where they are, all else
// is here.
#pragma once

#include "rotation_vector.h"
#include "spatial_play.h"

namespace freeplay::play {

using space::PairInFirstAxes;
using space::RelativeForce;
using space::RelativeMotion;

/// By how much a turn by the rotation vector rho moves a vector s that is fixed in b, without the loss of digits of a
/// difference; axes of marker a, theta = |rho|:
///
///   R s - s = sin(theta)/theta rho x s + (1 - cos(theta))/theta^2 rho x (rho x s)
template <class T>
class Turn {
 public:
  explicit Turn(const Vec<T>& rho) : rho_(rho) {
    const T square = dot(rho, rho);
    const Shares shares(space::value_of(square));
    sine_ = space::chained(shares.sine, shares.sine_slope, square, 0.0, square);
    sag_ = space::chained(shares.sag, shares.sag_slope, square, 0.0, square);
  }
  Vec<T> change(const Vec<double>& s) const {
    const Vec<T> across = cross(rho_, Vec<T>{T(s.x), T(s.y), T(s.z)});
    return sine_ * across + sag_ * cross(rho_, across);
  }

 private:
  /// sin(theta)/theta and (1 - cos(theta))/theta^2 as functions of theta^2, and their slopes.
  struct Shares {
    explicit Shares(double square) {
      if (square < 0.01) {  // the closed forms of the slopes lose their digits
        const auto series = [&](double first, double k) {
          const double x = square;
          return 1.0 / first *
                 (1.0 - x / (k * (k + 1.0)) *
                            (1.0 - x / ((k + 2.0) * (k + 3.0)) *
                                       (1.0 - x / ((k + 4.0) * (k + 5.0)) * (1.0 - x / ((k + 6.0) * (k + 7.0))))));
        };
        sine = series(1.0, 2.0), sag = series(2.0, 3.0);
        // d/dx of the same: -1/3! + 2 x/5! - 3 x^2/7! + ..., -1/4! + 2 x/6! - ...
        sine_slope = -1.0 / 6.0 +
                     square * (1.0 / 60.0 - square * (1.0 / 1680.0 - square * (1.0 / 90720.0 - square / 7983360.0)));
        sag_slope = -1.0 / 24.0 +
                    square * (1.0 / 360.0 - square * (1.0 / 13440.0 - square * (1.0 / 907200.0 - square / 95800320.0)));
        return;
      }
      const double theta = std::sqrt(square), half = std::sin(0.5 * theta);
      sine = std::sin(theta) / theta;
      sag = 2.0 * half * half / square;
      sine_slope = (std::cos(theta) - sine) / (2.0 * square);
      sag_slope = (sine - 2.0 * sag) / (2.0 * square);
    }
    double sine, sag, sine_slope, sag_slope;
  };
  Vec<T> rho_;
  T sine_, sag_;
};

/// A point of b before a wall of a, in the axes of a.
template <class T>
struct WallPlace {
  T penetration{};     ///< delta, written so that it keeps its digits near zero [m]
  Vec<double> normal;  ///< unit, fixed in a, along which b pushes a
  Vec<T> arm;          ///< from P_b to the point, where both forces act [m]
};

/// The kinematics that follow, v the velocity of b less that of a at the point: delta' = n.v, v_T = v - delta' n.
template <class T>
struct WallContact : WallPlace<T> {
  WallContact() = default;
  WallContact(const WallPlace<T>& place, const RelativeMotion<T>& m)
      : WallPlace<T>(place),
        n{T(place.normal.x), T(place.normal.y), T(place.normal.z)},
        velocity(m.u + cross(m.w_b, place.arm) - cross(m.w_a, m.d + place.arm)),
        rate(dot(n, velocity)),
        slip(velocity - rate * n) {}
  Vec<T> n, velocity;
  T rate{};
  Vec<T> slip;
  Approach approach() const { return {space::value_of(this->penetration), space::value_of(rate)}; }
};

/// A joint whose contacts stand where `Geometry` says:
///
///   static constexpr std::size_t contacts;     how many
///   static constexpr double share;             of the laws' forces that each has
///   template <class T> WallPlace<T> place(const RelativeMotion<T>&, const Turn<T>&, std::size_t contact) const;
///   double play;                               scale of a flight [m]
///
/// The relative motion has the rotation vector of b in a. With F_N(delta, delta') and F_T(F_N, |v_T|) of the laws
///
///   F_b = share (-F_N n + F_T v_T/|v_T|),  F_a = -F_b,  both at the point        for delta > 0, else zero
///
/// for each contact by itself, with phase, approach speed and memory of friction of its own.
template <class Geometry>
class WallContacts : public Joint {
 public:
  static constexpr std::size_t count = Geometry::contacts;
  static constexpr double share = Geometry::share;

  WallContacts(const Geometry& geometry, const SpatialLaws& laws) : geometry_(geometry), laws_(laws) {}

  void apply(const JointInput& in, JointForces& out) const override {
    out.potential_rate = 0.0;
    if (all_fly(in)) return;
    const PairInFirstAxes pair = PairInFirstAxes::with_rotation_vector(in);
    const RelativeMotion<double> motion = pair.numbers();
    const Loads loads = load(in, motion);
    if (!loads.any) return;
    RelativeForce<double> total{};
    for (std::size_t i = 0; i < count; ++i) {
      if (!loads.on[i]) continue;
      out.potential += share * loads.force[i].potential;
      out.potential_rate += share * storing_power(laws_.contact, loads.at[i].approach(), loads.force[i]);
      total.add(force(in, loads, i, loads.at[i], part_of(out.internal_rate, i)), loads.at[i].arm, motion.d);
    }
    pair.write(total, out);
    if (!out.derivatives.empty()) differentiate(in, pair, loads, out);
  }

  void initialize(const JointInput& in, Span<double> internal, Span<double> history) const override {
    std::fill(internal.begin(), internal.end(), 0.0);
    std::fill(history.begin(), history.end(), 0.0);
    const Points points(*this, in);
    for (std::size_t i = 0; i < count; ++i) play::start(in.t, points.gap(i), history.part(i * slots, slots));
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
    const Points points(*this, in);
    for (std::size_t i = 0; i < count; ++i)
      write_events(contact_input(in, i), points.gap(i), g.part(2 * i, 2), rate.part(2 * i, 2));
  }
  void on_event(int index, const JointInput& in, Span<double> internal, Span<double> history,
                Span<double> fields) const override {
    const auto i = static_cast<std::size_t>(index / 2);
    const Points points(*this, in);
    const WallContact<double> at = points.contact(i);
    const JointInput one = contact_input(in, i);
    const Span<double> own = history.part(i * slots, slots);
    if (index % 2 == 0) {
      tell_begin(one, at.approach(), own, fields);
      if (in.whole_mobility != nullptr)
        own[impact_time] = impact_duration(laws_.contact, at.approach(), geometry_.play,
                                           inverse_mass(points.pair, at, in.whole_mobility), share);
    } else {
      tell_end(one, at.approach(), own, fields);
      forget(i, internal, history);
    }
    fields[1] = along(at.slip);
    fields[2] = std::atan2(at.normal.z, at.normal.y);
  }
  void commit(const JointInput& in, Span<const double>, Span<double> history) const override {
    const Points points(*this, in);
    for (std::size_t i = 0; i < count; ++i) {
      const Span<double> own = history.part(i * slots, slots);
      const bool touched = own[phase] != flight;
      play::commit(contact_input(in, i), points.gap(i), laws_.contact, share, own);
      if (touched && own[phase] == flight) forget(i, in.internal, history);
    }
  }
  void contacts(const JointInput& in, Span<double> numbers) const override {
    const Loads loads = load(in, PairInFirstAxes::with_rotation_vector(in).numbers());
    std::fill(numbers.begin(), numbers.end(), 0.0);
    for (std::size_t i = 0; i < count; ++i) {
      if (!loads.on[i]) continue;
      const ContactForce& f = loads.force[i];
      const WallContact<double>& at = loads.at[i];
      const Vec<double> friction = friction_alone(in, loads, i);
      numbers[3 * i] = share * f.normal;
      numbers[3 * i + 1] = share * along(friction);
      numbers[3 * i + 2] =
          share * (f.normal * at.rate - storing_power(laws_.contact, at.approach(), f) - dot(friction, at.slip));
    }
  }
  void kinks(const JointInput& in, Span<double> g) const override {
    const Points points(*this, in);
    const std::size_t each = g.size / count;
    for (std::size_t i = 0; i < count; ++i) {
      const JointInput one = contact_input(in, i);
      if (one.history[phase] == flight) continue;
      const WallContact<double> at = points.contact(i);
      if (touches(one, at.approach())) laws_.write_kinks(at.approach(), along(at.slip), one, g.part(each * i, each));
    }
  }
  /// In flight no point nears its wall by more than the play.
  double step_limit(const JointInput& in) const override {
    const Points points(*this, in);
    double limit = unbounded;
    for (std::size_t i = 0; i < count; ++i) {
      const JointInput one = contact_input(in, i);
      const double speed = std::abs(points.gap(i).rate);
      if (one.history[phase] != flight) {
        limit = std::min(limit, impact_step(one));
      } else if (speed > 0.0) {
        limit = std::min(limit, geometry_.play / speed);
      }
    }
    return limit;
  }
  const char* warning(const JointInput& in) const override {
    if (all_fly(in)) return nullptr;
    const Points points(*this, in);
    for (std::size_t i = 0; i < count; ++i) {
      const JointInput one = contact_input(in, i);
      const Approach here = points.gap(i);
      if (one.history[phase] == flight || !touches(one, here)) continue;
      const char* why = laws_.contact.outside_range({here.penetration, here.rate, one.history[approach_speed]});
      if (why != nullptr) return why;
    }
    return nullptr;
  }

 protected:
  static constexpr std::size_t sum_channels = 6, contact_channels = 3;

  /// All of the layout that follows from the contacts; the joint adds its coordinate, play, events, channels and roles.
  void declare_contacts(JointLayout& layout) const {
    layout.time_scale = unbounded;
    layout.forces = 1;
    layout.forces_without_coordinate = 1;
    layout.analytic_derivatives = 1;
    layout.wants_whole_mobility = 1;
    layout.internal_variables = static_cast<std::int32_t>(count) * laws_.memory();
    layout.history = static_cast<std::int32_t>(count * slots) + layout.internal_variables;
    layout.kinks = static_cast<std::int32_t>(count) * laws_.count_kinks();
  }
  /// Deepest delta, sums of F_N, F_T and of the power of the forces, whether any contact is on, v_T of the one that
  /// carries most; then delta, F_N and F_T of each. F_T and v_T have the sign of their part along x of a.
  void write_channels(const JointInput& in, const RelativeMotion<double>& motion, Span<double> channels) const {
    const Loads loads = load(in, motion);
    double deepest = -unbounded, normal = 0.0, tangential = 0.0, power = 0.0, touching = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      const WallContact<double>& at = loads.at[i];
      const Span<double> own = channels.part(sum_channels + i * contact_channels, contact_channels);
      if (contact_input(in, i).history[phase] != flight) touching = 1.0;
      deepest = std::max(deepest, at.penetration);
      own[0] = at.penetration;
      own[1] = own[2] = 0.0;
      if (!loads.on[i]) continue;
      const Vec<double> friction = share * friction_alone(in, loads, i);
      normal += own[1] = share * loads.force[i].normal;
      tangential += own[2] = along(friction);
      power += dot(friction, at.slip) - own[1] * at.rate;
    }
    const double all[] = {deepest, normal, tangential, power, touching, along(loads.at[most_loaded(loads)].slip)};
    static_assert(std::size(all) == sum_channels);
    std::copy(std::begin(all), std::end(all), channels.begin());
  }
  const Geometry& geometry() const { return geometry_; }
  const SpatialLaws& laws() const { return laws_; }

 private:
  /// All points at the markers of one input.
  struct Points {
    Points(const WallContacts& joint, const JointInput& in)
        : geometry(joint.geometry_),
          pair(PairInFirstAxes::with_rotation_vector(in)),
          motion(pair.numbers()),
          turn(motion.r) {}
    WallContact<double> contact(std::size_t i) const { return {geometry.place(motion, turn, i), motion}; }
    Approach gap(std::size_t i) const { return contact(i).approach(); }
    const Geometry& geometry;
    PairInFirstAxes pair;
    RelativeMotion<double> motion;
    Turn<double> turn;
  };

  /// Where steps end at events nothing can touch then.
  static bool all_fly(const JointInput& in) {
    if (in.per_contact == 0.0) return false;
    for (std::size_t i = 0; i < count; ++i)
      if (in.history[i * slots + phase] != flight) return false;
    return true;
  }

  /// All contacts, those that are on, and the whole normal forces of the law there.
  struct Loads {
    std::array<WallContact<double>, count> at;
    std::array<ContactForce, count> force{};
    std::array<bool, count> on{};
    bool any = false;
  };
  Loads load(const JointInput& in, const RelativeMotion<double>& motion) const {
    const Turn<double> turn(motion.r);
    Loads loads;
    for (std::size_t i = 0; i < count; ++i) {
      loads.at[i] = WallContact<double>(geometry_.place(motion, turn, i), motion);
      const JointInput one = contact_input(in, i);
      if (!touches(one, loads.at[i].approach())) continue;
      loads.force[i] = normal_force(laws_.contact, loads.at[i].approach(), one);
      loads.on[i] = loads.any = true;
    }
    return loads;
  }
  /// The contact that carries most, or lies deepest where none is on.
  static std::size_t most_loaded(const Loads& loads) {
    std::size_t most = 0;
    for (std::size_t i = 1; i < count; ++i) {
      const double more = loads.force[i].normal - loads.force[most].normal;
      if (more > 0.0 || (more == 0.0 && loads.at[i].penetration > loads.at[most].penetration)) most = i;
    }
    return most;
  }
  /// Size of a tangential vector with the sign of its part along x of a.
  static double along(const Vec<double>& v) { return std::copysign(std::sqrt(dot(v, v)), v.x); }

  // --- forces ------------------------------------------------------------------------------------------------------

  template <class T>
  Span<T> part_of(Span<T> all, std::size_t i) const {
    const auto each = static_cast<std::size_t>(laws_.memory());
    return all.part(i * each, each);
  }
  template <class T>
  Span<T> forgotten(Span<T> history, std::size_t i) const {
    return part_of(history.part(count * slots, history.size - count * slots), i);
  }
  Memory memory(const JointInput& in, std::size_t i) const {
    return {part_of(in.internal, i), forgotten(in.history, i)};
  }
  void forget(std::size_t i, Span<const double> internal, Span<double> history) const {
    const Span<const double> own = part_of(internal, i);
    std::copy(own.begin(), own.end(), forgotten(history, i).begin());
  }
  /// The whole force of friction on b; `rates`: of the internal variables of this contact.
  template <class T>
  Vec<T> friction(const JointInput& in, std::size_t i, const T& normal, const WallContact<T>& at, Span<T> rates) const {
    if (!laws_.slides) return {};
    if (laws_.memory() == 0) return laws_.friction_force(normal, at.slip);
    const Memory kept = memory(in, i);
    const auto z = kept.numbers<T>();
    return laws_.friction_force<T>(normal, at.slip, at.n, {}, {z.data(), kept.size}, rates);
  }
  Vec<double> friction_alone(const JointInput& in, const Loads& loads, std::size_t i) const {
    double unused[3 * most_law_variables];
    return friction<double>(in, i, loads.force[i].normal, loads.at[i],
                            {unused, static_cast<std::size_t>(laws_.memory())});
  }
  template <class T>
  Vec<T> force(const JointInput& in, const Loads& loads, std::size_t i, const WallContact<T>& at, Span<T> rates) const {
    const ContactForce& law = loads.force[i];
    const T normal = space::chained(law.normal, law.d_penetration, at.penetration, law.d_rate, at.rate);
    return T(share) * (friction(in, i, normal, at, rates) - normal * at.n);
  }

  void differentiate(const JointInput& in, const PairInFirstAxes& pair, const Loads& loads, JointForces& out) const {
    const RelativeMotion<Dual> motion = pair.duals();
    const Turn<Dual> turn(motion.r);
    const auto each = static_cast<std::size_t>(laws_.memory());
    const auto columns = static_cast<Eigen::Index>(24 + count * each);
    RelativeForce<Dual> total{};
    for (std::size_t i = 0; i < count; ++i) {
      if (!loads.on[i]) continue;
      const WallContact<Dual> at(geometry_.place(motion, turn, i), motion);
      std::array<Dual, 3 * most_law_variables> rates;
      total.add(force<Dual>(in, loads, i, at, {rates.data(), each}), at.arm, motion.d);
      if (each == 0 || !laws_.slides) continue;
      for (std::size_t k = 0; k < each; ++k) pair.write_rate_derivatives(i * each + k, rates[k], columns, out);
      differentiate_memory(in, pair, loads, i, out);
    }
    pair.write_derivatives(total, columns, out);
  }
  void differentiate_memory(const JointInput& in, const PairInFirstAxes& pair, const Loads& loads, std::size_t i,
                            JointForces& out) const {
    const Memory kept = memory(in, i);
    const std::size_t first = i * kept.size, columns = 24 + count * kept.size;
    const WallContact<double>& at = loads.at[i];
    const Vec<double> d = pair.numbers().d;
    differentiate_by_memory(laws_, loads.force[i].normal, at.slip, at.n, {}, kept,
                            [&](std::size_t j, const Vec<double>& by, Span<const double> rate_by) {
                              RelativeForce<double> part{};
                              part.add(share * by, at.arm, d);
                              pair.write_internal_column(first + j, part, static_cast<Eigen::Index>(columns), out);
                              for (std::size_t k = 0; k < kept.size; ++k)
                                out.derivatives[(12 + first + k) * columns + 24 + first + j] = rate_by[k];
                            });
  }

  // --- beginnings --------------------------------------------------------------------------------------------------

  /// v_0 of the contacts that begin in this step, from the exact second derivative of delta.
  void predict(const JointInput& in, const MarkerAccelerations& acc, double dt, const std::array<bool, count>& which,
               Span<double> history) const {
    const PairInFirstAxes pair = PairInFirstAxes::with_rotation_vector(in);
    const RelativeMotion<Dual> motion = pair.duals();
    const Turn<Dual> turn(motion.r);
    const Dual::Gradient rates = pair.rates(acc);
    for (std::size_t i = 0; i < count; ++i) {
      if (!which[i]) continue;
      const WallContact<Dual> at(geometry_.place(motion, turn, i), motion);
      const auto rate_of = [&](const Dual& x) { return x.gradient.dot(rates); };
      const Eigen::Vector3d velocity(at.velocity.x.value, at.velocity.y.value, at.velocity.z.value),
          second(rate_of(at.velocity.x), rate_of(at.velocity.y), rate_of(at.velocity.z));
      history[i * slots + predicted] = predicted_speed(at.approach(), rate_of(at.rate), velocity, second, dt);
    }
  }
  /// 1/m = w.(W w) of the wrench w on b at its origin for a unit normal force.
  static double inverse_mass(const PairInFirstAxes& pair, const WallContact<double>& at, const double* mobility) {
    const Eigen::Vector3d n(at.normal.x, at.normal.y, at.normal.z), arm(at.arm.x, at.arm.y, at.arm.z);
    Eigen::Matrix<double, 6, 1> wrench;
    wrench << pair.axes() * n, pair.axes() * arm.cross(n);
    return wrench.dot(Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(mobility) * wrench);
  }

  Geometry geometry_;
  SpatialLaws laws_;
};

}  // namespace freeplay::play
