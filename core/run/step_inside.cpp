#include "run/step_inside.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "base/index.h"
#include "run/dense_step.h"

namespace freeplay {
namespace {
constexpr int order_by_ends = 5;           // of a method whose steps are known as well inside by their ends
constexpr double unnoticed_inside = 1e-2;  // part of what a step may err by, by which its inside may change
constexpr double astray_inside = 1.0;      // and by which its ends may mislead: no more than a step may err by
constexpr double nearest_aside = 1e-8;     // regularity of a step that is looked into, but for the output
constexpr double as_far = 0.5;             // part of the regularity at its end: 0.7 of the distance
constexpr int most_sweeps = 3;
constexpr double most_growth = 2.0;  // of changes from sweep to sweep that matter: more is a stiff force

/// Whether an acceleration in `between` is farther from those at both ends of the step than these are from each other.
bool accelerates_beyond_ends(const RunContext& run) {
  const std::span<const double> start = run.accepted.a(), end = run.trial.a(), here = run.between.a();
  for (std::size_t i = 0; i < here.size(); ++i) {
    const auto [low, high] = std::minmax(start[i], end[i]);
    if (here[i] > 2.0 * high - low || here[i] < 2.0 * low - high) return true;
  }
  return false;
}

/// Whether a force acts that begins and ends by events, or by a clearance.
bool touches(const RunContext& run, const Evaluation& e) {
  const std::span<const ForceBlock> blocks = run.system.forces().blocks();
  for (std::size_t f = 0; f < blocks.size(); ++f) {
    if (e.acts[f] == 0) continue;
    const JointLayout& layout = run.system.joints().layout(blocks[f].joint);
    if (layout.clearance > 0.0 || !layout.events.empty()) return true;
  }
  return false;
}
}  // namespace

StepInside::StepInside(RunContext& run, RunFailure& failure, StepAttempt& attempt)
    : run_(run),
      failure_(failure),
      attempt_(attempt),
      inner_before_(at(run.system.layout().nv())),
      defect_(inner_before_.size()),
      rate_defect_(inner_before_.size()),
      start_rate_(run.z_rate.size()),
      end_rate_(run.z_rate.size()),
      memory_before_(at(run.system.layout().nz())),
      memory_change_(memory_before_.size()) {}

bool StepInside::settle_between() {
  StateView view = run_.between.view();
  run_.solver.use_history(run_.between.h());
  run_.solver.move_away();
  return run_.solver.project_position(view) && run_.solver.project_velocity(view) &&
         run_.solver.accelerate(view, {run_.z_rate.data(), run_.z_rate.size()});
}

// Forces grow without bounds towards a singular position that the motion goes through, and their errors with them: what
// is seen there says no more than the end of the step, the place of the last pivot, unless it is about as far away.
bool StepInside::settle_aside() {
  IndependentRows& rows = run_.solver.rows();
  if (!(rows.regularity() < near_singular)) return settle_between();
  const IndependentRows::Regularity then = rows.regularities();
  if (!(then.last >= nearest_aside)) return false;
  const bool settled = settle_between() && rows.regularities().last >= as_far * then.last;
  rows.put_back(then);
  return settled;
}

// Between its ends a step is known to the sixth order from these alone. Where that is not enough the equations of
// motion are solved at places inside, over and over, until nothing changes that would matter. Where a joint cannot be
// asked there, or changes grow as where forces are stiff against the step, the ends have to do.
void StepInside::know_inside() {
  if (run_.inner.known()) return;
  const std::size_t joints = run_.e_accepted->internal_rate.size();
  std::ranges::copy(run_.e_accepted->internal_rate, start_rate_.begin());
  std::ranges::copy(run_.e_trial->internal_rate, end_rate_.begin());
  if (run_.flows > 0) {
    run_.energy.flow(run_.e_accepted, run_.accepted.lambda(), std::span(start_rate_).subspan(joints));
    run_.energy.flow(run_.e_trial, run_.trial.lambda(), std::span(end_rate_).subspan(joints));
  }
  const DenseStep by_ends(run_.model.space, run_.accepted, start_rate_, run_.trial, end_rate_);
  const auto look = [&](std::size_t place) {
    const double s = InnerMotion::places[place];
    DenseStep(run_.model.space, run_.accepted, start_rate_, run_.trial, end_rate_, &run_.inner).at(s, run_.between);
    StateView view = run_.between.view();
    run_.solver.use_history(run_.between.h());
    if (!run_.solver.accelerate(view, {run_.z_rate.data(), run_.z_rate.size()})) return false;
    by_ends.missing(s, run_.between, run_.z_rate, run_.inner.missing(place), run_.inner.missing_rate(place));
    return true;
  };
  const auto change = [&](std::size_t place) {
    const std::span<const double> now = run_.inner.missing(place);
    for (std::size_t i = 0; i < now.size(); ++i) defect_[i] = now[i] - std::exchange(inner_before_[i], now[i]);
    return error_by_missing(0.5);
  };
  std::ranges::fill(inner_before_, 0.0);
  if (!look(InnerMotion::middle)) return;
  run_.inner.fit_middle();
  // Of internal variables the middle alone says too little.
  if (joints == 0 && change(InnerMotion::middle) <= unnoticed_inside) return;
  std::ranges::fill(inner_before_, 0.0);
  std::ranges::fill(memory_before_, 0.0);
  double last_change = unbounded;
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    bool seen = look(InnerMotion::middle);
    if (seen && sweep == 0) run_.inner.fit_middle();
    seen = seen && look(0) && look(2);
    if (!seen) return run_.inner.forget();
    run_.inner.fit();
    const double now = change(0);
    if (now <= unnoticed_inside && change_of_memory(0) <= unnoticed_inside) return;
    if (now > astray_inside && !(now < most_growth * last_change)) return run_.inner.forget();
    last_change = now;
  }
}

// By how much the last sweep moved internal variables at a place, in units of what a step may err by.
double StepInside::change_of_memory(std::size_t place) {
  if (memory_before_.empty()) return 0.0;
  const InnerMotion::Weights weights(InnerMotion::places[place]);
  for (std::size_t i = 0; i < memory_before_.size(); ++i) {
    const double now = run_.inner.internal(weights, i);
    memory_change_[i] = now - std::exchange(memory_before_[i], now);
  }
  return run_.solver.internal_error_norm(run_.trial.t() - run_.accepted.t(), run_.trial.view(), memory_change_);
}

// Largest error of an interpolation by the ends, in units of what a step may err by, that misses `defect` of the second
// derivative by s of increments at the fraction s: as u^3 with u = s (1 - s), of which no more than 1/64 and, by s,
// 0.054 come together. `defect` is lost.
double StepInside::error_by_missing(double s) {
  const double dt = run_.trial.t() - run_.accepted.t();
  const double bend = std::max(std::abs(InnerMotion::Weights(s).acceleration[0]), 0.05);
  for (std::size_t i = 0; i < defect_.size(); ++i) {
    rate_defect_[i] = 0.054 / (bend * dt) * defect_[i];
    defect_[i] *= 1.0 / (64.0 * bend);
  }
  return run_.solver.error_norm(defect_, rate_defect_);
}

// A consistent state inside the step that was just made, in `between`.
bool StepInside::settle_inside(double t) {
  const double s = (t - run_.accepted.t()) / (run_.trial.t() - run_.accepted.t());
  if (run_.inner.known()) {
    DenseStep(run_.model.space, run_.accepted, start_rate_, run_.trial, end_rate_, &run_.inner).at(s, run_.between);
  } else {
    DenseStep(run_.model.space, run_.accepted, run_.e_accepted->internal_rate, run_.trial, run_.e_trial->internal_rate)
        .at(s, run_.between);
  }
  run_.between.t() = t;
  if (settle_between()) return true;
  if (run_.solver.fault().kind != Fault::Kind::none) return failure_.fail_with(run_.solver.fault(), t);
  return failure_.fail(4, failure_.why_unsolved(t));
}

// How far the interpolation is off the accelerations at the fraction s, in `between`. Contacts follow rules of their
// own, and methods of a low order make short steps, between which what they damp shakes the accelerations. Forces that
// last no longer than an output interval may be missed.
void StepInside::note_missed(double s) {
  const bool is_long = run_.trial.t() - run_.accepted.t() >= run_.settings.interval;
  if (!is_long || !accelerates_beyond_ends(run_) || run_.integrator_layout.order < order_by_ends ||
      touches(run_, run_.e_accepted) || touches(run_, run_.e_trial) || touches(run_, run_.e_between)) {
    return;
  }
  DenseStep(run_.model.space, run_.accepted, run_.e_accepted->internal_rate, run_.trial, run_.e_trial->internal_rate)
      .missing(s, run_.between, {}, defect_, {});
  if (run_.inner.known()) {
    const InnerMotion::Weights weights(s);
    for (std::size_t i = 0; i < defect_.size(); ++i) defect_[i] -= run_.inner.increment(weights.acceleration, i);
  }
  const double times = error_by_missing(s);
  if (!(times > run_.missed.times)) return;
  std::size_t most = 0;
  const auto weight = [&](std::size_t i) {
    return std::abs(defect_[i]) * (run_.system.coordinates().is_turn(static_cast<int>(i)) ? run_.system.size() : 1.0);
  };
  for (std::size_t i = 1; i < defect_.size(); ++i) most = weight(i) > weight(most) ? i : most;
  const int body = static_cast<int>(most) / run_.system.layout().body_velocities();
  run_.missed = {times, run_.between.t(), run_.trial.t() - run_.accepted.t(), body};
}

bool StepInside::look_inside(double t) {
  const double s = (t - run_.accepted.t()) / (run_.trial.t() - run_.accepted.t());
  if (run_.integrator_layout.order > order_by_ends) know_inside();
  if (!settle_inside(t)) return false;
  bool astray = run_.inner.known();
  if (!astray) {
    // How far the ends alone lead astray, their own accelerations say.
    DenseStep(run_.model.space, run_.accepted, run_.e_accepted->internal_rate, run_.trial, run_.e_trial->internal_rate)
        .missing(s, run_.between, {}, defect_, {});
    astray = !(error_by_missing(s) <= astray_inside);
    if (astray) {
      know_inside();
      if (!settle_inside(t)) return false;
    }
  }
  if (!attempt_.evaluate_all(run_.between, run_.e_between)) return failure_.fail_with(run_.e_between->fault, t);
  if (astray) note_missed(s);
  return true;
}

}  // namespace freeplay
