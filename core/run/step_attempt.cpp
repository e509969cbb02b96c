#include "run/step_attempt.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/index.h"
#include "component/joint_answer.h"
#include "component/plugin_memory.h"
#include "system/finite.h"

namespace freeplay {
namespace {
constexpr double unnoticed_turn = 1e-3;  // of a body [rad]
}  // namespace

StepAttempt::StepAttempt(RunContext& run, RunFailure& failure)
    : run_(run), failure_(failure), scratch_(at(run.integrator_layout.scratch) + guard::marks) {
  for (int j = 0; j < static_cast<int>(run.model.joints.size()); ++j) {
    if (run.system.joints().layout(j).history > 0) with_history_.push_back(j);
    if (const int turn = run.system.layout().turn(j); turn >= 0) turns_.push_back({at(turn), at(j)});
  }
  if (run.system.joints().angles_follow_bodies())
    angle_then_.assign(run.e_accepted->q.size() / 3, std::numeric_limits<double>::quiet_NaN());
}

bool StepAttempt::commit_history() {
  for (const int j : with_history_) {
    if (!run_.evaluations.is_asleep(j) && !commit_history_of(j)) return false;
  }
  if (turns_are_due_) note_turns(run_.e_trial, run_.trial.h());
  return true;
}

bool StepAttempt::commit_history_of(int joint) {
  Fault fault;
  const Slice h = run_.system.layout().history(joint), rows = run_.system.layout().rows(joint);
  const Span<double> history = Span<double>(run_.trial.h()).part(at(h.offset), at(h.size));
  const double* const lambda = run_.trial.lambda().data();
  JointInput in = run_.system.joints().input(joint, point(run_.trial), run_.e_trial);
  in.dissipated = &run_.events.lost()[at(joint)];
  if (!run_.system.joints().handle(joint).commit(in, {lambda + rows.offset, at(rows.size)}, history, fault.message) ||
      !keeps_finite({}, history, "commit", fault.message)) {
    fault.kind = Fault::Kind::plugin;
    fault.joint = joint;
    return failure_.fail_with(fault, run_.trial.t());
  }
  return run_.trial.intact() || failure_.fail_beside(joint);
}

bool StepAttempt::start() {
  StateView view = run_.accepted.view();
  Message message;
  run_.solver.use_history(run_.accepted.h());
  if (run_.settings.integrator.restart(view, run_.solver.table(), message)) return true;
  require_memory(message);
  if (run_.solver.fault().kind != Fault::Kind::none) {
    return failure_.fail_with(run_.solver.fault(), run_.accepted.t());
  }
  return failure_.fail(5, fmt::format("t = {:.9g} s: {} failed at the start: {} [plugin-failed]", run_.accepted.t(),
                                      integrator_words(run_.model), message.text));
}

bool StepAttempt::begin_steps(double dt, State& state) {
  const Profile::Timer timer(run_.evaluations.profile, Phase::joints);
  const Point here = point(run_.accepted);
  // A step that the error chooses ends at events: there joints are asked for all but forces.
  if (!run_.sleeping.begin(run_.adaptive ? unbounded : dt, here, run_.e_accepted, run_.e_trial->fault)) {
    return failure_.fail_with(run_.e_trial->fault, run_.accepted.t());
  }
  for (const int j : with_history_) {
    if (!run_.evaluations.is_asleep(j) && !begin_step_of(j, dt, here, state)) return false;
  }
  return true;
}

bool StepAttempt::begin_step_of(int joint, double dt, const Point& start, State& state) {
  const Slice h = run_.system.layout().history(joint);
  MarkerAccelerations accelerations;
  run_.system.joints().accelerations(joint, run_.e_accepted, run_.accepted.a(), accelerations);
  const Span<double> history = Span<double>(state.h()).part(at(h.offset), at(h.size));
  Fault& fault = run_.e_trial->fault;
  if (!run_.system.joints().handle(joint).begin_step(run_.system.joints().input(joint, start, run_.e_accepted),
                                                     accelerations, dt, history, fault.message) ||
      !keeps_finite({}, history, "begin_step", fault.message)) {
    fault.kind = Fault::Kind::plugin;
    fault.joint = joint;
    return failure_.fail_with(fault, run_.accepted.t());
  }
  return state.intact() || failure_.fail_beside(joint);
}

// What is left out in fixed steps is completed for a row.
bool StepAttempt::evaluate_all(State& state, KeptEvaluation& e) {
  turns_are_due_ = run_.adaptive || have_turned(run_.solver.evaluation());
  const unsigned in_step = terms_of_equations | term_event | (turns_are_due_ ? term_turn : 0u);
  const unsigned terms = run_.adaptive ? all_terms : in_step;
  if (!run_.system.evaluate(point(state), terms, run_.solver.evaluation(), e)) return false;
  run_.system.constraints().fill_driven(e);
  run_.system.driven().recover_loads(e, state.lambda());
  return true;
}

// In fixed steps angles of joints that follow those of bodies are looked at where one has turned a little: the next
// look finds the turn nearest to the last.
bool StepAttempt::have_turned(const Evaluation& e) const {
  if (angle_then_.empty()) return true;
  int turned = 0;
  for (std::size_t b = 0; b < angle_then_.size(); ++b) {
    turned += std::abs(e.q[3 * b + 2] - angle_then_[b]) <= unnoticed_turn ? 0 : 1;
  }
  return turned != 0;
}

void StepAttempt::note_turns(const Evaluation& e, std::span<double> history) {
  for (const auto [turn, joint] : turns_) history[turn] = e.coordinate[joint];
  for (std::size_t b = 0; b < angle_then_.size(); ++b) angle_then_[b] = e.q[3 * b + 2];
}

/// What an integrator that says that it converged must have left.
[[gnu::always_inline]] inline bool StepAttempt::check_step(double dt) {
  const double expected = run_.accepted.t() + dt;
  if (!(std::abs(run_.trial.t() - expected) <= 1e-9 * dt + 4.0 * rounding * std::abs(expected))) {
    return failure_.fail(5, fmt::format("t = {:.9g} s: {} failed: a step to {:.9g} s ends at {:.9g} s [plugin-failed]",
                                        run_.accepted.t(), integrator_words(run_.model), expected, run_.trial.t()));
  }
  if (is_finite(Span<const double>(run_.trial.before_history()))) return true;
  if (failure_.all_built_in()) {
    run_.left_bounds = true;  // a step that was too long for the forces: a shorter one may do
    return true;
  }
  return failure_.fail(
      5, fmt::format("t = {:.9g} s: {} failed: it left a state that is not a finite number [plugin-failed]",
                     run_.accepted.t(), integrator_words(run_.model)));
}

bool StepAttempt::make(double dt, bool& converged) {
  converged = false;
  run_.plugin_fault.kind = Fault::Kind::none;
  run_.inner.forget();
  run_.trial.assign(run_.accepted);
  if (!begin_steps(dt, run_.trial)) return false;
  run_.solver.use_history(run_.trial.h());
  if (run_.adaptive) run_.solver.local_error().begin_attempt(run_.accepted.v(), run_.accepted.z());
  const Profile::Timer timer(run_.evaluations.profile, Phase::integrator);
  StateView view = run_.trial.view();
  Attempt attempt{};
  Message message;
  guard::set(scratch().end());
  const bool good = run_.settings.integrator.attempt(dt, view, scratch(), run_.solver.table(), attempt, message);
  if (!guard::intact(scratch().end()) || !run_.trial.intact()) {
    return failure_.fail(5, fmt::format("t = {:.9g} s: {} failed: it wrote beside the state, its memory or its scratch "
                                        "[plugin-failed]",
                                        run_.accepted.t(), integrator_words(run_.model)));
  }
  if (!good) {
    require_memory(message);
    // A joint, or a load that depends on the motion, may fail at a trial state that a shorter step does not meet; a
    // driver fails by its time alone.
    run_.plugin_fault = run_.solver.fault();
    const MotionFault& load = run_.plugin_fault.motion;
    const bool by_motion = run_.plugin_fault.kind == Fault::Kind::motion &&
                           ((load.force >= 0 && !run_.model.forces[at(load.force)].by_motion.empty()) ||
                            (load.driver >= 0 && !run_.model.drivers[at(load.driver)].by_motion.empty()));
    if (run_.plugin_fault.kind == Fault::Kind::plugin || by_motion) return true;
    if (run_.plugin_fault.kind == Fault::Kind::motion) return failure_.fail_with(run_.plugin_fault, *view.t);
    if (!*run_.solver.trouble()) {
      return failure_.fail(5, fmt::format("t = {:.9g} s: {} failed: {} [plugin-failed]", run_.accepted.t(),
                                          integrator_words(run_.model), message.text));
    }
    return true;  // the solver gave up: a shorter step may do
  }
  converged = attempt.converged != 0;
  run_.error = attempt.error;
  if (run_.adaptive && converged && !(attempt.error >= 0.0) && !failure_.all_built_in() &&
      is_finite(Span<const double>(run_.trial.before_history()))) {
    return failure_.fail(5, fmt::format("t = {:.9g} s: {} failed: its estimate of the error is {} [plugin-failed]",
                                        run_.accepted.t(), integrator_words(run_.model), attempt.error));
  }
  const bool rejected = run_.adaptive && !(run_.error <= 1.0);  // whatever it left
  run_.left_bounds = false;
  if (!converged || rejected) return true;
  if (!check_step(dt)) return false;
  converged = !run_.left_bounds;
  return true;
}

// An event changes history or internal variables, and with them what acts.
bool StepAttempt::restart() {
  ++run_.restarts;
  StateView view = run_.accepted.view();
  run_.solver.use_history(run_.accepted.h());
  Message message;
  const bool solved = run_.solver.accelerate(view, {run_.z_rate.data(), run_.z_rate.size()});
  if (!solved || !run_.settings.integrator.restart(view, run_.solver.table(), message)) {
    if (run_.solver.fault().kind != Fault::Kind::none)
      return failure_.fail_with(run_.solver.fault(), run_.accepted.t());
    if (!solved) return failure_.fail(4, fmt::format("t = {:.9g} s: {}", run_.accepted.t(), run_.solver.trouble()));
    return failure_.fail(5, fmt::format("t = {:.9g} s: {} failed: {} [plugin-failed]", run_.accepted.t(),
                                        integrator_words(run_.model), message.text));
  }
  if (!evaluate_all(run_.accepted, run_.e_accepted))
    return failure_.fail_with(run_.e_accepted->fault, run_.accepted.t());
  run_.energy.renew(run_.e_accepted, run_.accepted.lambda());
  return true;
}

}  // namespace freeplay
