// A slider with play in its guide as an author might write it by hand, right as `slide-0` and wrong in one way as each
// of `slide-1` to `slide-31`: what check-plugin must tell.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "freeplay/kit/planar_pair.h"
#include "freeplay/plugin.h"

namespace {

using namespace freeplay;
using play::not_a_number, play::PlanarMotion, play::PlanarPair, play::Vec2;

enum Fault : int {
  none,
  // Forces of a corner.
  no_moment_on_guide,
  moment_on_slider_turned,
  friction_at_the_middle,
  friction_pushes,
  slip_without_turn,
  rate_without_turn_of_guide,
  derivative_without_turn,
  potential_of_one_corner,
  stored_power_of_one_corner,
  pulls_back,
  forgets_a_corner,
  face_law_switches,
  begins_with_a_jump,
  // Flight and contact.
  never_begins,
  never_ends,
  ends_another_corner,
  one_speed_for_all,
  force_before_the_event,
  speed_of_a_prediction_alone,
  natural_start,
  no_prediction,
  prediction_of_the_middle,
  forgets_at_each_step,
  speed_in_a_member,
  end_begins_again,
  // Steps, fields, promises.
  mass_of_the_block,
  tiny_steps,
  duration_from_the_start,
  largest_force_of_all_time,
  free_without_tilt,
  shares_of_one_corner,
  faults
};

constexpr std::size_t corners = 4;
enum Slot : std::size_t { phase, speed, predicted, begin_time, largest_force, impact_time, slots };
constexpr double flight = 0.0, contact = 1.0, from_start = 2.0;
constexpr double least_speed = 1e-6;

struct Corner {
  double delta, rate, slip, normal, tangential;
  bool on;
};

template <class T>
struct Place {
  Vec2<T> arm, from_a;
  T delta, rate, slip;
};

constexpr Channel fields[] = {{"speed", "m/s"}, {"duration", "s"}, {"max_fn", "N"}};
constexpr Event events_of_slide[] = {{"front_upper_contact_begin", Crossing::rising, 1, fields},
                                     {"front_upper_contact_end", Crossing::falling, 1, fields},
                                     {"rear_upper_contact_begin", Crossing::rising, 1, fields},
                                     {"rear_upper_contact_end", Crossing::falling, 1, fields},
                                     {"front_lower_contact_begin", Crossing::rising, 1, fields},
                                     {"front_lower_contact_end", Crossing::falling, 1, fields},
                                     {"rear_lower_contact_begin", Crossing::rising, 1, fields},
                                     {"rear_lower_contact_end", Crossing::falling, 1, fields}};
constexpr Channel channels[] = {{"delta", "m"}, {"fn", "N"}, {"contact", "1"}};

class Slide : public Joint {
 public:
  Slide(int fault, const Parameters& p)
      : fault_(fault),
        gap_(p.number("gap")),
        half_length_(p.number("half_length")),
        half_width_(p.number("half_width")),
        stiffness_(p.number("stiffness")),
        loss_(1.5 * (1.0 - p.number("restitution"))),
        mu_(p.number("mu")) {}

  void declare(JointLayout& layout) const override {
    layout.coordinate = Coordinate::position;
    layout.planar_coordinate = 1;
    layout.time_scale = unbounded;
    layout.forces = 1;
    layout.forces_without_coordinate = 1;
    layout.analytic_derivatives = 1;
    layout.wants_whole_mobility = 1;
    layout.history = corners * slots;
    layout.clearance = gap_;
    layout.play_shape = PlayShape::walls;
    layout.contact_reach = is(free_without_tilt) ? 0.0 : std::hypot(half_length_, half_width_);
    layout.events = events_of_slide;
    layout.channels = channels;
  }
  void coordinate(const JointInput& in, CoordinateRow& row) const override {
    const PlanarMotion<double> m = PlanarPair(in).numbers();
    const Vec2<double> h{in.a->rotation[0], in.a->rotation[3]};
    row.value = m.d.x;
    row.bias = 2.0 * m.w_a * m.u.y - m.w_a * m.w_a * m.d.x;
    row.jacobian[0] = -h.x, row.jacobian[1] = -h.y, row.jacobian[5] = m.d.y;
    row.jacobian[6] = h.x, row.jacobian[7] = h.y;
  }

  void apply(const JointInput& in, JointForces& out) const override {
    const PlanarPair pair(in);
    const PlanarMotion<double>& m = pair.numbers();
    const std::array<Corner, corners> all = load(in, m);
    out.potential_rate = 0.0;
    PlanarPair::Force<double> total;
    bool first = true;
    for (std::size_t i = 0; i < corners; ++i) {
      const Corner& c = all[i];
      if (!c.on || (is(forgets_a_corner) && i == 3)) continue;
      const double elastic = elastic_force(c.delta);
      if (first || !is(potential_of_one_corner)) out.potential += 0.4 * elastic * c.delta;
      if (first || !is(stored_power_of_one_corner)) out.potential_rate += elastic * c.rate;
      first = false;
      add(total, corner(m, i), side(i) * -c.normal, c.tangential);
    }
    if (first) return;
    pair.write(total, out);
    if (!out.derivatives.empty()) differentiate(in, pair, all, out);
  }

  void initialize(const JointInput& in, Span<double>, Span<double> history) const override {
    const PlanarMotion<double> m = PlanarPair(in).numbers();
    std::fill(history.begin(), history.end(), 0.0);
    for (std::size_t i = 0; i < corners; ++i) {
      if (!(corner(m, i).delta > 0.0) || is(natural_start)) continue;
      history[i * slots + phase] = from_start;
      history[i * slots + begin_time] = in.t;
    }
  }
  void begin_step(const JointInput& in, const MarkerAccelerations& acc, double dt,
                  Span<double> history) const override {
    const PlanarPair pair(in);
    const PlanarMotion<double>& m = pair.numbers();
    const auto rates = pair.rates(acc);
    for (std::size_t i = 0; i < corners; ++i) {
      const Span<double> own = history.part(i * slots, slots);
      if (is(forgets_at_each_step) && own[phase] == contact) own[speed] = least_speed;
      own[predicted] = 0.0;
      if (own[phase] != flight || in.per_contact != 0.0 || is(no_prediction)) continue;
      const auto at = corner(pair.duals(), i);
      const double second = at.rate.gradient.dot(rates),
                   rate = is(prediction_of_the_middle) ? side(i) * m.u.y : at.rate.value;
      const double root = rate * rate - 2.0 * second * at.delta.value;
      if (root < 0.0) continue;
      const double s = -2.0 * at.delta.value / (rate + std::sqrt(root));
      if (s >= 0.0 && s <= dt) own[predicted] = std::max(rate + second * s, least_speed);
    }
  }
  void events(const JointInput& in, Span<double> g, Span<double> rate) const override {
    const PlanarMotion<double> m = PlanarPair(in).numbers();
    for (std::size_t i = 0; i < corners; ++i) {
      const double now = in.history[i * slots + phase];
      const Place<double> at = corner(m, i);
      g[2 * i] = now != contact && !(is(never_begins) && i == 1) ? at.delta : not_a_number;
      g[2 * i + 1] = now != flight && !is(never_ends) ? at.delta : not_a_number;
      rate[2 * i] = rate[2 * i + 1] = at.rate;
      // It ends where it is deepest and, still inside, begins again at once.
      if (is(end_begins_again) && now != flight) g[2 * i + 1] = at.rate;
    }
  }
  void on_event(int index, const JointInput& in, Span<double>, Span<double> history, Span<double> out) const override {
    const auto i = static_cast<std::size_t>(index / 2);
    const PlanarMotion<double> m = PlanarPair(in).numbers();
    const Place<double> at = corner(m, i);
    const Span<double> own = history.part(i * slots, slots);
    if (index % 2 == 0) {
      const bool known = own[phase] == from_start;
      own[phase] = contact;
      out[0] = at.rate;
      if (known) return;
      own[speed] = in.per_contact == 0.0 && own[predicted] > 0.0 ? own[predicted] : std::max(at.rate, least_speed);
      if (is(speed_of_a_prediction_alone)) own[speed] = std::max(own[predicted], least_speed);
      if (is(one_speed_for_all))
        for (std::size_t k = 0; k < corners; ++k) history[k * slots + speed] = own[speed];
      own[begin_time] = is(duration_from_the_start) ? 0.0 : in.t;
      if (!is(largest_force_of_all_time)) own[largest_force] = 0.0;
      own[impact_time] = duration(in, at, own[speed], i);
    } else {
      out[0] = std::max(-at.rate, 0.0);
      out[1] = in.t - own[begin_time];
      out[2] = own[largest_force];
      const double kept = own[largest_force];
      const Span<double> ended = history.part((is(ends_another_corner) ? (i + 1) % corners : i) * slots, slots);
      std::fill(ended.begin(), ended.end(), 0.0);
      if (is(largest_force_of_all_time)) own[largest_force] = kept;
    }
  }
  void commit(const JointInput& in, Span<const double>, Span<double> history) const override {
    const PlanarMotion<double> m = PlanarPair(in).numbers();
    JointInput after = in;
    after.history = history;
    const std::array<Corner, corners> all = load(after, m);
    for (std::size_t i = 0; i < corners; ++i) {
      const Span<double> own = history.part(i * slots, slots);
      own[predicted] = 0.0;
      if (is(speed_in_a_member)) speeds_[i] = std::max(speeds_[i], all[i].rate);
      if (own[phase] == flight && all[i].delta > 0.0 && all[i].rate > 0.0 && in.per_contact == 0.0) {
        own[phase] = contact;
        own[speed] = std::max(all[i].rate, least_speed);
        own[begin_time] = in.t;
      }
      own[largest_force] = std::max(own[largest_force], all[i].normal);
    }
  }
  void observe(const JointInput& in, Span<const double>, Span<double> values) const override {
    const PlanarMotion<double> m = PlanarPair(in).numbers();
    const std::array<Corner, corners> all = load(in, m);
    values[0] = -unbounded;
    for (std::size_t i = 0; i < corners; ++i) {
      values[0] = std::max(values[0], all[i].delta);
      values[1] += all[i].normal;
      if (in.history[i * slots + phase] != flight) values[2] = 1.0;
    }
  }
  void contacts(const JointInput& in, Span<double> numbers) const override {
    const std::array<Corner, corners> all = load(in, PlanarPair(in).numbers());
    for (std::size_t i = 0; i < corners; ++i) {
      const Corner& c = all[is(shares_of_one_corner) ? 0 : i];
      numbers[3 * i] = c.normal;
      numbers[3 * i + 1] = c.tangential;
      numbers[3 * i + 2] = c.on ? (c.normal - elastic_force(c.delta)) * c.rate - c.tangential * c.slip : 0.0;
    }
  }
  double step_limit(const JointInput& in) const override {
    const PlanarMotion<double> m = PlanarPair(in).numbers();
    double limit = unbounded;
    for (std::size_t i = 0; i < corners; ++i) {
      const Span<const double> own = in.history.part(i * slots, slots);
      if (own[phase] == flight) {
        const double rate = std::abs(corner(m, i).rate);
        if (rate > 0.0) limit = std::min(limit, gap_ / rate);
      } else if (own[impact_time] > 0.0 && in.t - own[begin_time] < 2.0 * own[impact_time]) {
        limit = std::min(limit, own[impact_time] / std::max(in.per_contact, 1.0));
        if (is(tiny_steps)) limit *= 1e-9;
      }
    }
    return limit;
  }
  double free_distance(const JointInput& in) const override {
    const PlanarMotion<double> m = PlanarPair(in).numbers();
    double free = unbounded;
    for (std::size_t i = 0; i < corners; ++i) {
      if (in.history[i * slots + phase] != flight) return 0.0;
      free = std::min(free, -corner(m, i).delta);
    }
    return std::max(free, 0.0);
  }

 private:
  bool is(Fault fault) const { return fault_ == fault; }
  static double side(std::size_t i) { return i < 2 ? 1.0 : -1.0; }
  static double end(std::size_t i) { return i % 2 == 0 ? 1.0 : -1.0; }

  template <class T>
  Place<T> corner(const PlanarMotion<T>& m, std::size_t i) const {
    const double along = end(i) * half_length_, across = side(i) * half_width_;
    const T rise = T(along) * m.s, sag = space::value_of(m.c) > 0.0 ? m.s * m.s / (T(1.0) + m.c) : T(1.0) - m.c;
    Place<T> at;
    at.arm = {T(along) * m.c - T(across) * m.s, rise + T(across) * m.c};
    at.from_a = m.d + at.arm;
    const Vec2<T> u = m.u + m.w_b * turned(at.arm) - m.w_a * turned(at.from_a);
    at.delta = T(side(i)) * (m.d.y + rise) - T(half_width_) * sag - T(gap_);
    at.rate = T(side(i)) * u.y;
    at.slip = u.x;
    if (is(rate_without_turn_of_guide)) at.rate = at.rate + T(side(i)) * m.w_a * at.from_a.x;
    if (is(slip_without_turn)) at.slip = m.u.x + m.w_a * m.d.y;
    return at;
  }
  double elastic_force(double delta) const { return stiffness_ * delta * std::sqrt(delta); }
  double speed_of(const JointInput& in, std::size_t i, double rate) const {
    const Span<const double> own = in.history.part(i * slots, slots);
    if (is(speed_in_a_member)) return std::max(speeds_[i], least_speed);
    if (own[phase] == contact && own[speed] > 0.0) return own[speed];
    if (own[phase] != flight) return 0.0;
    if (is(no_prediction)) return least_speed;
    return own[predicted] > 0.0 ? own[predicted] : std::max(rate, least_speed);
  }
  /// K delta^1.5 (1 + loss delta'/v_0), and no more than nothing.
  double normal_force(const Corner& c, double v0, bool face) const {
    const double damped = v0 > 0.0 ? 1.0 + loss_ * c.rate / v0 : 1.0;
    double force = elastic_force(c.delta) * damped;
    if (is(face_law_switches) && face) force *= 1.5;
    if (!is(pulls_back)) force = std::max(force, 0.0);
    return is(begins_with_a_jump) ? force + 5.0 : force;
  }
  std::array<Corner, corners> load(const JointInput& in, const PlanarMotion<double>& m) const {
    std::array<Corner, corners> all;
    for (std::size_t i = 0; i < corners; ++i) {
      const Place<double> at = corner(m, i);
      const bool flies =
          in.per_contact != 0.0 && in.history[i * slots + phase] == flight && !is(force_before_the_event);
      all[i] = {at.delta, at.rate, at.slip, 0.0, 0.0, at.delta > 0.0 && !flies};
    }
    for (std::size_t i = 0; i < corners; ++i) {
      Corner& c = all[i];
      if (!c.on) continue;
      c.normal = normal_force(c, speed_of(in, i, c.rate), all[i ^ 1u].on);
      c.tangential = (is(friction_pushes) ? mu_ : -mu_) * c.normal * std::tanh(c.slip / 0.01);
    }
    return all;
  }
  template <class T>
  void add(PlanarPair::Force<T>& total, const Place<T>& at, const T& across, const T& along) const {
    const Vec2<T> f{along, across};
    total.force = total.force + f;
    Vec2<T> arm = at.arm, from_a = at.from_a;
    if (is(friction_at_the_middle)) {
      arm = Vec2<T>{at.arm.x, T(0.0)};
      from_a = at.from_a - at.arm + arm;
    }
    if (!is(no_moment_on_guide)) total.moment_a = total.moment_a - cross(from_a, f);
    total.moment_b = is(moment_on_slider_turned) ? total.moment_b - cross(arm, f) : total.moment_b + cross(arm, f);
  }
  void differentiate(const JointInput& in, const PlanarPair& pair, const std::array<Corner, corners>& all,
                     JointForces& out) const {
    using Dual = PlanarPair::Dual;
    const PlanarMotion<Dual> m = pair.duals();
    PlanarPair::Force<Dual> total;
    for (std::size_t i = 0; i < corners; ++i) {
      const Corner& c = all[i];
      if (!c.on || (is(forgets_a_corner) && i == 3)) continue;
      Place<Dual> at = corner(m, i);
      if (is(derivative_without_turn) && i == 3) at.delta.gradient[2] = 0.0;
      const double shift = 1e-6 * std::abs(c.delta), push = 1e-6 * std::max(std::abs(c.rate), 1e-3);
      const auto normal = [&](double by_delta, double by_rate) {
        Corner there = c;
        there.delta += by_delta;
        there.rate += by_rate;
        return normal_force(there, speed_of(in, i, there.rate), all[i ^ 1u].on);
      };
      const double by_delta = (normal(shift, 0.0) - normal(-shift, 0.0)) / (2.0 * shift),
                   by_rate = (normal(0.0, push) - normal(0.0, -push)) / (2.0 * push);
      const Dual force = space::chained(c.normal, by_delta, at.delta, by_rate, at.rate);
      const double t = std::tanh(c.slip / 0.01), mu = is(friction_pushes) ? mu_ : -mu_;
      const Dual friction = space::chained(c.tangential, mu * t, force, mu * c.normal * (1.0 - t * t) / 0.01, at.slip);
      add(total, at, Dual(-side(i)) * force, friction);
    }
    pair.write_derivatives(total, 24, out);
  }
  /// About 2.9 d/v, where d is as deep as the mass at the corner can go with v.
  double duration(const JointInput& in, const Place<double>& at, double v, std::size_t i) const {
    if (in.whole_mobility == nullptr || in.mobility == nullptr) return 0.0;
    const double n[2] = {in.a->rotation[1], in.a->rotation[4]};
    double inverse = 0.0;
    const double w[6] = {side(i) * n[0], side(i) * n[1], 0.0, 0.0, 0.0, cross(at.arm, Vec2<double>{0.0, side(i)})};
    for (std::size_t r = 0; r < 6; ++r)
      for (std::size_t k = 0; k < 6; ++k) inverse += w[r] * in.whole_mobility[6 * r + k] * w[k];
    if (is(mass_of_the_block)) {
      inverse = 0.0;
      for (std::size_t r = 0; r < 2; ++r)
        for (std::size_t k = 0; k < 2; ++k) inverse += n[r] * in.mobility[3 * r + k] * n[k];
    }
    return inverse > 0.0 ? 2.9 * std::pow(1.25 * v * v / (inverse * stiffness_), 0.4) / v : 0.0;
  }

  int fault_;
  double gap_, half_length_, half_width_, stiffness_, loss_, mu_;
  mutable std::array<double, corners> speeds_{};
};

template <int fault>
struct FaultySlide final : Slide {
  explicit FaultySlide(const Parameters& p) : Slide(fault, p) {}
};

constexpr Parameter parameters[] = {
    {.name = "gap",
     .unit = "m",
     .default_value = 2e-4,
     .minimum = 0.0,
     .open = Open::minimum,
     .summary = "To each side."},
    {.name = "half_length",
     .unit = "m",
     .default_value = 0.03,
     .minimum = 0.0,
     .open = Open::minimum,
     .summary = "Of the block."},
    {.name = "half_width", .unit = "m", .default_value = 0.01, .minimum = 0.0, .summary = "Of the block."},
    {.name = "stiffness",
     .unit = "N/m^1.5",
     .default_value = 1e9,
     .minimum = 0.0,
     .open = Open::minimum,
     .summary = "Of a corner."},
    {.name = "restitution",
     .default_value = 0.7,
     .minimum = 0.4,
     .maximum = 1.0,
     .open = Open::both,
     .summary = "Of speeds, about."},
    {.name = "mu",
     .default_value = 0.1,
     .minimum = 0.0,
     .maximum = 2.0,
     .open = Open::both,
     .summary = "Of friction."}};

constexpr const char* names[] = {"slide-0",  "slide-1",  "slide-2",  "slide-3",  "slide-4",  "slide-5",  "slide-6",
                                 "slide-7",  "slide-8",  "slide-9",  "slide-10", "slide-11", "slide-12", "slide-13",
                                 "slide-14", "slide-15", "slide-16", "slide-17", "slide-18", "slide-19", "slide-20",
                                 "slide-21", "slide-22", "slide-23", "slide-24", "slide-25", "slide-26", "slide-27",
                                 "slide-28", "slide-29", "slide-30", "slide-31"};
static_assert(std::size(names) == faults);

template <int... fault>
std::array<Component, faults> all_slides(std::integer_sequence<int, fault...>) {
  return {joint<FaultySlide<fault>>(
      {.name = names[fault], .space = Space::planar, .summary = "Slider in a guide.", .parameters = parameters})...};
}

}  // namespace

FREEPLAY_PLUGIN(faulty_slides) {
  static const std::array<Component, faults> components = all_slides(std::make_integer_sequence<int, faults>());
  return publish(*host, *manifest, "faulty_slides", "1", {components.data(), components.size()});
}
