#include "run/event_pursuit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/index.h"
#include "run/dense_step.h"

namespace freeplay {
namespace {

constexpr double event_time = 1e-11;     // a located event is as sharp as this [s], or as its function can be
constexpr double event_share = 1e-5;     // or as this part of what a position may err by in a step
constexpr double largest_defect = 0.5;   // of the motion interpolated there, as a part of what a step may err
constexpr int early_hunts = 4;           // of the hunts for an event, that trust the interpolated motion
constexpr double largest_error = 100.0;  // error of a step, in tolerances, at which event times are usable
constexpr double little_beyond = 1.01;   // of a step: its motion is continued so far

}  // namespace

EventPursuit::EventPursuit(RunContext& run, RunFailure& failure, StepAttempt& attempt, StepInside& inside)
    : run_(run), failure_(failure), attempt_(attempt), inside_(inside), defect_(at(run.system.layout().nv())) {}

double EventPursuit::before_event(double dt, double shorter, StepEvents::Passage& hunted) {
  if (!(run_.error <= largest_error) || run_.solver.regularity() < near_singular) return shorter;
  const Profile::Timer timer(run_.evaluations.profile, Phase::events);
  // What no joint can be asked about says nothing; nor does it matter, as the step does not stand.
  Fault fault;
  StepEvents::Passage found;
  if (!attempt_.evaluate_all(run_.trial, run_.e_trial) ||
      !run_.events.first_crossing(run_.accepted, run_.e_accepted, run_.trial, run_.e_trial, false, found, fault)) {
    return shorter;
  }
  if (found.joint < 0 || !(found.fraction * dt < shorter)) return shorter;
  hunted = found;
  return found.fraction * dt;
}

bool EventPursuit::pursue(StepEvents::Passage& hunted, EventBracket& bracket, double& dt, int hunts, double goal,
                          bool& done) {
  const Profile::Timer timer(run_.evaluations.profile, Phase::events);
  Fault fault;
  StepEvents::Passage found;
  const bool early = hunts < early_hunts;
  if (!run_.events.first_crossing(run_.accepted, run_.e_accepted, run_.trial, run_.e_trial, early, found, fault)) {
    return failure_.fail_with(fault, run_.trial.t());
  }
  const bool same = found.joint == hunted.joint && found.event == hunted.event;
  if (found.joint < 0 && hunted.joint < 0) {
    done = true;
    return true;
  }
  // Another event comes first, or this is the first sight of one.
  if (found.joint >= 0 && !same) hunted = found;
  if (!run_.events.at_end(run_.trial, run_.e_trial, hunted, fault)) return failure_.fail_with(fault, run_.trial.t());
  // The step ends just past the zero, so that what begins there acts from the first on.
  const double past = hunted.value;
  // Rounding may leave it no sharper.
  const bool late = hunts > most_hunts / 2;
  const double tolerance = late ? std::max(StepEvents::tolerance, event_lateness()) : allowed_past(hunted);
  const bool sharp = late || is_sharp(hunted);
  const bool ends_there = found.joint < 0 || same || found.fraction == 1.0;
  // An event may lie so close to the start of the step that the time cannot separate them.
  const double least = std::nextafter(run_.accepted.t(), unbounded) - run_.accepted.t();
  if (ends_there && past >= 0.0 && ((past <= tolerance && sharp) || dt <= least)) {
    done = true;
    return true;
  }
  if (hunts > most_hunts) {
    return failure_.fail(
        4, fmt::format("t = {:.9g} s: {} could not be located{}", run_.accepted.t(), run_.events.words(hunted),
                       failure_.all_built_in() ? std::string(advice::other_steps) : fmt::format("; {}", event_rule)));
  }
  bracket.note(hunted, dt);
  // Newton's step from close by, the root of the cubic from afar, and half of the step where neither helps.
  const double aim = aim_past(hunted, dt);
  const double newton = dt - (hunted.value - aim) / hunted.rate;
  const bool near = std::abs(newton - dt) < 0.1 * dt && hunted.rate > 0.0;
  // What a longer or less accurate step met is not here, or not yet: no step goes beyond the goal for it.
  if (found.joint < 0 && !(past >= 0.0) && (!near || run_.trial.t() >= goal)) {
    hunted = {};
    done = true;
    return true;
  }
  const double beyond = early && hunted.rate > 0.0 ? aim / hunted.rate : 0.0;
  const double root = found.fraction * dt + beyond;
  double next = near ? newton : (found.joint >= 0 ? root : dt);
  // Rounding may hold Newton's step where it is: then by more each time.
  const double nudge = std::ldexp(4.0 * rounding, hunts);
  if (std::abs(next - dt) <= nudge * dt) next = past < 0.0 ? dt * (1.0 + nudge) : dt * (1.0 - nudge);
  if (!(next > 0.0)) next = 0.5 * dt;
  if (late) next = bracket.inside(aim).value_or(next);
  dt = std::max(next, least);
  return true;
}

double EventPursuit::event_lateness() const { return event_share * run_.allowed; }

bool EventPursuit::is_sharp(const StepEvents::Passage& end) const {
  return end.value <= event_rounding || end.value <= std::max(event_time * end.rate, end.unit * event_lateness());
}

double EventPursuit::allowed_past(const StepEvents::Passage& end) const {
  return end.unit * std::max(StepEvents::tolerance, event_lateness());
}

// How far past its zero a step of the length dt should end.
double EventPursuit::aim_past(const StepEvents::Passage& end, double dt) const {
  const double wanted = std::max(0.1 * event_time * end.rate, 0.5 * end.unit * event_lateness());
  // No farther than a small part of the step: from there Newton's step is still one from close by.
  return std::min({wanted, 0.5 * allowed_past(end), 0.05 * dt * std::abs(end.rate)});
}

// By how much the interpolated motion misses the equations of motion, as a part of what a step may err: the speed that
// the missing acceleration would make.
double EventPursuit::defect_inside(double dt) {
  for (std::size_t i = 0; i < defect_.size(); ++i) defect_[i] = dt * (defect_[i] - run_.between.a()[i]);
  return run_.solver.local_error().velocity_norm(defect_);
}

// The state in `between`, at the fraction s of the step of the length `whole`, becomes its end.
bool EventPursuit::cut_at(double s, double whole) {
  if (run_.flows > 0) {
    const std::span<const double> at_end = std::span<const double>(run_.trial.z()).last(at(run_.flows));
    if (!run_.energy.integrate_to(s, whole, run_.e_between, run_.between.lambda(), run_.e_trial, run_.trial.lambda(),
                                  at_end, std::span(run_.between.z()).last(at(run_.flows)))) {
      return false;
    }
  }
  std::swap(run_.trial, run_.between);
  swap(run_.e_trial, run_.e_between);
  run_.inner.forget();
  return run_.ended_inside = true;
}

// The interpolated motion errs by less than the step may, and its constraints are made to hold. Not where joints have
// variables of their own, which are known less well inside.
bool EventPursuit::end_inside(const StepEvents::Passage& hunted, double dt, int hunts, double longest) {
  const double whole = run_.trial.t() - run_.accepted.t(), last = std::min(longest, little_beyond * whole);
  if (hunted.joint < 0 || hunts >= early_hunts || !(dt < last) || run_.system.layout().nz() > 0) return false;
  if (run_.solver.regularity() < near_singular) return false;
  const Profile::Timer timer(run_.evaluations.profile, Phase::events);
  const DenseStep motion(run_.model.space, run_.accepted, run_.e_accepted->internal_rate, run_.trial,
                         run_.e_trial->internal_rate);
  StepEvents::Passage end = hunted;
  double at_event = dt;
  for (int look = 0; look < early_hunts; ++look) {
    motion.at(at_event / whole, run_.between);
    std::ranges::copy(run_.between.a(), defect_.begin());
    std::ranges::copy(run_.accepted.h(), run_.between.h().begin());
    if (!attempt_.begin_steps(at_event, run_.between) || !inside_.settle_between()) return false;
    if (!(defect_inside(at_event) <= largest_defect)) return false;
    Fault fault;
    if (!attempt_.evaluate_all(run_.between, run_.e_between) ||
        !run_.events.at_end(run_.between, run_.e_between, end, fault)) {
      return false;
    }
    if (end.value >= 0.0 && end.value <= allowed_past(end) && is_sharp(end)) return cut_at(at_event / whole, whole);
    const double change = (end.value - aim_past(end, at_event)) / end.rate;
    if (!(end.rate > 0.0) || !(std::abs(change) < 0.1 * at_event) || !(at_event - change < last)) return false;
    if (at_event - change == at_event) return false;
    at_event -= change;
  }
  return false;
}

}  // namespace freeplay
