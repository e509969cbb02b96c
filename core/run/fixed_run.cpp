// Simulation: runs in fixed steps.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "run/simulation_impl.h"

namespace freeplay {
namespace {
constexpr double smallest_step = 1e-3;  // of the step asked for
}  // namespace

// Fixed steps to an output instant. A step that does not converge is halved and resumed.
bool Simulation::Impl::advance_to(double target, const RunHooks& hooks) {
  const double from = accepted.t(), size = settings.step;
  const double smallest = smallest_step * size;
  // Beyond this the time itself could not be advanced: t + dt would round to t.
  if (!((target - from) / size < 1e15)) {
    return fail(4, fmt::format("t = {:.9g} s: a step of {:.3g} s is too small to advance the time", from, size));
  }
  const long count = std::max(1L, std::lround(std::ceil((target - from) / size - 1e-6)));
  for (long i = 1; i <= count; ++i) {
    const double goal = i == count ? target : from + static_cast<double>(i) * size;
    double dt = goal - accepted.t();
    while (accepted.t() < goal) {
      const bool last = accepted.t() + dt >= goal - 0.5 * smallest;
      if (last) dt = goal - accepted.t();
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
      if (last) trial.t() = goal;
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
      if (!accept({}) || !check_stop() || !check_interrupt(hooks)) return false;
    }
  }
  return true;
}

bool Simulation::Impl::run_fixed(const RunHooks& hooks) {
  while (accepted.t() < settings.end) {
    const long before = outcome.steps;
    const bool going = advance_to(row_time(next_row++), hooks);
    // A run that was stopped keeps the state it stopped in.
    if ((going || outcome.steps > before) && !write_row()) return false;
    if (!going) return false;
  }
  return true;
}

}  // namespace freeplay
