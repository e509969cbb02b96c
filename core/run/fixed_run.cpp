// Simulation: runs in fixed steps.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "run/dense_step.h"
#include "run/simulation_impl.h"

namespace freeplay {
namespace {
constexpr double smallest_step = 1e-3;  // of the step asked for
constexpr double near_corner = 1e-9;    // of it: so near a corner is at its end
}  // namespace

// Corners of inputs from the accepted state to `until`, as far as there is room for them.
void Simulation::Impl::list_corners(double until) {
  corners.clear();
  corners_from = accepted.t();
  corners_near = std::max(8.0 * rounding * std::abs(until), near_corner * settings.step);
  const auto add = [&](DriveKinks& of, bool motion) {
    double corner = of.next(accepted.t(), until + corners_near);
    while (corner <= until + corners_near && corners.size() < corners.capacity()) {
      corners.push_back({corner, motion});
      corner = of.next(corner, until + corners_near);
    }
  };
  add(kinks, true);
  add(load_kinks, false);
  std::ranges::sort(corners, {}, &StepCorner::time);
}

// The last of them that is at t but for rounding; infinite: none.
double Simulation::Impl::corner_at(double t) const {
  double found = unbounded;
  for (const StepCorner& corner : corners) {
    if (std::abs(corner.time - t) <= corners_near) found = corner.time;
  }
  return found;
}

// Forces may be others after a corner at the end of the step that was just made.
bool Simulation::Impl::begin_after(double corner) {
  const double t = accepted.t();
  accepted.t() = std::max(t, corner + corners_near);
  const bool good = refresh();
  accepted.t() = t;
  return good;
}

// Powers at t, in the step that was just made or a little beyond its end, with the forces that act at that very time.
bool Simulation::Impl::flow_inside(double t, std::span<double> powers) {
  const double s = (t - accepted.t()) / (trial.t() - accepted.t());
  DenseStep(system, accepted, e_accepted->internal_rate, trial, e_trial->internal_rate).at(std::min(s, 1.0), between);
  std::ranges::copy(trial.h(), between.h().begin());  // as the attempt had it
  between.t() = t;
  StateView view = between.view();
  solver.use_history(between.h());
  if (!solver.accelerate(view, {z_rate.data(), z_rate.size()})) return false;
  if (!system.evaluate(point(between), of_equations, e_between)) return false;
  system.fill_driven_jacobian(e_between);
  system.recover_loads(e_between, between.lambda());
  energy.flow(e_between, between.lambda(), powers);
  return true;
}

// Of a step with corners of inputs in it or at its end, where forces may jump: each part between two of them has its
// own powers. False, and nothing is done, where there is none.
bool Simulation::Impl::add_energy_by_parts() {
  const double from = accepted.t(), to = trial.t(), near = corners_near;
  const auto inside = [&](const StepCorner& corner) { return corner.time > from + near && corner.time <= to + near; };
  if (std::ranges::none_of(corners, inside)) return false;
  energy.begin_parts();
  double begin = from;
  const auto add_until = [&](double end) {
    const double length = end - begin;
    if (!(length > 4.0 * near)) return true;
    if (!flow_inside(begin + near, flow_begin) || !flow_inside(begin + 0.5 * length, flow_half_way) ||
        !flow_inside(end - near, flow_end)) {
      return false;
    }
    energy.add_part(length, flow_begin, flow_half_way, flow_end);
    begin = end;
    return true;
  };
  for (const StepCorner& corner : corners) {
    if (inside(corner) && !add_until(corner.time)) return false;
  }
  if (!add_until(to)) return false;
  energy.take_parts(to - from, e_trial, trial.lambda());
  energy.renew(e_trial, trial.lambda());
  return true;
}

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
      if (corners_from != accepted.t()) list_corners(goal);
      const double end = last ? goal : accepted.t() + dt, corner = corner_at(end);
      // The step that ends at a corner has the forces before it to its end.
      const bool to_corner = corner < unbounded;
      bool converged = false;
      if (!step(to_corner ? corner - corners_near - accepted.t() : dt, converged)) return false;
      if (!converged) {
        if (!resting.stayed()) continue;
        ++outcome.rejected;
        dt *= 0.5;
        if (dt < smallest && plugin_fault.kind == Fault::Kind::plugin) return fail_with(plugin_fault, accepted.t());
        if (dt < smallest) return fail(4, why_not_converged(dt));
        continue;
      }
      if (last || to_corner) trial.t() = end;
      if (!evaluate_all(trial, e_trial)) return fail_with(e_trial->fault, trial.t());
      if (!resting.held(dt, e_trial)) continue;
      if (gains_energy()) {
        ++outcome.rejected;
        dt *= 0.5;
        if (dt < smallest) return fail(4, why_energy_grows(dt));
        continue;
      }
      for (const auto& [kink, of_motion] : corners) {
        if (of_motion && kink <= trial.t() && note_jumps(kink)) book_jump(kink);
      }
      ends_at_corner = corner;
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
