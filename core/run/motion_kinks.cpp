// Instants at which a motion that a driver prescribes has a kink. Runs with error control end a step just before one
// and start again just behind it: a jump of the acceleration is legal, a jump of the speed is a blow.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "run/simulation_impl.h"

namespace freeplay {
namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }
constexpr double smallest_jump = 1e-9;  // of a speed, in parts of the larger one

// Around a kink at t the side is one of rounding.
double margin(double t) { return 4.0 * std::numeric_limits<double>::epsilon() * std::abs(t); }

}  // namespace

// The next kink that a step can end before.
double Simulation::Impl::next_kink() const {
  double kink = system.motions().next_kink(accepted.t());
  while (std::isfinite(kink) && kink - margin(kink) <= accepted.t()) kink = system.motions().next_kink(kink);
  return kink;
}

double Simulation::Impl::before(double kink) { return kink - margin(kink); }

// From just before `kink` to just behind it, and behind others that rounding cannot tell from it. Positions stay, the
// velocities follow the drivers by the least impulse.
bool Simulation::Impl::pass_kink(double kink) {
  note_jumps(kink);
  for (double next = kink; next - kink <= margin(kink); next = system.motions().next_kink(next)) {
    accepted.t() = next + margin(next);
  }
  std::ranges::copy(e_accepted.nu, residual.begin());
  StateView view = accepted.view();
  solver.use_history(accepted.h());
  const bool good = solver.project_velocity(view);
  if (!good || !system.evaluate(point(accepted), all_terms, e_accepted)) {
    const Fault& fault = good ? e_accepted.fault : solver.fault();
    if (fault.kind != Fault::Kind::none) return fail_with(fault, kink);
    return fail(4, fmt::format("t = {:.9g} s: {}", kink, solver.trouble()));
  }
  for (std::size_t r = 0; r < e_accepted.phi.size(); ++r) {
    if (std::abs(e_accepted.phi[r]) <= 1e-9 * system.size()) continue;
    return fail(4, fmt::format("t = {:.9g} s: {}: the prescribed position jumps; no motion follows it", kink,
                               row_name(static_cast<int>(r))));
  }
  // At rows that do not move by themselves the impulse does no work.
  for (int d = 0; d < static_cast<int>(model.drivers.size()); ++d) {
    const int r = system.layout().driver_row(d);
    if (r < 0) continue;
    const double work = -solver.impulse()[at(r)] * 0.5 * (residual[at(r)] + e_accepted.nu[at(r)]);
    energy.add_driver_work(d, work);
    if (flows > 0) accepted.z().last(at(flows))[at(d)] += work;
  }
  if (!refresh()) return false;
  accepted.t() = kink;
  return true;
}

void Simulation::Impl::note_jumps(double kink) {
  MotionFault fault;
  if (!system.motions().evaluate(kink - margin(kink), {motion_before.data(), motion_before.size()}, fault) ||
      !system.motions().evaluate(kink + margin(kink), {motion_behind.data(), motion_behind.size()}, fault)) {
    return;  // the run will meet it
  }
  for (std::size_t d = 0; d < speed_jumps.size(); ++d) {
    if (system.layout().driver_row(static_cast<int>(d)) < 0) continue;
    const double from = motion_before[d].rate, to = motion_behind[d].rate;
    const double steady = std::abs(motion_before[d].acceleration) + std::abs(motion_behind[d].acceleration);
    if (std::abs(to - from) <= smallest_jump * std::max(std::abs(from), std::abs(to)) + 4.0 * margin(kink) * steady) {
      continue;
    }
    if (speed_jumps[d].count++ == 0) speed_jumps[d] = {1, kink, from, to};
  }
}

void Simulation::Impl::format_jumps() {
  for (std::size_t d = 0; d < speed_jumps.size(); ++d) {
    const SpeedJump& jump = speed_jumps[d];
    if (jump.count == 0) continue;
    const Driver& driver = model.drivers[d];
    const bool angle = system.joint_layout(driver.joint).coordinate == Coordinate::angle;
    std::string text =
        fmt::format("driver '{}' at t = {:.9g} s: the speed that it prescribes jumps from {:.4g} to {:.4g} {}",
                    driver.name, jump.time, jump.from, jump.to, angle ? "rad/s" : "m/s");
    if (jump.count > 1) text += fmt::format(", the first of {} jumps", jump.count);
    warnings.push_back(
        text + (adaptive ? ": taken as a blow, whose work is booked and whose force is not in the results"
                         : ": a blow, of which a step of this size makes a large force; ask for an accuracy instead"));
  }
}

}  // namespace freeplay
