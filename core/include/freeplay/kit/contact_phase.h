// The history of one contact of a joint with play: flight and contact, approach speed, events, impact.
#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "freeplay/kit/play_parameters.h"

namespace freeplay::play {

/// How deep two surfaces stand in each other, negative in flight, and how fast that grows.
struct Approach {
  double penetration;  ///< delta [m]
  double rate;         ///< delta' [m/s]
};

/// The numbers of one contact in the joint's `history`.
enum Slot : std::size_t {
  phase,            ///< flight, contact or on_from_start
  approach_speed,   ///< v_0 of the present contact, 0: elastic part only [m/s]
  predicted,        ///< v_0 of a contact that begins in this step, 0: none [m/s]
  step_end,         ///< time at which an event counts as located at the end of the step [s]
  begin_time,       ///< of the present contact [s]
  max_force,        ///< of the present contact [N]
  max_penetration,  ///< of the present contact [m]
  steps,            ///< accepted steps of the present contact
  impact_time,      ///< how long the present contact lasts if it is an impact, 0: not known [s]
  slots
};

/// Values of `phase`. `on_from_start` is a contact without an event so far: its begin event is still armed.
inline constexpr double flight = 0.0, contact = 1.0, on_from_start = 2.0;

/// v_0 is at least this [m/s]; laws divide by it.
inline constexpr double smallest_approach_speed = 1e-6;

inline constexpr Channel event_fields[] = {
    {"speed", "m/s"}, {"tangential_speed", "m/s"}, {"direction", "rad"}, {"duration", "s"},
    {"max_fn", "N"},  {"max_delta", "m"},          {"steps", "1"},       {"impact", "1"}};
inline constexpr EventRole begin_and_end[] = {EventRole::contact_begin, EventRole::contact_end};
/// Input and history of one of the contacts of a joint.
inline JointInput contact_input(const JointInput& in, std::size_t index) {
  JointInput one = in;
  one.history = in.history.part(index * slots, slots);
  return one;
}

/// Where steps end at events a flight lasts until its event: an attempt that passes it stays smooth.
inline bool flies(const JointInput& in) { return in.per_contact != 0.0 && in.history[phase] == flight; }
inline bool touches(const JointInput& in, const Approach& gap) { return gap.penetration > 0.0 && !flies(in); }

/// v_0 is the rate itself, which adds dF/dv_0 to dF/ddelta'; laws do not give it, so the sum is differenced.
inline ContactForce unpredicted(const ContactLawRef& law, const Approach& gap) {
  const double v0 = std::max(gap.rate, smallest_approach_speed);
  ContactForce f = law.evaluate({gap.penetration, gap.rate, v0});
  if (gap.rate <= smallest_approach_speed) return f;
  // Of the fourth order, so that steps may be long: a force that is large beside its slope leaves little rounding in
  // it.
  const double step = std::min(1e-3 * gap.rate, 0.5 * (gap.rate - smallest_approach_speed));
  const auto difference = [&](double by) {
    const auto at = [&](double v) { return law.evaluate({gap.penetration, v, v}).normal; };
    return (at(gap.rate + by) - at(gap.rate - by)) / (2.0 * by);
  };
  f.d_rate = (4.0 * difference(step) - difference(2.0 * step)) / 3.0;
  return f;
}

/// Normal force at delta > 0. In flight the contact begins in this very step: v_0 is the predicted one or, without
/// prediction, that of the state itself.
inline ContactForce normal_force(const ContactLawRef& law, const Approach& gap, const JointInput& in) {
  const Span<const double> history = in.history;
  if (history[phase] != flight) return law.evaluate({gap.penetration, gap.rate, history[approach_speed]});
  if (history[predicted] > 0.0) return law.evaluate({gap.penetration, gap.rate, history[predicted]});
  return unpredicted(law, gap);
}
/// Power that goes into the stored energy of the contact [W].
inline double storing_power(const ContactLawRef& law, const Approach& gap, const ContactForce& f) {
  const bool given = !std::isnan(f.elastic);
  return gap.rate * (given ? f.elastic : law.evaluate({gap.penetration, 0.0, 0.0}).normal);
}

/// Smallest root s > 0 of delta + delta' s + delta'' s^2/2 from flight, delta < 0; unbounded without one.
inline double time_to_contact(const Approach& gap, double second) {
  const double discriminant = gap.rate * gap.rate - 2.0 * second * gap.penetration;
  if (discriminant < 0.0) return unbounded;
  // The first root is that of growing delta; each form of it keeps its digits.
  const double root = std::sqrt(discriminant);
  double s = unbounded;
  if (gap.rate >= 0.0) s = -2.0 * gap.penetration / (gap.rate + root);
  if (gap.rate < 0.0 && second > 0.0) s = (root - gap.rate) / second;
  return s;
}

/// v_0 of a contact that begins within dt, from delta'' and the size that the speed of approach has at most after a
/// time s. 0: none does.
template <class MostSpeed>
double predicted_speed(const Approach& gap, double second, double dt, const MostSpeed& most_speed) {
  if (gap.penetration >= 0.0) return gap.rate > 0.0 ? std::max(gap.rate, smallest_approach_speed) : 0.0;
  const double s = time_to_contact(gap, second);
  if (!(s <= dt)) return 0.0;
  // The parabola may be poor; the speed of approach never exceeds the speed.
  return std::max(std::min(gap.rate + second * s, most_speed(s)), smallest_approach_speed);
}

/// A contact begins at time t with the rate `rate`. What is on from the start keeps v_0 = 0 and its time.
/// Where the step ends at the crossing (`located`) the rate is exact; else the forces have used the prediction.
inline void begin(double t, double rate, bool located, Span<double> history) {
  const bool told_late = history[phase] == on_from_start;
  history[phase] = contact;
  if (told_late) return;
  const bool keep = history[predicted] > 0.0 && !located;
  history[approach_speed] = keep ? history[predicted] : std::max(rate, smallest_approach_speed);
  history[begin_time] = t;
  history[max_force] = history[max_penetration] = history[steps] = 0.0;
}
/// Flight; the end of the present step stays known.
inline void reset(Span<double> history) {
  const double end = history[step_end];
  std::fill(history.begin(), history.end(), 0.0);
  history[step_end] = end;
}

inline void start(double t, const Approach& gap, Span<double> history) {
  reset(history);
  if (!(gap.penetration > 0.0)) return;
  history[phase] = on_from_start;
  history[begin_time] = t;
}
/// At the start of a step of length dt. Is the speed of a contact that begins in it to be predicted?
inline bool begin_step(const JointInput& in, double dt, Span<double> history) {
  // A little inside, so that rounding of t + dt does not matter.
  history[step_end] = in.t + dt * (1.0 - 1e-9);
  history[predicted] = 0.0;
  return history[phase] == flight && in.per_contact == 0.0;
}
/// Event functions of the begin and of the end, and their rates.
inline void write_events(const JointInput& in, const Approach& gap, Span<double> g, Span<double> rate) {
  g[0] = in.history[phase] != contact ? gap.penetration : not_a_number;
  g[1] = in.history[phase] != flight ? gap.penetration : not_a_number;
  rate[0] = rate[1] = gap.rate;
}
/// Functions that are zero where the law of friction has a kink, two for each of its speeds: one for each direction.
inline void write_kinks(const FrictionLawRef& law, double slip, Span<double> g) {
  const Span<const double> speeds = law.kinks();
  for (std::size_t i = 0; i < speeds.size; ++i) {
    g[2 * i] = slip - speeds[i];
    g[2 * i + 1] = slip + speeds[i];
  }
}
inline std::int32_t count_kinks(const FrictionLawRef& law) { return static_cast<std::int32_t>(2 * law.kinks().size); }

/// The same for both laws of a contact that is on, with what else they decide by.
inline void write_kinks(const ContactLawRef& normal, const FrictionLawRef& friction, const Approach& gap, double slip,
                        const JointInput& in, Span<double> g) {
  const auto fixed = static_cast<std::size_t>(count_kinks(friction));
  write_kinks(friction, slip, g.part(0, fixed));
  const auto of_normal = static_cast<std::size_t>(normal.switches()), rest = g.size - fixed - of_normal;
  if (of_normal > 0) normal.decide({gap.penetration, gap.rate, in.history[approach_speed]}, g.part(fixed, of_normal));
  if (rest > 0) friction.decide({normal_force(normal, gap, in).normal, slip, {}}, g.part(fixed + of_normal, rest));
}
inline std::int32_t count_kinks(const ContactLawRef& normal, const FrictionLawRef& friction) {
  return count_kinks(friction) + normal.switches() + friction.switches();
}

/// A contact is an impact as long as it lasts no more than so many times as long as one of the law alone.
inline constexpr double longest_impact = 4.0;

/// Fields 0 and 3 to 7 of an event; the others become NaN. `history[impact_time]` is left to the caller.
inline void tell_begin(const JointInput& in, const Approach& gap, Span<double> history, Span<double> fields) {
  std::fill(fields.begin(), fields.end(), not_a_number);
  begin(in.t, gap.rate, in.t >= history[step_end], history);
  // The speed that the law uses: where the crossing lies inside the step, the motion after it feels the contact.
  const bool exact = history[approach_speed] == 0.0 || in.per_contact > 0.0;
  fields[0] = exact ? std::max(gap.rate, 0.0) : history[approach_speed];
}
inline void tell_end(const JointInput& in, const Approach& gap, Span<double> history, Span<double> fields) {
  std::fill(fields.begin(), fields.end(), not_a_number);
  fields[0] = std::max(-gap.rate, 0.0);
  fields[3] = in.t - history[begin_time];
  fields[4] = history[max_force];
  fields[5] = history[max_penetration];
  fields[6] = history[steps] + 1.0;  // the step in which it ends
  // What was on from the start has no approach speed and counts as lasting.
  const bool known = history[impact_time] > 0.0 || !(history[approach_speed] > 0.0);
  const bool impact = history[approach_speed] > 0.0 && fields[3] <= longest_impact * history[impact_time];
  fields[7] = !known ? not_a_number : impact ? 1.0 : 0.0;
  reset(history);
}
/// What commit() does to a flight that goes on.
inline void stay_in_flight(Span<double> history) { history[predicted] = 0.0; }
/// `share`: of the law's force that this contact has.
inline void commit(const JointInput& in, const Approach& gap, const ContactLawRef& law, double share,
                   Span<double> history) {
  // Crossings without an event, because delta stood at its zero to rounding when the step began. One that stands at
  // zero itself crosses in the step to come, which has its event.
  if (history[phase] == flight && gap.penetration > 0.0 && gap.rate > 0.0) begin(in.t, gap.rate, false, history);
  if (history[phase] != flight && gap.penetration < 0.0 && gap.rate <= 0.0) reset(history);
  stay_in_flight(history);
  if (history[phase] == flight) return;
  // A contact that began at the very end of the step has not taken it.
  if (in.t > history[begin_time]) history[steps] += 1.0;
  if (!touches(in, gap)) return;
  const double force = share * law.evaluate({gap.penetration, gap.rate, history[approach_speed]}).normal;
  history[max_force] = std::max(history[max_force], force);
  history[max_penetration] = std::max(history[max_penetration], gap.penetration);
}
/// An impact: its duration over the steps that it should take; after twice its duration it is a lasting contact.
inline double impact_step(const JointInput& in) {
  const double duration = in.history[impact_time];
  const bool impact = duration > 0.0 && in.t - in.history[begin_time] < 2.0 * duration;
  return impact ? duration / std::max(in.per_contact, 1.0) : unbounded;
}

/// About 3 d/v_0 for an impact that ends at the greatest penetration d: 2.94 for F ~ delta^1.5, pi for a spring. d
/// is where the law, times `share`, stores m v_0^2/2 [s]. 0 where nothing is moved.
inline double impact_duration(const ContactLawRef& law, const Approach& gap, double clearance, double inverse_mass,
                              double share) {
  const double speed = std::max(gap.rate, smallest_approach_speed), energy = 0.5 * speed * speed / inverse_mass;
  if (!(inverse_mass > 0.0)) return 0.0;
  // A law may refuse a penetration; the impact has not asked for it yet.
  const auto stored = [&](double d) {
    try {
      return share * law.evaluate({d, 0.0, 0.0}).potential;
    } catch (const std::exception&) {
      return unbounded;
    }
  };
  double low = 0.0, high = 1e-6 * clearance;
  for (int i = 0; i < 60 && stored(high) < energy; ++i) low = high, high *= 2.0;
  for (int i = 0; i < 10; ++i) (stored(0.5 * (low + high)) < energy ? low : high) = 0.5 * (low + high);
  return 2.9 * low / speed;
}

/// Penetration at which static contact carries `force` [N]: bisection with Newton steps where they stay inside.
inline double resting_penetration(const ContactLawRef& law, double clearance, double force) {
  const auto at = [&](double penetration) { return law.evaluate({penetration, 0.0, 0.0}); };
  double low = 0.0, high = 1e-6 * clearance;
  for (int i = 0; i < 60 && !(at(high).normal >= force); ++i) {
    low = high;
    high *= 2.0;
  }
  if (!(at(high).normal >= force)) throw std::runtime_error("the contact law cannot carry the load of the start");
  double x = high;
  for (int i = 0; i < 200 && high - low > 4e-16 * high; ++i) {
    const ContactForce f = at(x);
    if (f.normal == force) break;
    (f.normal < force ? low : high) = x;
    const double newton = x - (f.normal - force) / f.d_penetration;
    const double next = newton > low && newton < high ? newton : 0.5 * (low + high);
    if (std::abs(next - x) <= 2e-16 * x) break;
    x = next;
  }
  return x;
}

}  // namespace freeplay::play
