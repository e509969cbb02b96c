// Simulation: runs in fixed steps.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "run/simulation_impl.h"

namespace freeplay {
namespace {
constexpr double smallest_step = 1e-3;  // of the step asked for
}  // namespace

// The way to the next output instant.
bool Simulation::Impl::begin_leg() {
  const double from = accepted.t(), target = row_time(next_row++);
  // Beyond this the time itself could not be advanced: t + dt would round to t.
  if (!((target - from) / settings.step < 1e15)) {
    return fail(4, fmt::format("t = {:.9g} s: a step of {:.3g} s is too small to advance the time", from,
                               settings.step));
  }
  const long count = std::max(1L, std::lround(std::ceil((target - from) / settings.step - 1e-6)));
  leg = {.from = from, .target = target, .goal = from, .count = count, .steps_before = outcome.steps};
  return true;
}

// One accepted step. An attempt that does not converge is made again in half its length, and the rest of the step of
// full size follows in steps as short.
bool Simulation::Impl::fixed_step() {
  // Output instants may be closer than times can tell apart.
  if (!(accepted.t() < leg.target)) return true;
  const double smallest = smallest_step * settings.step;
  if (!(accepted.t() < leg.goal)) {
    ++leg.step;
    leg.goal = leg.step == leg.count ? leg.target : leg.from + static_cast<double>(leg.step) * settings.step;
    leg.dt = leg.goal - accepted.t();
  }
  double& dt = leg.dt;
  for (;;) {
    const bool last = accepted.t() + dt >= leg.goal - 0.5 * smallest;
    if (last) dt = leg.goal - accepted.t();
    bool converged = false;
    if (!step(dt, converged)) return false;
    if (!converged) {
      if (!resting.stayed()) continue;
      ++outcome.rejected;
      dt *= 0.5;
      if (dt < smallest && plugin_fault.kind == Fault::Kind::plugin) return fail_with(plugin_fault, accepted.t());
      if (dt < smallest) return fail(4, why_not_converged(dt));
      continue;
    }
    if (last) trial.t() = leg.goal;
    if (!evaluate_all(trial, e_trial)) return fail_with(e_trial->fault, trial.t());
    if (!resting.held(dt, e_trial)) continue;
    if (gains_energy()) {
      ++outcome.rejected;
      dt *= 0.5;
      if (dt < smallest) return fail(4, why_energy_grows(dt));
      continue;
    }
    for (double kink = kinks.next(accepted.t(), trial.t()); kink <= trial.t(); kink = kinks.next(kink, trial.t())) {
      if (note_jumps(kink)) book_jump(kink);
    }
    return accept({});
  }
}

bool Simulation::Impl::run_fixed(const RunHooks& hooks) {
  while (accepted.t() < settings.end) {
    if (!(accepted.t() < leg.target) && !begin_leg()) return false;
    const bool going = fixed_step() && check_stop();
    const bool arrived = going && !(accepted.t() < leg.target);
    // A run that was stopped keeps the state it stopped in.
    if ((arrived || (!going && outcome.steps > leg.steps_before)) && !write_row()) return false;
    if (!going) return false;
    if (hooks.stepped) hooks.stepped();
    if (!check_interrupt(hooks)) return !arrived && write_row();
  }
  return true;
}

}  // namespace freeplay
