#include "run/adaptive_run.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/index.h"

namespace freeplay {
namespace {

constexpr double largest_turn = 1.0;    // of a joint in one step [rad]: angles are continued over turns
constexpr double barely = 1.0 - 1e-6;   // of a step: what is shorter by the rounding of times alone is as long
constexpr double close_ahead = 100.0;   // smallest steps
constexpr double beside_a_root = 1.5;   // power of the step with which errors fall there
constexpr int most_resolutions = 100;   // at what loads do inside one step
constexpr double shorter_hunt = 0.25;   // of a step whose event could not be located
constexpr int most_given_up = 6;        // of such steps, one after the other
constexpr double least_allowed = 64.0;  // roundings of positions and, per second, of velocities

// Close to a singular position of the constraints a stage loses what its distance is in rounding, and its error falls
// too slowly with the step: shorter and shorter steps would lead into the very position. The motion itself is smooth
// there, so that a step of another length, which looks elsewhere, goes over it. By regularity():
constexpr double at_singular = 1e-8;  // a step that passed, too
constexpr double stuck_there = 1e-4;  // steps that fall for ever have come to it
constexpr double hopeless = 1e-12;    // the way that the mechanism takes on would be one of rounding
constexpr double detour_lengths[] = {0.9, 1.1, 0.8, 1.2, 0.7, 1.4, 0.6, 1.7, 0.5, 2.0, 3.0};

constexpr double largest_uninformed = 0.2;  // of the largest step, with an accuracy: see StepLimits

StepLimits step_limits(const Settings& settings) {
  return {settings.step, settings.smallest_step, settings.largest_step,
          settings.accuracy > 0.0 ? largest_uninformed * settings.largest_step : settings.largest_step};
}

// Accuracies per second that steps over short loads may show. They mostly err by a small part of it; those of implicit
// methods, whose estimate is of their order 2, by a thousandth.
double load_errors(int error_power) { return error_power < 5 ? 64.0 : 2.0; }

}  // namespace

AdaptiveRun::AdaptiveRun(const RunParts& parts, EventPursuit& pursuit)
    : parts_(parts),
      run_(parts.run),
      pursuit_(pursuit),
      force_kinks_(parts.run),
      control_(step_limits(parts.run.settings), error_power(parts.run.integrator_layout)),
      budget_(load_errors(error_power(parts.run.integrator_layout)) / accuracy_per_step,
              error_power(parts.run.integrator_layout)),
      slow_(parts.run, parts.failure),
      velocity_allowed_(parts.run.allowed) {}

bool AdaptiveRun::advance(const RunHooks& hooks, const RunGoal& goal) {
  const long steps = run_.outcome.steps, rows = parts_.recorder.next_row();
  while (run_.accepted.t() < run_.settings.end) {
    if (!(run_.accepted.t() < goal.until) || parts_.recorder.next_row() - rows >= goal.rows ||
        run_.outcome.steps - steps >= goal.steps) {
      return true;
    }
    const long before = run_.outcome.steps;
    const bool going = step(goal.until) && parts_.stop.go_on();
    const bool due = run_.accepted.t() >= parts_.recorder.next_row_time();
    if (run_.outcome.steps > before && (due || !going) && !parts_.recorder.write_row()) return false;
    if (!going) {
      parts_.recorder.write_held_rows();
      return false;
    }
    parts_.recorder.pass_rows();
    if (hooks.notice && slow_.has_notice()) hooks.notice(slow_.take_notice());
    if (hooks.stepped) hooks.stepped();
    if (parts_.end.check_interrupt(hooks)) continue;
    parts_.recorder.know_row();  // of the summary; rows stay those of the whole run
    return false;
  }
  return false;
}

bool AdaptiveRun::step(double until) {
  Search search;
  if (!begin_search(until, search)) return false;
  for (;;) {
    Found found = attempt(search);
    if (found == Found::yes) found = end_at_stop(search);
    if (found == Found::failed) return false;
    if (found == Found::yes) return accept(search);
  }
}

// What error control and joints allow, no farther than `until`, the next corner and the event that is to be expected.
bool AdaptiveRun::begin_search(double until, Search& search) {
  allow_error(search);
  if (!bounded_step(search.dt, search.limiting)) return false;
  Fault fault;
  if (!run_.events.look_from(run_.accepted, run_.e_accepted, fault)) {
    return parts_.failure.fail_with(fault, run_.accepted.t());
  }
  const double smallest = control_.limits().smallest;
  if (parts_.failure.comes_to_end_of_path(search.dt)) return false;
  if (!(search.dt >= smallest)) {
    const bool stuck = run_.solver.regularity() < stuck_there;
    return parts_.failure.fail(
        4, stuck ? parts_.failure.why_singular() : parts_.failure.why_so_small(search.dt, smallest, search.limiting));
  }
  double kink = 0.0;
  if (!parts_.corners.next_corner(search.dt, kink)) return false;
  search.goal = std::min(run_.settings.end, until);
  if (kink <= run_.settings.end && !(search.goal < Corners::before(kink))) {
    search.goal = Corners::before(kink);
    search.kink = kink;
  }
  search.dt = std::min(search.dt, std::max(parts_.motion_loads.longest(), smallest));
  const double proposed = std::min(search.dt, search.goal - run_.accepted.t());
  double reach = proposed;
  if (!parts_.corners.resolve_inputs(reach)) return false;
  if (reach < proposed) search.dt = reach;
  search.hunted = run_.events.expected_within(reach);
  if (search.hunted.joint >= 0) search.dt = search.hunted.fraction * reach;
  return true;
}

AdaptiveRun::Found AdaptiveRun::attempt(Search& search) {
  const double from = run_.accepted.t(), left = search.goal - from;
  const bool last = search.dt >= left * (1.0 - 1e-12);
  if (last) search.dt = left;
  if (!last && from + search.dt == from) {
    parts_.failure.fail(4, parts_.failure.why_so_small(search.dt, control_.limits().smallest, search.limiting));
    return Found::failed;
  }
  bool converged = false;
  run_.ended_inside = false;
  if (!parts_.attempt.make(search.dt, converged)) return Found::failed;
  search.hidden = converged ? parts_.corners.hidden_error(search.dt) : 1.0;
  run_.error *= search.hidden;
  const bool passed = converged && run_.error <= 1.0;
  if (search.hunted.joint < 0 && take_detour(passed, search)) return Found::no;
  if (passed && run_.solver.regularity() < hopeless) {
    parts_.failure.fail(4, parts_.failure.why_singular());
    return Found::failed;
  }
  if (!passed) return shorten(search, converged);
  if (last) run_.trial.t() = search.goal;
  if (!parts_.attempt.evaluate_all(run_.trial, run_.e_trial)) {
    parts_.failure.fail_with(run_.e_trial->fault, run_.trial.t());
    return Found::failed;
  }
  return judge(search);
}

// The attempt did not converge, or erred too much.
AdaptiveRun::Found AdaptiveRun::shorten(Search& search, bool converged) {
  ++run_.outcome.rejected;
  search.hunted = {};
  search.at_force_kink = false;
  double& dt = search.dt;
  const double tried = dt;
  if (converged) {
    control_.reject(dt, run_.error, search.hidden > 1.0 ? beside_a_root : unbounded);
    dt = pursuit_.before_event(dt, control_.next(), search.hunted);
  } else {
    control_.halve(dt);
    dt = control_.next();
  }
  const double smallest = control_.limits().smallest;
  if (dt >= smallest) return Found::no;
  if (converged && !look_ahead(tried, std::min(close_ahead * smallest, search.goal - run_.accepted.t()))) {
    return Found::failed;
  }
  if (run_.plugin_fault.kind != Fault::Kind::none) {
    parts_.failure.fail_with(run_.plugin_fault, run_.accepted.t());
  } else if (run_.solver.regularity() < stuck_there) {
    parts_.failure.fail(4, parts_.failure.why_singular());
  } else {
    parts_.failure.fail(
        4, converged ? parts_.failure.why_so_small(dt, smallest, -1) : parts_.failure.why_not_converged(dt));
  }
  return Found::failed;
}

// Forces that bend ever more may end just ahead, as at the edge of what a formula is for: that is why steps come to
// nothing, and is then the fault. Else all is left as after the attempt of the length `tried`.
bool AdaptiveRun::look_ahead(double tried, double dt) {
  bool converged = false;
  if (!parts_.attempt.make(dt, converged)) return false;
  return run_.plugin_fault.kind != Fault::Kind::none || parts_.attempt.make(tried, converged);
}

// A step that erred little enough may still gain energy, go over what joints do inside, or pass an event.
AdaptiveRun::Found AdaptiveRun::judge(Search& search) {
  if (parts_.growth.too_large()) {
    ++run_.outcome.rejected;
    search.hunted = {};
    control_.halve(search.dt);
    search.dt = control_.next();
    if (!(search.dt < control_.limits().smallest)) return Found::no;
    parts_.failure.fail(4, parts_.failure.why_energy_grows(search.dt, parts_.growth.gained()));
    return Found::failed;
  }
  const double whole = run_.trial.t() - run_.accepted.t();
  double resolved = whole;
  if (!parts_.corners.resolves_joints(resolved) || !resolve_motion_loads(search, resolved)) return Found::failed;
  if (!(resolved < barely * whole)) return end_at_force_kink(search);
  ++run_.outcome.rejected;
  search.hunted = {};
  search.dt = resolved;
  return Found::no;
}

// Shortens a step over what loads that depend on the motion do inside.
bool AdaptiveRun::resolve_motion_loads(Search& search, double& dt) {
  if (!parts_.motion_loads.any() || search.looks > most_resolutions) return true;
  const Profile::Timer timer(run_.evaluations.profile, Phase::joints);
  double part = 1.0;
  Fault fault;
  if (!parts_.motion_loads.resolved(part, fault)) return parts_.failure.fail_with(fault, run_.trial.t());
  if (!(part < barely)) return true;
  ++search.looks;
  dt = std::min(dt, std::max(part * (run_.trial.t() - run_.accepted.t()), control_.limits().smallest));
  return true;
}

AdaptiveRun::Found AdaptiveRun::end_at_force_kink(Search& search) {
  const bool matters = force_kinks_.any() && ForceKinks::hidden * run_.error > 1.0;
  if (!matters || search.at_force_kink) return end_at_event(search);
  double part = 1.0;
  Fault fault;
  if (!force_kinks_.first_inside(part, fault)) {
    parts_.failure.fail_with(fault, run_.trial.t());
    return Found::failed;
  }
  const double shorter = part * (run_.trial.t() - run_.accepted.t());
  if (!(part < 1.0) || shorter < control_.limits().smallest) return end_at_event(search);
  ++run_.outcome.rejected;
  search.at_force_kink = true;
  search.hunted = {};
  search.dt = shorter;
  return Found::no;
}

// Where a step is so long that its end says nothing, as of what hardly moves on a stiff spring, the same event comes
// elsewhere in each attempt.
bool AdaptiveRun::gives_up_hunt(Search& search) {
  const double shorter = shorter_hunt * (run_.trial.t() - run_.accepted.t());
  if (search.hunts <= EventPursuit::most_hunts || search.given_up >= most_given_up ||
      shorter < control_.limits().smallest)
    return false;
  search.hunted = {};
  search.bracket = {};
  search.hunts = 0;
  search.dt = shorter;
  ++search.given_up;
  ++run_.outcome.rejected;
  return true;
}

AdaptiveRun::Found AdaptiveRun::end_at_event(Search& search) {
  if (gives_up_hunt(search)) return Found::no;
  bool done = false;
  if (!pursuit_.pursue(search.hunted, search.bracket, search.dt, search.hunts, search.goal, done)) return Found::failed;
  if (done) return Found::yes;
  const double whole = run_.trial.t() - run_.accepted.t(), left = search.goal - run_.accepted.t();
  if (pursuit_.end_inside(search.hunted, search.dt, search.hunts, left)) {
    if (run_.trial.t() - run_.accepted.t() <= whole) return Found::yes;
    // Beyond its end another event may lie.
    if (!pursuit_.pursue(search.hunted, search.bracket, search.dt, search.hunts, search.goal, done))
      return Found::failed;
    if (done) return Found::yes;
  }
  if (run_.outcome.status == RunStatus::failed) return Found::failed;
  // Just beyond the goal: the next step meets it.
  if (run_.trial.t() >= search.goal && search.hunted.value < 0.0 && search.dt >= whole) {
    search.hunted = {};
    return Found::yes;
  }
  ++search.hunts;
  return Found::no;
}

// A step in which a condition to stop is met is made again, to end there.
AdaptiveRun::Found AdaptiveRun::end_at_stop(Search& search) {
  if (!parts_.stop.any()) return Found::yes;
  const double whole = run_.trial.t() - run_.accepted.t();
  if (search.stop > 0.0 && std::abs(whole - search.stop) <= (1.0 - barely) * whole) {
    parts_.stop.end_there();
    return Found::yes;
  }
  double part = 2.0;
  if (!parts_.stop.first_inside(part)) return Found::failed;
  if (!(part <= 1.0)) return Found::yes;
  if (part > barely) {
    parts_.stop.end_there();
    return Found::yes;
  }
  ++run_.outcome.rejected;
  search.hunted = {};
  search.dt = search.stop = part * whole;
  return Found::no;
}

bool AdaptiveRun::accept(const Search& search) {
  const bool at_kink = search.kink < unbounded && run_.trial.t() == search.goal;
  if (search.quick) budget_.spend(run_.error, search.unbounded_slope);
  budget_.pass(run_.trial.t() - run_.accepted.t());
  const CornerKind corner = parts_.corners.end_step(at_kink ? std::optional(search.kink) : std::nullopt);
  if (at_kink && corner == CornerKind::motion) {
    control_.restart();
  } else if (search.hunted.joint < 0 && !search.at_force_kink) {
    control_.accept(run_.trial.t() - run_.accepted.t(), run_.error);
  }
  if (!parts_.acceptance.accept(
          {.located = search.hunted, .late = pursuit_.event_lateness(), .kink = at_kink ? search.kink : unbounded}))
    return false;
  // Forces that begin or end at an event do so once the joint has handled it.
  if (search.hunted.joint >= 0 && !at_kink) control_.cut(run_.e_accepted->acting);
  return slow_.pass(search.limiting);
}

// Whether to try another length of the step that was just made, and back to the one asked for after all of them.
bool AdaptiveRun::take_detour(bool passed, Search& search) {
  std::size_t& detours = search.detours;
  if (detours > std::size(detour_lengths)) return false;
  if (!(run_.solver.regularity() < (passed ? at_singular : near_singular))) return false;
  if (detours == 0) search.asked = search.dt;
  search.dt = detours < std::size(detour_lengths) ? detour_lengths[detours] * search.asked : search.asked;
  ++detours;
  ++run_.outcome.rejected;
  return true;
}

// A step over a short load takes its error from a budget, as what it makes of the position at the end of the run. Where
// a contact acts its own errors rule, and no sum of them is one of the load.
void AdaptiveRun::allow_error(Search& search) {
  if (!(run_.settings.accuracy > 0.0)) return;
  search.quick = parts_.corners.act_quickly() && !in_contact(run_.e_accepted);
  double in_position = run_.allowed, in_velocity = run_.allowed;
  if (search.quick) {
    const double least = std::min(run_.allowed, least_allowed * rounding * run_.system.size());
    const double lasting = std::max(1.0, run_.settings.end - run_.accepted.t());
    search.unbounded_slope = parts_.corners.hide_errors();
    in_position = std::max(budget_.share(1.0, search.unbounded_slope) * run_.allowed, least);
    in_velocity = std::max(budget_.share(lasting, search.unbounded_slope) * run_.allowed, least);
  }
  if (in_velocity == velocity_allowed_) return;
  control_.allow(in_velocity / velocity_allowed_);
  velocity_allowed_ = in_velocity;
  run_.solver.control_error(in_position, in_velocity, 0.0);
}

bool AdaptiveRun::in_contact(const Evaluation& e) const {
  const std::span<const ForceBlock> blocks = run_.system.forces().blocks();
  for (std::size_t f = 0; f < blocks.size(); ++f) {
    if (e.acts[f] != 0 && run_.system.joints().layout(blocks[f].joint).clearance > 0.0) return true;
  }
  return false;
}

// The proposal of the error control, no longer than any joint allows and than what is left.
bool AdaptiveRun::bounded_step(double& dt, int& limiting_joint) {
  dt = control_.next();
  limiting_joint = -1;
  for (int j = 0; j < static_cast<int>(run_.model.joints.size()); ++j) {
    if (run_.model.joints[at(j)].gear >= 0) continue;
    const JointInput in = run_.system.joints().input(j, point(run_.accepted), run_.e_accepted);
    double limit = unbounded;
    Fault fault;
    bool good = run_.system.joints().handle(j).step_limit(in, limit, fault.message);
    if (good && !(limit >= 0.0)) {
      good = false;
      abi::copy_text(fault.message.text, sizeof fault.message.text,
                     "the longest step that it allows is no length of time");
    }
    if (!good) {
      fault.kind = Fault::Kind::plugin;
      fault.joint = j;
      return parts_.failure.fail_with(fault, run_.accepted.t());
    }
    if (run_.system.joints().layout(j).coordinate == Coordinate::angle) {
      limit = std::min(limit, largest_turn / std::abs(in.coordinate_rate));
    }
    if (limit < dt) dt = limit, limiting_joint = j;
  }
  return true;
}

}  // namespace freeplay
