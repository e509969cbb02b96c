// Corners of inputs. Runs with error control end a step just before one. Where a ramp of smooth() begins or ends they
// go on; where a load jumps they start again just behind it, and also where a motion that a driver prescribes has a
// kink: a jump of its acceleration is legal, a jump of its speed is a blow.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/index.h"
#include "run/simulation_impl.h"

namespace freeplay {
namespace {

constexpr double smallest_jump = 1e-9;   // of a speed, in parts of the larger one
constexpr double most_lengthened = 4.0;  // steps that go round a singular position are longer than asked for

// Around a kink at t the side is one of rounding.
double margin(double t) { return 4.0 * std::numeric_limits<double>::epsilon() * std::abs(t); }

}  // namespace

// The next corner that a step of the length dt, or a few times that, can end before.
bool Simulation::Impl::next_corner(double dt, double& corner) {
  Fault fault;
  const double until = accepted.t() + most_lengthened * dt;
  const auto next = [&](double t) {
    if (inputs) return inputs->next_corner(t, until, corner, fault);
    corner = kinks.next(t, until);
    return true;
  };
  bool good = next(accepted.t());
  while (good && std::isfinite(corner) && corner - margin(corner) <= accepted.t()) good = next(corner);
  return good || fail_with(fault, accepted.t());
}

// Shortens a step of the length dt from the accepted state that does not resolve what depends on time.
bool Simulation::Impl::resolve_inputs(double& dt) {
  if (!inputs) return true;
  dt = inputs->resolved(accepted.t(), dt);
  if (!inputs->watches_joints()) return true;
  const Profile::Timer timer(system.profile(), Phase::joints);
  Fault fault;
  return inputs->resolved_by_joints(point(accepted), e_accepted, accepted.t(), dt, fault) ||
         fail_with(fault, accepted.t());
}

// The same for joints where the step of the length dt that was just made has brought them.
bool Simulation::Impl::resolves_joints(double& dt) {
  if (!inputs || !inputs->watches_joints()) return true;
  const Profile::Timer timer(system.profile(), Phase::joints);
  Fault fault;
  return inputs->resolved_by_joints(point(trial), e_trial, accepted.t(), dt, fault) || fail_with(fault, trial.t());
}

// Whether an effort or a force is another one behind the corner.
bool Simulation::Impl::loads_jump(double corner) {
  const double before = corner - margin(corner), behind = corner + margin(corner);
  const auto jumps = [&](double from, double to, double rates) {
    return std::abs(to - from) > smallest_jump * std::max(std::abs(from), std::abs(to)) + 4.0 * margin(corner) * rates;
  };
  MotionFault fault;
  if (!system.motions().evaluate(before, {motion_before.data(), motion_before.size()}, fault) ||
      !system.motions().evaluate(behind, {motion_behind.data(), motion_behind.size()}, fault)) {
    return true;  // the run will meet it
  }
  for (std::size_t d = 0; d < model.drivers.size(); ++d) {
    if (prescribes(model.drivers[d].kind)) continue;
    const TimeValue &from = motion_before[d], &to = motion_behind[d];
    if (jumps(from.value, to.value, std::abs(from.rate) + std::abs(to.rate))) return true;
  }
  for (const AppliedForce& force : model.forces) {
    for (const Expression& component : force.value) {
      Jet from, to;
      EvaluationFailure failure;
      if (!component.evaluate(before, from, failure) || !component.evaluate(behind, to, failure)) return true;
      if (jumps(from.value, to.value, std::abs(from.rate) + std::abs(to.rate))) return true;
    }
  }
  return false;
}

double Simulation::Impl::before(double kink) { return kink - margin(kink); }

// From just before `kink` to just behind it, and behind others that rounding cannot tell from it. Positions stay, the
// velocities follow the drivers by the least impulse.
bool Simulation::Impl::pass_kink(double kink) {
  if (corner_kind == CornerKind::smooth || (corner_kind == CornerKind::load && !loads_jump(kink))) {
    accepted.t() = kink;
    return true;
  }
  note_jumps(kink);
  for (double next = kink; next - kink <= margin(kink); next = kinks.next(next, kink + margin(kink))) {
    accepted.t() = next + margin(next);
  }
  note_driven(e_accepted);
  StateView view = accepted.view();
  solver.use_history(accepted.h());
  const bool good = solver.project_velocity(view);
  if (!good || !evaluate_all(accepted, e_accepted)) {
    const Fault& fault = good ? e_accepted->fault : solver.fault();
    if (fault.kind != Fault::Kind::none) return fail_with(fault, kink);
    return fail(4, fmt::format("t = {:.9g} s: {}", kink, solver.trouble()));
  }
  if (const int jumping = row_that_jumps(); jumping >= 0) {
    return fail(4, fmt::format("t = {:.9g} s: {}: the prescribed position jumps; no motion follows it", kink,
                               row_name(jumping)));
  }
  std::ranges::copy(solver.impulse(), impulses.begin());
  book_impulses(e_accepted);
  if (!refresh()) return false;
  accepted.t() = kink;
  return true;
}

// Where drivers and driven bodies are, to be compared with how they go on.
void Simulation::Impl::note_driven(const Evaluation& e) {
  std::ranges::copy(e.motion, motion_before.begin());
  std::ranges::copy(e.q, q_before.begin());
  std::ranges::copy(e.v, v_before.begin());
}

// A row that holds a driven body which is elsewhere behind a kink, or that does not hold any more; -1: none.
int Simulation::Impl::row_that_jumps() const {
  const double allowed_gap = 1e-9 * system.size();
  for (std::size_t i = accepted.q().size(); i < q_before.size(); ++i) {
    const std::size_t driven = (i - accepted.q().size()) / 3;
    if (std::abs(e_accepted->q[i] - q_before[i]) > allowed_gap) return system.row_of_driven(driven);
  }
  for (std::size_t r = 0; r < e_accepted->phi.size(); ++r) {
    if (std::abs(e_accepted->phi[r]) > allowed_gap) return static_cast<int>(r);
  }
  return -1;
}

// The work of `impulses` in rows of unknowns, and of those that changed the velocities of driven bodies to those in
// `behind`. At rows that do not move by themselves an impulse does no work.
void Simulation::Impl::book_impulses(Evaluation& behind) {
  const std::size_t first = accepted.v().size();
  for (std::size_t i = 0; i < driven_change.size(); ++i) driven_change[i] = behind.v[first + i] - v_before[first + i];
  system.recover_impulses(behind, driven_change, impulses);
  for (int d = 0; d < static_cast<int>(model.drivers.size()); ++d) {
    const int r = system.layout().driver_row(d);
    if (r < 0) continue;
    const double work = -impulses[at(r)] * 0.5 * (motion_before[at(d)].rate + behind.motion[at(d)].rate);
    energy.add_driver_work(d, work);
    if (flows > 0) accepted.z().last(at(flows))[at(d)] += work;
  }
}

// Of a step of fixed size that went over a kink: the work of the blow on driven bodies. That on others is part of the
// step.
void Simulation::Impl::book_jump(double kink) {
  Point here = point(accepted);
  const auto look = [&](double t) {
    here.t = t;
    return system.evaluate(here, term_position, e_between);
  };
  if (!look(kink - margin(kink))) return;
  note_driven(e_between);
  if (!look(kink + margin(kink))) return;
  std::ranges::fill(impulses, 0.0);
  book_impulses(e_between);
}

// Whether the speed of a driver jumps.
bool Simulation::Impl::note_jumps(double kink) {
  MotionFault fault;
  if (!system.motions().evaluate(kink - margin(kink), {motion_before.data(), motion_before.size()}, fault) ||
      !system.motions().evaluate(kink + margin(kink), {motion_behind.data(), motion_behind.size()}, fault)) {
    return false;  // the run will meet it
  }
  bool any = false;
  for (std::size_t d = 0; d < speed_jumps.size(); ++d) {
    if (system.layout().driver_row(static_cast<int>(d)) < 0) continue;
    const double from = motion_before[d].rate, to = motion_behind[d].rate;
    const double steady = std::abs(motion_before[d].acceleration) + std::abs(motion_behind[d].acceleration);
    if (std::abs(to - from) <= smallest_jump * std::max(std::abs(from), std::abs(to)) + 4.0 * margin(kink) * steady) {
      continue;
    }
    any = true;
    if (speed_jumps[d].count++ == 0) speed_jumps[d] = {1, kink, from, to};
  }
  return any;
}

// Of runs in steps of one size: inputs that do more inside a step than it can see.
void Simulation::Impl::format_unresolved() {
  if (adaptive) return;
  const double step = std::min(settings.step, settings.interval);
  for (const InputActivity::Unresolved& input : InputActivity(system, settings.interval, 0.0).closer_than(step)) {
    warnings.push_back(fmt::format(
        "{} '{}': it has corners at {:.9g} s and {:.9g} s, closer than the step of {:.3g} s, which goes over what it "
        "does between them; ask for an accuracy instead, or for steps of {:.2g} s",
        input.section, *input.name, input.from, input.to, step, 0.1 * (input.to - input.from)));
    const std::string element = fmt::format("{} '{}'", input.section, *input.name);
    outcome.doubts.push_back({.id = "unresolved-input",
                              .level = Trust::doubtful,
                              .message = fmt::format("{} has corners {:.3g} s apart, closer than the step of {:.3g} s",
                                                     element, input.to - input.from, step),
                              .element = element,
                              .value = input.to - input.from,
                              .limit = step});
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
