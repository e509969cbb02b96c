#include "run/step_events.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "base/index.h"
#include "component/joint_answer.h"
#include "component/joint_roles.h"
#include "run/event_finder.h"

namespace freeplay {
namespace {
constexpr double same_instant = 1e-12;  // part of a step
constexpr double at_once = 1e-3;        // part of a step: what lies before it is left to the step across
constexpr double much_longer = 1.5;     // step than the one before: how functions went there says little
constexpr double faster_inside = 2.0;  // than at both ends no event function moves inside a step, or its error shows it

bool rises_above(const Hermite& curve, double level) {
  return first_rise({curve.value0 - level, curve.slope0, curve.value1 - level, curve.slope1}, 0.0).has_value();
}

// A field may be left NaN, which is recorded as empty.
bool fields_make_sense(const Event& event, Span<const double> fields, Message& message) {
  const auto wild = std::find_if(fields.begin(), fields.end(), [](double x) { return std::isinf(x); });
  if (wild == fields.end()) return true;
  std::snprintf(message.text, sizeof message.text, "the field '%s' of its event '%s' is not a finite number",
                event.fields[static_cast<std::size_t>(wild - fields.begin())].name, event.name);
  return false;
}
}  // namespace

StepEvents::StepEvents(const System& system, const EvaluationContext& context, bool located, State& between,
                       KeptEvaluation& e_between)
    : system_(system),
      context_(context),
      located_(located),
      switches_(system),
      between_(between),
      e_between_(e_between),
      inside_(system.model().joints.size() + 1, 0),
      lost_(system.model().joints.size(), 0.0) {
  std::size_t most_events = 0, all_fields = 0, all_events = 0;
  const int joints = static_cast<int>(system.model().joints.size());
  for (int j = 0; j < joints + (located ? 1 : 0); ++j) {
    const Span<const Event> events = events_of(j);
    if (events.empty()) continue;
    watched_.push_back(j);
    first_event_.push_back(all_events);
    all_events += events.size;
    most_events = std::max(most_events, events.size);
    std::size_t most_fields = 0;
    for (const Event& event : events) {
      most_fields = std::max(most_fields, event.fields.size);
      if (!located || event.locate == 0) inside_[at(j)] = 1;
    }
    all_fields += most_per_step * most_fields;
  }
  for (auto* numbers : {&g0_, &r0_, &gm_, &rm_, &g1_, &r1_}) numbers->resize(most_events);
  happening_.resize(most_events, 0);
  armed_.resize(all_events, 0);
  seen_.resize(all_events, 0);
  for (auto* numbers : {&start_, &start_rate_, &end_, &end_rate_, &earlier_, &earlier_rate_})
    numbers->resize(all_events);
  // Reserved once: a step appends without allocating.
  values_.reserve(all_fields);
  happenings_.reserve(most_per_step * watched_.size());
}

bool StepEvents::functions(int joint, const Place& place, const Evaluation& e, std::span<double> g,
                           std::span<double> rate, Fault& fault) {
  if (are_switches(joint)) {
    switches_.functions(place.point, place.a, e, g, rate);
    return true;
  }
  if (system_.joints().handle(joint).events(system_.joints().input(joint, place.point, e), {g.data(), g.size()},
                                            {rate.data(), rate.size()}, fault.message)) {
    // What is not armed is NaN; a difference of a number from itself is zero unless it is not finite.
    const auto wild = [&](std::size_t i) { return !std::isnan(g[i]) && (g[i] - g[i]) + (rate[i] - rate[i]) != 0.0; };
    std::size_t i = 0;
    while (i < g.size() && !wild(i)) ++i;
    if (i == g.size()) return true;
    std::snprintf(fault.message.text, sizeof fault.message.text, "its event '%s' has a %s that is not a finite number",
                  system_.joints().layout(joint).events[i].name, std::isinf(g[i]) ? "value" : "rate");
  }
  fault.kind = Fault::Kind::plugin;
  fault.joint = joint;
  return false;
}

bool StepEvents::apply(const State& before, const Evaluation& e_before, State& after, const Evaluation& e_after,
                       Mobility mobility, void* self, Fault& fault) {
  happenings_.clear();
  values_.clear();
  switched_ = false;
  for (std::size_t w = 0; w < watched_.size(); ++w) {
    if (located_) arm_located(w);
    if (inside_[at(watched_[w])] == 0 || context_.is_asleep(watched_[w])) continue;
    // A joint's present history decides what can happen next.
    const Step step{before,       e_before, after, e_after, {before.t(), before.q(), before.v(), before.z(), after.h()},
                    point(after), mobility, self};
    if (!apply_joint(w, step, fault)) return false;
  }
  // Stable by hand: a handful of entries, and no allocation.
  for (std::size_t i = 1; i < happenings_.size(); ++i) {
    for (std::size_t k = i; k > 0 && happenings_[k].time < happenings_[k - 1].time; --k) {
      std::swap(happenings_[k], happenings_[k - 1]);
    }
  }
  return true;
}

void StepEvents::arm_located(std::size_t watched) {
  const Span<const Event> events = events_of(watched_[watched]);
  for (std::size_t i = 0; i < events.size; ++i) {
    if (events[i].locate != 0) armed_[first_event_[watched] + i] = seen_[first_event_[watched] + i];
  }
}

bool StepEvents::apply_joint(std::size_t watched, const Step& step, Fault& fault) {
  const int joint = watched_[watched];
  const std::span armed = std::span(armed_).subspan(first_event_[watched]);
  const Span<const Event> events = system_.joints().layout(joint).events;
  const std::span g0 = std::span(g0_).first(events.size), r0 = std::span(r0_).first(events.size);
  const std::span g1 = std::span(g1_).first(events.size), r1 = std::span(r1_).first(events.size);
  const double dt = step.end.t - step.start.t;
  double reached = 0.0;
  const std::span handled = std::span(happening_).first(events.size);  // at `reached`
  std::ranges::fill(handled, 0);
  for (int count = 0; count < most_per_step; ++count) {
    if (!functions(joint, {step.start, step.before.a()}, step.e_before, g0, r0, fault)) return false;
    if (!functions(joint, {step.end, step.after.a()}, step.e_after, g1, r1, fault)) return false;
    int next = -1;
    double earliest = 2.0;
    for (std::size_t i = 0; i < events.size; ++i) {
      if (located_ && events[i].locate != 0) continue;
      const bool known = armed[i] != 0;
      armed[i] = std::isnan(g0[i]) || std::isnan(g1[i]) ? 0 : 1;
      if (armed[i] == 0) continue;
      const double sign = events[i].crossing == Crossing::rising ? 1.0 : -1.0;
      // Others may happen at the same instant, as at both ends of a bearing.
      const double from = handled[i] != 0 ? reached : std::max(0.0, reached - same_instant);
      auto s = first_rise({sign * g0[i], sign * r0[i] * dt, sign * g1[i], sign * r1[i] * dt}, from);
      if (!s && !known && sign * g1[i] > 0.0) s = reached;  // armed when it was past its zero
      if (s && *s < earliest) earliest = *s, next = static_cast<int>(i);
    }
    if (next < 0) return true;
    if (earliest > reached + same_instant) std::ranges::fill(handled, 0);
    reached = std::max(reached, earliest);
    handled[at(next)] = 1;
    if (!handle_inside(joint, next, earliest, step, fault)) return false;
  }
  return true;
}

bool StepEvents::handle_inside(int joint, int event, double s, const Step& step, Fault& fault) {
  const State& before = step.before;
  State& after = step.after;
  const double dt = after.t() - before.t();
  // A contact wants its mass to know how long an impact of it lasts. The room for the state between is lent.
  double mobility[mobility_numbers];
  const bool begins = event_role(system_.joints().layout(joint), at(event)) == EventRole::contact_begin;
  const bool moves = begins && step.mobility(step.self, joint, mobility);
  between_.t() = before.t() + s * dt;
  if (system_.model().space == Space::planar) {
    for (std::size_t i = 0; i < before.q().size(); ++i) {
      between_.q()[i] = Hermite{before.q()[i], before.v()[i] * dt, after.q()[i], after.v()[i] * dt}.at(s);
    }
  } else {
    DenseStep(system_.model().space, before, {}, after, {}).at(s, between_);
  }
  for (std::size_t i = 0; i < before.v().size(); ++i) {
    between_.v()[i] = Hermite{before.v()[i], before.a()[i] * dt, after.v()[i], after.a()[i] * dt}.at(s);
  }
  std::ranges::copy(after.z(), between_.z().begin());
  std::ranges::copy(after.h(), between_.h().begin());
  if (!system_.evaluate(point(between_), term_event, e_between_)) {
    fault = e_between_->fault;
    return false;
  }
  return handle(joint, event, point(between_), e_between_, after, fault, moves ? mobility : nullptr);
}

bool StepEvents::functions_of_all(const Place& place, const Evaluation& e, std::vector<double>& g,
                                  std::vector<double>& rate, Fault& fault) {
  for (std::size_t w = 0; w < watched_.size(); ++w) {
    const std::size_t first = first_event_[w], count = events_of(watched_[w]).size;
    if (!functions(watched_[w], place, e, std::span(g).subspan(first, count), std::span(rate).subspan(first, count),
                   fault)) {
      return false;
    }
  }
  return true;
}

bool StepEvents::look_from(const State& start, const Evaluation& e_start, Fault& fault) {
  std::swap(start_, earlier_);
  std::swap(start_rate_, earlier_rate_);
  // After an event functions go on otherwise.
  earlier_by_ = !changed() ? start.t() - start_time_ : 0.0;
  start_time_ = start.t();
  if (located_ && switches_.count() > 0) switches_.look_from(point(start), e_start);
  if (!functions_of_all(place(start), e_start, start_, start_rate_, fault)) return false;
  for (const Happening& handled : happenings_) leave_zero(handled.joint, handled.event);
  return true;
}

// An event that was passed on at its very zero lies before the state, and not at the start of the step to come.
void StepEvents::leave_zero(int joint, int event) {
  const Event& layout = system_.joints().layout(joint).events[at(event)];
  if (layout.locate == 0) return;
  const auto w = static_cast<std::size_t>(std::ranges::lower_bound(watched_, joint) - watched_.begin());
  double& value = start_[first_event_[w] + at(event)];
  if (std::abs(value) <= tolerance) value = std::copysign(tolerance, layout.crossing == Crossing::rising ? 1.0 : -1.0);
}

StepEvents::Passage StepEvents::expected_within(double dt) const {
  Passage first;
  if (!(dt <= much_longer * earlier_by_)) return first;
  for (std::size_t w = 0; w < watched_.size(); ++w) {
    const Span<const Event> events = events_of(watched_[w]);
    for (std::size_t i = 0; i < events.size; ++i) {
      const std::size_t event = first_event_[w] + i;
      if (events[i].locate == 0 || std::isnan(earlier_[event]) || std::isnan(start_[event])) continue;
      const double sign = events[i].crossing == Crossing::rising ? 1.0 : -1.0;
      const Hermite before{sign * earlier_[event], sign * earlier_rate_[event] * earlier_by_, sign * start_[event],
                           sign * start_rate_[event] * earlier_by_};
      const Hermite ahead = before.ahead(dt / earlier_by_);
      const auto s = first_rise(ahead, 0.0);
      if (s && *s<first.fraction&& * s> at_once)
        first = {watched_[w], static_cast<int>(i), *s, ahead.value1, ahead.slope1 / dt};
    }
  }
  return first;
}

// Whether an event function may pass its zero inside a step of length dt, growing with `sign`: what lies below it at
// both ends has too far to go.
bool StepEvents::could_cross(std::size_t event, double sign, double dt) const {
  const double farthest = faster_inside * dt * std::max(std::abs(start_rate_[event]), std::abs(end_rate_[event]));
  return !(sign * start_[event] < 0.0 && sign * end_[event] < 0.0 && -sign * (start_[event] + end_[event]) > farthest);
}

bool StepEvents::first_crossing(const State& before, const Evaluation& e_before, const State& after,
                                const Evaluation& e_after, bool sharp, Passage& found, Fault& fault) {
  found = {};
  if (watched_.empty()) return true;
  const Place end{{after.t(), after.q(), after.v(), after.z(), before.h()}, after.a()};
  if (!functions_of_all(end, e_after, end_, end_rate_, fault)) return false;
  const double dt = after.t() - before.t(), half = 0.5 * dt;
  double earliest = 2.0;
  bool looked = false;
  for (std::size_t w = 0; w < watched_.size(); ++w) {
    const int joint = watched_[w];
    const Span<const Event> events = events_of(joint);
    const std::span gm = std::span(gm_).first(events.size), rm = std::span(rm_).first(events.size);
    bool asked = false;
    for (std::size_t i = 0; i < events.size; ++i) {
      if (events[i].locate == 0) continue;
      const std::size_t event = first_event_[w] + i;
      const double sign = events[i].crossing == Crossing::rising ? 1.0 : -1.0;
      const bool known = armed_[event] != 0;
      seen_[event] = std::isnan(start_[event]) || std::isnan(end_[event]) ? 0 : 1;
      if (seen_[event] == 0 || !could_cross(event, sign, dt)) continue;
      if (!looked) {
        DenseStep(system_.model().space, before, e_before.internal_rate, after, e_after.internal_rate)
            .at(0.5, between_);
        if (!look_between(fault)) return false;
      }
      looked = true;
      if (!asked && !functions(joint, place(between_), e_between_, gm, rm, fault)) return false;
      asked = true;
      if (std::isnan(gm[i])) {
        seen_[event] = 0;
        continue;
      }
      const Hermite first{sign * start_[event], sign * start_rate_[event] * half, sign * gm[i], sign * rm[i] * half};
      const Hermite second{first.value1, first.slope1, sign * end_[event], sign * end_rate_[event] * half};
      double at = 2.0;
      // A function that rests at its zero crosses it by rounding all the time; one that comes from below arrives there.
      const bool below =
          std::max(first.value1, second.value1) <= event_rounding && std::min(first.value0, first.value1) >= -tolerance;
      if (below && !rises_above(first, tolerance) && !rises_above(second, tolerance)) continue;
      if (const auto s = first_rise(first, 0.0)) {
        at = 0.5 * *s;
      } else if (const auto later = first_rise(second, 0.0)) {
        at = 0.5 + 0.5 * *later;
      } else if (!known && second.value1 > 0.0) {
        at = 0.5;  // armed when it was past its zero: the step is halved until it ends there
      }
      if (at < earliest) {
        earliest = at;
        found = {joint, static_cast<int>(i), at, second.value1, sign * end_rate_[event]};
      }
    }
  }
  return !sharp || found.joint < 0 || found.fraction == 1.0 || sharpen(before, e_before, after, e_after, found, fault);
}

bool StepEvents::look_between(Fault& fault) {
  if (system_.evaluate(point(between_), term_event, e_between_)) {
    if (switches_.count() > 0) system_.constraints().fill_driven(e_between_);
    return true;
  }
  fault = e_between_->fault;
  return false;
}

// Newton's steps on the interpolated motion, which knows more than the cubics of the function.
bool StepEvents::sharpen(const State& before, const Evaluation& e_before, const State& after, const Evaluation& e_after,
                         Passage& found, Fault& fault) {
  const Span<const Event> events = events_of(found.joint);
  const std::span g = std::span(gm_).first(events.size), rate = std::span(rm_).first(events.size);
  const double sign = events[at(found.event)].crossing == Crossing::rising ? 1.0 : -1.0;
  const double dt = after.t() - before.t();
  for (int step = 0; step < 2; ++step) {
    DenseStep(system_.model().space, before, e_before.internal_rate, after, e_after.internal_rate)
        .at(found.fraction, between_);
    if (!look_between(fault)) return false;
    if (!functions(found.joint, place(between_), e_between_, g, rate, fault)) return false;
    const double change = sign * g[at(found.event)] / (sign * rate[at(found.event)] * dt);
    // Far from the cubics' root it is another root, or none.
    if (!(std::abs(change) < 0.1 * found.fraction) || !(found.fraction - change < 1.0)) break;
    found.fraction -= change;
  }
  return true;
}

bool StepEvents::at_end(const State& after, const Evaluation& e_after, Passage& passage, Fault& fault) {
  const Span<const Event> events = events_of(passage.joint);
  const std::span g = std::span(g1_).first(events.size), r = std::span(r1_).first(events.size);
  if (!functions(passage.joint, place(after), e_after, g, r, fault)) return false;
  const double sign = events[at(passage.event)].crossing == Crossing::rising ? 1.0 : -1.0;
  passage.value = sign * g[at(passage.event)];
  passage.rate = sign * r[at(passage.event)];
  passage.unit = are_switches(passage.joint) ? switches_.unit(passage.event) : 1.0;
  return true;
}

bool StepEvents::apply_at_end(const Passage& hunted, double late, State& after, const Evaluation& e_after,
                              Mobility mobility, void* self, Fault& fault) {
  if (hunted.joint < 0) return true;
  for (const int joint : watched_) {
    const Span<const Event> events = events_of(joint);
    const std::span g = std::span(g1_).first(events.size), r = std::span(r1_).first(events.size);
    const auto happens = [&](int i) {
      const double sign = events[at(i)].crossing == Crossing::rising ? 1.0 : -1.0, past = sign * g[at(i)];
      if (past >= -tolerance && past <= std::max(tolerance, late) && sign * r[at(i)] > 0.0) return true;
      return joint == hunted.joint && i == hunted.event && !std::isnan(g[at(i)]);
    };
    if (!functions(joint, place(after), e_after, g, r, fault)) return false;
    for (int i = 0; i < static_cast<int>(events.size); ++i) {
      happening_[at(i)] = events[at(i)].locate != 0 && happens(i) ? 1 : 0;
    }
    // What one event makes possible does not happen at the same instant; what it makes impossible does not either.
    bool changed = false;
    for (int i = 0; i < static_cast<int>(events.size); ++i) {
      if (happening_[at(i)] == 0) continue;
      if (changed && !functions(joint, place(after), e_after, g, r, fault)) return false;
      if (changed && !happens(i)) continue;
      if (are_switches(joint)) {
        switches_.change(i, after);
        switched_ = true;
        last_switch_ = i;
        continue;
      }
      double numbers[mobility_numbers];
      if (!mobility(self, joint, numbers) || !handle(joint, i, point(after), e_after, after, fault, numbers)) {
        return false;
      }
      changed = true;
    }
  }
  return true;
}

bool StepEvents::handle(int joint, int event, const Point& here, const Evaluation& e, State& state, Fault& fault,
                        const double* mobility) {
  const Slice z = system_.layout().internal(joint), h = system_.layout().history(joint);
  const std::size_t first = values_.size(), count = system_.joints().layout(joint).events[at(event)].fields.size;
  values_.resize(first + count, std::numeric_limits<double>::quiet_NaN());
  JointInput in = system_.joints().input(joint, here, e);
  in.mobility = mobility;
  in.dissipated = &lost_[at(joint)];
  if (mobility != nullptr && system_.joints().layout(joint).wants_whole_mobility != 0) in.whole_mobility = mobility + 9;
  const Span<double> internal = Span<double>(state.z()).part(at(z.offset), at(z.size)),
                     history = Span<double>(state.h()).part(at(h.offset), at(h.size));
  if (!system_.joints().handle(joint).on_event(event, in, internal, history, {values_.data() + first, count},
                                               fault.message) ||
      !keeps_finite(internal, history, "on_event", fault.message) ||
      !fields_make_sense(system_.joints().layout(joint).events[at(event)], {values_.data() + first, count},
                         fault.message)) {
    fault.kind = Fault::Kind::plugin;
    fault.joint = joint;
    return false;
  }
  happenings_.push_back({here.t, joint, event, first, count});
  return true;
}

bool StepEvents::at_start(State& start, const Evaluation& e, Fault& fault) {
  std::ranges::fill(lost_, 0.0);
  happenings_.clear();
  values_.clear();
  switched_ = switches_.renew(start, e);
  switched_ = false;
  for (std::size_t w = 0; w < watched_.size(); ++w) {
    const int joint = watched_[w];
    if (are_switches(joint)) {
      const auto first = armed_.begin() + static_cast<std::ptrdiff_t>(first_event_[w]);
      std::fill_n(first, switches_.count(), char{1});
      std::fill_n(seen_.begin() + static_cast<std::ptrdiff_t>(first_event_[w]), switches_.count(), char{1});
      continue;
    }
    const Span<const Event> events = events_of(joint);
    const std::span g = std::span(g0_).first(events.size), r = std::span(r0_).first(events.size);
    if (!functions(joint, place(start), e, g, r, fault)) return false;
    for (std::size_t i = 0; i < events.size; ++i) {
      armed_[first_event_[w] + i] = seen_[first_event_[w] + i] = std::isnan(g[i]) ? 0 : 1;
      if (events[i].crossing != Crossing::rising || !(g[i] > 0.0)) continue;
      if (!handle(joint, static_cast<int>(i), point(start), e, start, fault)) return false;
    }
  }
  return true;
}

std::string StepEvents::words(const Passage& passage) const {
  if (are_switches(passage.joint)) return "the change of form of " + switches_.words(passage.event);
  return std::string("event '") + events_of(passage.joint)[at(passage.event)].name + "' of joint '" +
         system_.model().joints[at(passage.joint)].name + "'";
}

}  // namespace freeplay
