// Steps with error control: every located event ends a step, output rows are taken from inside the steps.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "base/index.h"
#include "run/simulation_impl.h"

namespace freeplay {
namespace {

constexpr int order_by_ends = 5;           // of a method whose steps are known as well inside by their ends
constexpr double unnoticed_inside = 1e-2;  // part of what a step may err by, by which its inside may change
constexpr double astray_inside = 1.0;      // and by which its ends may mislead: no more than a step may err by
constexpr int most_sweeps = 3;
constexpr double most_growth = 2.0;     // of changes from sweep to sweep: more is a stiff force, less may be rounding
constexpr double beside_a_root = 1.5;   // power of the step with which errors fall there
constexpr double least_allowed = 64.0;  // roundings of positions and, per second, of velocities
constexpr double largest_turn = 1.0;    // of a joint in one step [rad]: angles are continued over turns
constexpr double barely = 1.0 - 1e-6;   // of a step: what is shorter by the rounding of times alone is as long

// Close to a singular position of the constraints a stage loses what its distance is in rounding, and its error falls
// too slowly with the step: shorter and shorter steps would lead into the very position. The motion itself is smooth
// there, so that a step of another length, which looks elsewhere, goes over it. By regularity():
constexpr double at_singular = 1e-8;  // a step that passed, too
constexpr double stuck_there = 1e-4;  // steps that fall for ever have come to it
constexpr double hopeless = 1e-12;    // the way that the mechanism takes on would be one of rounding
constexpr double detour_lengths[] = {0.9, 1.1, 0.8, 1.2, 0.7, 1.4, 0.6, 1.7, 0.5, 2.0, 3.0};

}  // namespace

bool Simulation::Impl::run_adaptive(const RunHooks& hooks) {
  while (accepted.t() < settings.end) {
    const long before = outcome.steps;
    const bool going = adaptive_step() && check_stop() && check_interrupt(hooks);
    const bool due = accepted.t() >= row_time(next_row);
    if (outcome.steps > before && (due || !going) && !write_row()) return false;
    if (!going) return false;
    while (row_time(next_row) <= accepted.t() && accepted.t() < settings.end) ++next_row;
  }
  return true;
}

// A step over a short load takes its error from a budget, as what it makes of the position at the end of the run. Where
// a contact acts its own errors rule, and no sum of them is one of the load.
void Simulation::Impl::allow_error() {
  if (!inputs || !(settings.accuracy > 0.0)) return;
  acts_quickly = inputs->acts_quickly(accepted.t()) && !in_contact(e_accepted);
  double in_position = allowed, in_velocity = allowed;
  if (acts_quickly) {
    const double least = std::min(allowed, least_allowed * rounding * system.size());
    const double lasting = std::max(1.0, settings.end - accepted.t());
    slope_unbounded = inputs->hides_errors(accepted.t());
    in_position = std::max(budget.share(1.0, slope_unbounded) * allowed, least);
    in_velocity = std::max(budget.share(lasting, slope_unbounded) * allowed, least);
  }
  if (in_velocity == velocity_allowed) return;
  control.allow(in_velocity / velocity_allowed);
  velocity_allowed = in_velocity;
  solver.control_error(in_position, in_velocity, 0.0);
}

bool Simulation::Impl::in_contact(const Evaluation& e) const {
  const std::span<const ForceBlock> blocks = system.force_blocks();
  for (std::size_t f = 0; f < blocks.size(); ++f) {
    if (e.acts[f] != 0 && system.joint_layout(blocks[f].joint).clearance > 0.0) return true;
  }
  return false;
}

// The proposal of the error control, no longer than any joint allows and than what is left.
bool Simulation::Impl::bounded_step(double& dt, int& limiting_joint) {
  dt = control.next();
  limiting_joint = -1;
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j) {
    if (model.joints[at(j)].gear >= 0) continue;
    const JointInput in = system.input(j, point(accepted), e_accepted);
    double limit = unbounded;
    Fault fault;
    if (!system.joint(j).step_limit(in, limit, fault.message)) {
      fault.kind = Fault::Kind::plugin;
      fault.joint = j;
      return fail_with(fault, accepted.t());
    }
    if (system.joint_layout(j).coordinate == Coordinate::angle) {
      limit = std::min(limit, largest_turn / std::abs(in.coordinate_rate));
    }
    if (limit < dt) dt = limit, limiting_joint = j;
  }
  return true;
}

bool Simulation::Impl::adaptive_step() {
  const double smallest = control.limits().smallest;
  double dt = 0.0;
  int limiting = -1;
  Fault fault;
  allow_error();
  if (!bounded_step(dt, limiting)) return false;
  if (!events.look_from(accepted, e_accepted, fault)) return fail_with(fault, accepted.t());
  if (!(dt >= smallest)) {
    return fail(4, solver.regularity() < stuck_there ? why_singular() : why_so_small(dt, limiting));
  }
  double kink = 0.0;
  if (!next_corner(dt, kink)) return false;
  const bool to_kink = kink <= settings.end;
  const double goal = to_kink ? before(kink) : settings.end;
  double reach = std::min(dt, goal - accepted.t());
  if (const double proposed = reach; !resolve_inputs(reach)) {
    return false;
  } else if (reach < proposed) {
    dt = reach;
  }
  StepEvents::Passage hunted = events.expected_within(reach);
  if (hunted.joint >= 0) dt = hunted.fraction * reach;
  std::size_t detours = 0;
  double asked = 0.0;
  for (int hunts = 0;;) {
    const double left = goal - accepted.t();
    const bool last = dt >= left * (1.0 - 1e-12);
    if (last) dt = left;
    if (!last && accepted.t() + dt == accepted.t()) return fail(4, why_so_small(dt, limiting));
    bool converged = false;
    ended_inside = false;
    if (!step(dt, converged)) return false;
    const double hidden = inputs && converged ? inputs->hidden_error(accepted.t(), dt) : 1.0;
    error *= hidden;
    const bool passed = converged && error <= 1.0;
    if (hunted.joint < 0 && take_detour(passed, detours, asked, dt)) continue;
    if (passed && solver.regularity() < hopeless) return fail(4, why_singular());
    if (!passed) {
      ++outcome.rejected;
      hunted = {};
      if (converged) {
        control.reject(dt, error, hidden > 1.0 ? beside_a_root : unbounded);
        dt = before_event(dt, control.next(), hunted);
      } else {
        control.halve(dt);
        dt = control.next();
      }
      if (dt >= smallest) continue;
      if (plugin_fault.kind == Fault::Kind::plugin) return fail_with(plugin_fault, accepted.t());
      if (solver.regularity() < stuck_there) return fail(4, why_singular());
      return fail(4, converged ? why_so_small(dt, -1) : why_not_converged(dt));
    }
    if (last) trial.t() = goal;
    if (!evaluate_all(trial, e_trial)) {
      return fail_with(e_trial->fault, trial.t());
    }
    if (gains_energy()) {
      ++outcome.rejected;
      hunted = {};
      control.halve(dt);
      dt = control.next();
      if (dt < smallest) return fail(4, why_energy_grows(dt));
      continue;
    }
    if (double resolved = trial.t() - accepted.t(); !resolves_joints(resolved)) {
      return false;
    } else if (resolved < barely * (trial.t() - accepted.t())) {
      ++outcome.rejected;
      hunted = {};
      dt = resolved;
      continue;
    }
    bool done = false;
    if (!pursue(hunted, dt, hunts, done)) return false;
    if (done) break;
    const double whole = trial.t() - accepted.t();
    if (end_inside(hunted, dt, hunts, left)) {
      if (trial.t() - accepted.t() <= whole) break;
      // Beyond its end another event may lie.
      if (!pursue(hunted, dt, hunts, done)) return false;
      if (done) break;
    }
    if (outcome.status == RunStatus::failed) return false;
    ++hunts;
  }
  const bool at_kink = to_kink && trial.t() == goal;
  corner_kind = !inputs ? CornerKind::motion : at_kink ? inputs->kind_of(kink, kink - goal) : CornerKind::smooth;
  if (acts_quickly) budget.spend(error, slope_unbounded);
  budget.pass(trial.t() - accepted.t());
  if (at_kink && corner_kind == CornerKind::motion) {
    control.restart();
  } else if (hunted.joint < 0) {
    control.accept(trial.t() - accepted.t(), error);
  }
  if (!accept(hunted, at_kink ? kink : unbounded)) return false;
  // Forces that begin or end at an event do so once it is told.
  if (hunted.joint >= 0 && !at_kink) control.cut(e_accepted->acting);
  return true;
}

// Whether to try another length of the step that was just made, and back to the one `asked` for after all of them.
bool Simulation::Impl::take_detour(bool passed, std::size_t& detours, double& asked, double& dt) {
  if (detours > std::size(detour_lengths)) return false;
  if (!(solver.regularity() < (passed ? at_singular : near_singular))) return false;
  if (detours == 0) asked = dt;
  dt = detours < std::size(detour_lengths) ? detour_lengths[detours] * asked : asked;
  ++detours;
  ++outcome.rejected;
  return true;
}

bool Simulation::Impl::write_rows_inside() {
  while (row_time(next_row) < trial.t()) {
    if (!write_row_at(row_time(next_row))) return false;
    ++next_row;
  }
  return true;
}

// The state in `between` with its constraints, accelerations and multipliers.
bool Simulation::Impl::settle_between() {
  StateView view = between.view();
  solver.use_history(between.h());
  solver.move_away();
  return solver.project_position(view) && solver.project_velocity(view) &&
         solver.accelerate(view, {z_rate.data(), z_rate.size()});
}

// Between its ends a step is known to the sixth order from these alone. Where that is not enough the equations of
// motion are solved at places inside, over and over, until nothing changes that would matter. Where a joint cannot be
// asked there, or changes grow as where forces are stiff against the step, the ends have to do.
void Simulation::Impl::know_inside() {
  if (inner.known()) return;
  const std::size_t joints = e_accepted->internal_rate.size();
  std::ranges::copy(e_accepted->internal_rate, start_rate.begin());
  std::ranges::copy(e_trial->internal_rate, end_rate.begin());
  if (flows > 0) {
    energy.flow(e_accepted, accepted.lambda(), std::span(start_rate).subspan(joints));
    energy.flow(e_trial, trial.lambda(), std::span(end_rate).subspan(joints));
  }
  const DenseStep by_ends(system, accepted, start_rate, trial, end_rate);
  const auto look = [&](std::size_t place) {
    const double s = InnerMotion::places[place];
    DenseStep(system, accepted, start_rate, trial, end_rate, &inner).at(s, between);
    StateView view = between.view();
    solver.use_history(between.h());
    if (!solver.accelerate(view, {z_rate.data(), z_rate.size()})) return false;
    by_ends.missing(s, between, z_rate, inner.missing(place), inner.missing_rate(place));
    return true;
  };
  const auto change = [&](std::size_t place) {
    const std::span<const double> now = inner.missing(place);
    for (std::size_t i = 0; i < now.size(); ++i) defect[i] = now[i] - std::exchange(inner_before[i], now[i]);
    return error_by_missing(0.5);
  };
  std::ranges::fill(inner_before, 0.0);
  if (!look(InnerMotion::middle)) return;
  inner.fit_middle();
  if (change(InnerMotion::middle) <= unnoticed_inside) return;
  std::ranges::fill(inner_before, 0.0);
  double last_change = unbounded;
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    bool seen = look(InnerMotion::middle);
    if (seen && sweep == 0) inner.fit_middle();
    seen = seen && look(0) && look(2);
    if (!seen) return inner.forget();
    inner.fit();
    const double now = change(0);
    if (now <= unnoticed_inside) return;
    if (!(now < most_growth * last_change)) return inner.forget();
    last_change = now;
  }
}

// Largest error of an interpolation by the ends, in units of what a step may err by, that misses `defect` of the second
// derivative by s of increments at the fraction s: as u^3 with u = s (1 - s), of which no more than 1/64 and, by s,
// 0.054 come together. `defect` is lost.
double Simulation::Impl::error_by_missing(double s) {
  const double dt = trial.t() - accepted.t();
  const double bend = std::max(std::abs(InnerMotion::Weights(s).acceleration[0]), 0.05);
  for (std::size_t i = 0; i < defect.size(); ++i) {
    rate_defect[i] = 0.054 / (bend * dt) * defect[i];
    defect[i] *= 1.0 / (64.0 * bend);
  }
  return solver.error_norm(defect, rate_defect);
}

// A consistent state inside the step that was just made, in `between`.
bool Simulation::Impl::settle_inside(double t) {
  const double s = (t - accepted.t()) / (trial.t() - accepted.t());
  if (inner.known()) {
    DenseStep(system, accepted, start_rate, trial, end_rate, &inner).at(s, between);
  } else {
    DenseStep(system, accepted, e_accepted->internal_rate, trial, e_trial->internal_rate).at(s, between);
  }
  between.t() = t;
  if (settle_between()) return true;
  if (solver.fault().kind != Fault::Kind::none) return fail_with(solver.fault(), t);
  return fail(4, fmt::format("t = {:.9g} s: {}", t, solver.trouble()));
}

// The same in e_between as well, as good as the ends of the step are.
bool Simulation::Impl::look_inside(double t) {
  if (integrator_layout.order > order_by_ends) know_inside();
  if (!settle_inside(t)) return false;
  if (!inner.known()) {
    const double s = (t - accepted.t()) / (trial.t() - accepted.t());
    // How far the ends alone lead astray, their own accelerations say.
    DenseStep(system, accepted, e_accepted->internal_rate, trial, e_trial->internal_rate)
        .missing(s, between, {}, defect, {});
    if (!(error_by_missing(s) <= astray_inside)) {
      know_inside();
      if (!settle_inside(t)) return false;
    }
  }
  if (!evaluate_all(between, e_between)) return fail_with(e_between->fault, t);
  return true;
}

bool Simulation::Impl::write_row_at(double t) {
  const Profile::Timer timer(system.profile(), Phase::output);
  if (!look_inside(t)) return false;
  Fault fault;
  if (!observer.observe(point(between), e_between, between.lambda(), row_between, fault)) return fail_with(fault, t);
  const double s = (t - accepted.t()) / (trial.t() - accepted.t());
  if (flows > 0 && inner.known()) {
    const std::span<const double> integrals = std::span<const double>(between.z()).last(at(flows));
    energy.fill_inside(s, e_between, between.lambda(), integrals, channels, row_between);
  } else {
    energy.fill_inside(s, e_between, between.lambda(), channels, row_between);
  }
  ++outcome.rows;
  statistics.note_written(row_between);
  for (Sink* sink : sinks) sink->row(row_between);
  return sinks_are_well();
}

std::string Simulation::Impl::why_singular() {
  std::string text = fmt::format(
      "t = {:.9g} s: the mechanism comes to a singular position, as of links in line: it cannot go on, or rounding "
      "hides how",
      accepted.t());
  if (const std::string worst = row_name(solver.weakest_row()); !worst.empty()) {
    text += "; first to depend on the other constraints is " + worst;
  }
  return text + std::string(advice::other_steps);
}

std::string Simulation::Impl::why_so_small(double dt, int limiting_joint) const {
  std::string text = fmt::format("t = {:.9g} s: a step of {:.3g} s is needed, the smallest allowed is {:.3g} s",
                                 accepted.t(), dt, control.limits().smallest);
  if (limiting_joint >= 0) return text + fmt::format("; joint '{}' asks for it", model.joints[at(limiting_joint)].name);
  const int worst = solver.local_error().worst_component();
  if (worst < 0) return text;
  const int width = system.body_velocities(), part = worst % width;
  const BodyId body = system.layout().body_at(worst / width);
  constexpr const char* planar[] = {"x", "y", "angle"};
  constexpr const char* spatial[] = {"x", "y", "z", "rotation", "rotation", "rotation"};
  text += fmt::format("; the error is largest in body '{}' ({})", model.bodies[at(body)].name,
                      width == 3 ? planar[part] : spatial[part]);
  if (const int joint = hardest_joint(body); joint >= 0) {
    text += fmt::format(", on which joint '{}' pulls hardest", model.joints[at(joint)].name);
  }
  return text + std::string(advice::error);
}

}  // namespace freeplay
