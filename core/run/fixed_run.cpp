#include "run/fixed_run.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/index.h"

namespace freeplay {
namespace {
constexpr double smallest_step = 1e-3;     // of the step asked for
constexpr double most_turn_of_step = 2.5;  // of a joint in one step [rad]: angles are continued over half turns

long steps_between(double from, double to, double step) {
  return std::max(1L, std::lround(std::ceil((to - from) / step - 1e-6)));
}
}  // namespace

FixedRun::FixedRun(const RunParts& parts, StepCorners& step_corners)
    : parts_(parts), run_(parts.run), step_corners_(step_corners) {
  for (int j = 0; j < run_.system.joints().count(); ++j) {
    if (run_.system.layout().turn(j) >= 0) turning_.push_back(at(j));
  }
}

// The way to the next output instant.
bool FixedRun::begin_leg() {
  const double from = run_.accepted.t(), target = parts_.recorder.take_next_row();
  // Beyond this the time itself could not be advanced: t + dt would round to t.
  if (!((target - from) / run_.settings.step < 1e15)) {
    return parts_.failure.fail(
        4, fmt::format("t = {:.9g} s: a step of {:.3g} s is too small to advance the time", from, run_.settings.step));
  }
  leg_ = {.from = from,
          .target = target,
          .goal = from,
          .count = steps_between(from, target, run_.settings.step),
          .steps_before = run_.outcome.steps};
  return true;
}

// A blow inside the step does work.
[[gnu::always_inline]] inline bool FixedRun::accept(double corner) {
  for (const auto& [kink, of_motion] : step_corners_.all()) {
    if (of_motion && kink <= run_.trial.t() && !step_corners_.is_last(kink) && parts_.corners.note_jumps(kink))
      parts_.corners.book_jump(kink);
  }
  parts_.motion_loads.note();
  const bool has_energy = !step_corners_.all().empty() && step_corners_.add_energy();
  return parts_.acceptance.accept({.corner = corner, .has_energy = has_energy});
}

// One accepted step. An attempt that does not converge is made again in half its length, and the rest of the step of
// full size follows in steps as short. A step that would go over `until` ends there, and others of full size follow.
bool FixedRun::step(double until) {
  // Output instants may be closer than times can separate.
  if (!(run_.accepted.t() < leg_.target)) return true;
  const double smallest = smallest_step * run_.settings.step;
  if (!(run_.accepted.t() < leg_.goal)) {
    ++leg_.step;
    leg_.goal = leg_.step == leg_.count ? leg_.target : leg_.from + static_cast<double>(leg_.step) * run_.settings.step;
    leg_.dt = leg_.goal - run_.accepted.t();
  }
  if (until < leg_.goal) {
    leg_.from = leg_.goal = until;
    leg_.count = steps_between(until, leg_.target, run_.settings.step);
    leg_.step = 0;
    leg_.dt = std::min(leg_.dt, until - run_.accepted.t());
  }
  double& dt = leg_.dt;
  // What turns faster still is far from any machine, and ends the run by other criteria.
  for (const double fastest = fastest_turn(); fastest * dt > most_turn_of_step && dt > 2.0 * smallest;) dt *= 0.5;
  for (;;) {
    const bool last = run_.accepted.t() + dt >= leg_.goal - 0.5 * smallest;
    if (last) dt = leg_.goal - run_.accepted.t();
    if (step_corners_.any()) step_corners_.list(leg_.goal);
    const double end = last ? leg_.goal : run_.accepted.t() + dt, corner = step_corners_.at(end);
    if (meets_jump(end)) return false;
    // The step that ends at a corner has the forces before it to its end.
    const bool to_corner = corner < unbounded;
    bool converged = false;
    if (!parts_.attempt.make(to_corner ? step_corners_.before(corner) - run_.accepted.t() : dt, converged))
      return false;
    if (!converged) {
      if (!run_.sleeping.stayed()) continue;
      ++run_.outcome.rejected;
      dt *= 0.5;
      if (dt < smallest && run_.plugin_fault.kind != Fault::Kind::none)
        return parts_.failure.fail_with(run_.plugin_fault, run_.accepted.t());
      if (dt < smallest) return parts_.failure.fail(4, parts_.failure.why_not_converged(dt));
      continue;
    }
    const bool run_ends = to_corner && step_corners_.is_last(corner);
    if (last || to_corner) run_.trial.t() = run_ends ? step_corners_.before(corner) : end;
    if (!parts_.attempt.evaluate_all(run_.trial, run_.e_trial))
      return parts_.failure.fail_with(run_.e_trial->fault, run_.trial.t());
    run_.trial.t() = last || to_corner ? end : run_.trial.t();
    if (!run_.sleeping.held(dt, run_.e_trial)) continue;
    if (parts_.growth.too_large()) {
      ++run_.outcome.rejected;
      dt *= 0.5;
      if (dt < smallest) return parts_.failure.fail(4, parts_.failure.why_energy_grows(dt, parts_.growth.gained()));
      continue;
    }
    return accept(run_ends ? unbounded : corner);
  }
}

// Of a prescribed position, before a time or at it.
bool FixedRun::meets_jump(double end) {
  return std::ranges::any_of(step_corners_.all(), [&](const StepCorners::Corner& corner) {
    const bool inside = corner.of_motion && corner.time > run_.accepted.t() && step_corners_.before(corner.time) <= end;
    return inside && !step_corners_.is_last(corner.time) && parts_.corners.stops_at_jump(corner.time);
  });
}

// Of a joint whose turns are counted [rad/s].
double FixedRun::fastest_turn() const {
  double fastest = 0.0;
  for (const std::size_t j : turning_) {
    const double rate = std::abs(run_.e_accepted->coordinate_rate[j]);
    if (std::isfinite(rate)) fastest = std::max(fastest, rate);
  }
  return fastest;
}

bool FixedRun::advance(const RunHooks& hooks, const RunGoal& goal) {
  const long steps = run_.outcome.steps;
  long rows = 0;
  while (run_.accepted.t() < run_.settings.end) {
    if (!(run_.accepted.t() < goal.until) || rows >= goal.rows || run_.outcome.steps - steps >= goal.steps) return true;
    if (!(run_.accepted.t() < leg_.target) && !begin_leg()) return false;
    const bool going = step(goal.until) && parts_.stop.go_on();
    const bool arrived = going && !(run_.accepted.t() < leg_.target);
    // A run that was stopped keeps the state it stopped in.
    if ((arrived || (!going && run_.outcome.steps > leg_.steps_before)) && !parts_.recorder.write_row()) return false;
    if (!going) return false;
    rows += arrived ? 1 : 0;
    if (hooks.stepped) hooks.stepped();
    if (parts_.end.check_interrupt(hooks)) continue;
    parts_.recorder.know_row();  // of the summary; rows stay those of the whole run
    return false;
  }
  return false;
}

}  // namespace freeplay
