#include "run/step_acceptance.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/index.h"
#include "run/dense_step.h"

namespace freeplay {
namespace {
constexpr double noticed_change = 1e-7;  // of the power of drivers times the step, of the work moved so far
}  // namespace

StepAcceptance::StepAcceptance(RunContext& run, RunFailure& failure, StepAttempt& attempt, Recorder& recorder,
                               RunDoubts& doubts, EnergyGrowth& growth, Corners& corners, StepCorners& step_corners)
    : run_(run),
      failure_(failure),
      attempt_(attempt),
      recorder_(recorder),
      doubts_(doubts),
      growth_(growth),
      corners_(corners),
      step_corners_(step_corners),
      flow_half_way_(at(run.energy.flows())),
      flow_end_(flow_half_way_.size()) {
  const Joints& joints = run.system.joints();
  for (int j = 0; j < joints.count(); ++j) {
    if (joints.layout(j).history > 0 || !joints.layout(j).events.empty()) may_lose_.push_back(at(j));
  }
}

bool StepAcceptance::begin() {
  const Profile::Timer timer(run_.evaluations.profile, Phase::start);
  run_.e_accepted->forget_motions();
  if (!run_.system.evaluate(point(run_.accepted), all_terms, run_.e_accepted)) {
    return failure_.fail_with(run_.e_accepted->fault, run_.accepted.t());
  }
  run_.system.constraints().fill_driven(run_.e_accepted);
  run_.system.driven().recover_loads(run_.e_accepted, run_.accepted.lambda());
  if (!attempt_.start()) return false;
  Fault fault;
  if (!run_.events.at_start(run_.accepted, run_.e_accepted, fault)) return failure_.fail_with(fault, run_.accepted.t());
  if (run_.events.switched() && !attempt_.restart()) return false;
  if (!recorder_.observe_start()) return false;
  growth_.start();
  doubts_.note_event_directions();
  doubts_.note_first_forces();
  return recorder_.record_step() && doubts_.watch_row(0.0) && recorder_.write_events();
}

// Where neither the integrator carries the flows nor the steps before show how they go, forces are looked at once more
// in the middle of the step.
[[gnu::always_inline]] inline void StepAcceptance::add_energy() {
  const double dt = run_.trial.t() - run_.accepted.t();
  if (run_.flows > 0 || run_.energy.flows() == 0) {
    return run_.energy.take(dt, run_.e_trial, run_.trial.lambda(),
                            std::span<const double>(run_.trial.z()).last(at(run_.flows)));
  }
  if (run_.energy.add_smooth(dt, run_.e_trial, run_.trial.lambda())) return;
  if (run_.adaptive && run_.solver.regularity() >= near_singular && drivers_change(dt)) {
    const IndependentRows::Regularity then = run_.solver.rows().regularities();
    const bool solved = step_corners_.flow_inside(run_.accepted.t() + 0.5 * dt, flow_half_way_);
    run_.solver.rows().put_back(then);
    if (solved) return run_.energy.add(dt, flow_half_way_, run_.e_trial, run_.trial.lambda());
  }
  DenseStep(run_.model.space, run_.accepted, run_.e_accepted->internal_rate, run_.trial, run_.e_trial->internal_rate)
      .at(0.5, run_.between);
  std::ranges::copy(run_.trial.h(), run_.between.h().begin());  // as the attempt had it
  // Where the forces in the middle cannot be evaluated, those at the end of the step take their place.
  const bool seen = run_.system.evaluate(point(run_.between), term_force, run_.e_between);
  run_.energy.flow(seen ? run_.e_between : run_.e_trial, run_.between.lambda(), flow_half_way_);
  run_.energy.add(dt, flow_half_way_, run_.e_trial, run_.trial.lambda());
}

// Whether the power of drivers that prescribe motion changes over a step so much that their efforts in its middle are
// to be solved for: as means of both ends these are of a lower order than the powers of what acts by forces.
bool StepAcceptance::drivers_change(double dt) {
  const std::vector<Driver>& drivers = run_.model.drivers;
  if (std::ranges::none_of(drivers, [](const Driver& driver) { return prescribes(driver.kind); })) return false;
  run_.energy.flow(run_.e_accepted, run_.accepted.lambda(), flow_half_way_);
  run_.energy.flow(run_.e_trial, run_.trial.lambda(), flow_end_);
  double change = 0.0;
  for (std::size_t d = 0; d < drivers.size(); ++d) {
    if (prescribes(drivers[d].kind)) change += std::abs(flow_end_[d] - flow_half_way_[d]);
  }
  return change * dt > noticed_change * run_.energy.exchanged();
}

[[gnu::always_inline]] inline bool StepAcceptance::add_history_losses() {
  const std::span<double> lost = run_.events.lost();
  for (const std::size_t j : may_lose_) {
    if (lost[j] == 0.0) continue;
    const double loss = std::exchange(lost[j], 0.0);
    if (!std::isfinite(loss)) {
      Fault fault;
      fault.refuse(static_cast<int>(j), "it said that it dissipated an energy that is not a finite number");
      return failure_.fail_with(fault, run_.trial.t());
    }
    std::size_t flow = 0;
    if (!run_.energy.add_history_loss(static_cast<int>(j), loss, run_.e_trial, flow)) continue;
    if (run_.flows > 0) run_.trial.z().last(at(run_.flows))[flow] -= loss;
  }
  return true;
}

[[gnu::always_inline]] inline bool StepAcceptance::apply_events(const StepEvents::Passage& located, double late) {
  const auto mobility = [](void* self, int joint, double* out) {
    auto& run = *static_cast<RunContext*>(self);
    const bool whole = run.system.joints().layout(joint).wants_whole_mobility != 0;
    return run.solver.mobility(run.trial, joint, {out, 9}, {out + 9, whole ? 36u : 0u});
  };
  const Profile::Timer timer(run_.evaluations.profile, Phase::events);
  Fault fault;
  if (run_.events.apply(run_.accepted, run_.e_accepted, run_.trial, run_.e_trial, mobility, &run_, fault) &&
      run_.events.apply_at_end(located, late, run_.trial, run_.e_trial, mobility, &run_, fault)) {
    return true;
  }
  // No joint has failed in its event: the mass that a contact feels could not be known.
  if (fault.kind == Fault::Kind::none) fault = run_.solver.evaluation()->fault;
  if (fault.kind == Fault::Kind::none) return failure_.fail(4, failure_.why_unsolved(run_.trial.t()));
  return failure_.fail_with(fault, run_.trial.t());
}

[[gnu::always_inline]] inline bool StepAcceptance::go_on_from(bool changed, const End& end) {
  if ((!changed || attempt_.restart()) && (!(end.corner < unbounded) || step_corners_.pass(end.corner)) &&
      (!(end.kink < unbounded) || corners_.pass_kink(end.kink))) {
    return true;
  }
  // The row of the last state from which the run could go on may still be asked for.
  std::swap(run_.accepted, run_.trial);
  swap(run_.e_accepted, run_.e_trial);
  return false;
}

bool StepAcceptance::accept(const End& end) {
  const double dt = run_.trial.t() - run_.accepted.t();
  if (!end.has_energy) add_energy();
  doubts_.note_motion();
  if (run_.adaptive && !recorder_.write_rows_inside()) return false;
  const bool last = run_.trial.t() >= run_.settings.end;
  const bool expected = run_.adaptive && (end.located.joint >= 0 || end.kink < unbounded || last);
  if (expected && !recorder_.note_abrupt_end()) return false;
  if (!apply_events(end.located, end.late) || !attempt_.commit_history() || !add_history_losses()) return false;
  run_.events.renew_switches(run_.trial, run_.e_trial);
  std::swap(run_.accepted, run_.trial);
  swap(run_.e_accepted, run_.e_trial);
  run_.outcome.time = run_.accepted.t();
  const bool changed = run_.events.changed() || run_.ended_inside;
  run_.ended_inside = false;
  run_.ended_abruptly = changed || expected;
  if (!go_on_from(changed, end)) return false;
  recorder_.forget_row();
  if (!recorder_.record_step()) return false;
  run_.outcome.smallest_step = run_.outcome.steps == 0 ? dt : std::min(run_.outcome.smallest_step, dt);
  run_.outcome.largest_step = std::max(run_.outcome.largest_step, dt);
  ++run_.outcome.steps;  // from now on its row may be written
  return doubts_.watch_row(dt) && doubts_.note_warnings() && recorder_.write_events();
}

}  // namespace freeplay
