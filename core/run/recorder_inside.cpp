// Recorder: what is looked at inside of the step that was just made.
#include <algorithm>
#include <cmath>

#include "base/index.h"
#include "run/dense_step.h"
#include "run/recorder.h"

namespace freeplay {
namespace {

// Below this root of the regularity the rounding of positions, 1e-14, is amplified so much (by its fourth power) that
// forces of joints say nothing.
constexpr double noisy_forces = 2e-3;
constexpr double nearest_doubted = 1e-8;   // regularity: nothing can be solved for nearer to it
constexpr double farther = 1.5;            // of the distance from a singular position
constexpr double first_part = 1.0 / 64.0;  // of the way to the other end of a step, where that is looked for

}  // namespace

// The row at t of the interpolated motion, but for its energies. What cannot be seen there is no failure of the run.
bool Recorder::observe_inside(double t, const Ends& step, std::span<double> row) {
  const double s = (t - step.start.t()) / (step.end.t() - step.start.t());
  DenseStep(run_.model.space, step.start, step.e_start.internal_rate, step.end, step.e_end.internal_rate)
      .at(s, run_.between);
  run_.between.t() = t;
  Fault ignored;
  return inside_.settle_aside() && attempt_.evaluate_all(run_.between, run_.e_between) &&
         (run_.adaptive ||
          run_.system.joints().evaluate_coordinates(point(run_.between), term_coordinate, run_.e_between)) &&
         observer_.observe(run_.between, run_.e_between, row, ignored);
}

void Recorder::see_contact_end(std::span<const double> row) {
  contact_rows_.see_end(row);
  contact_peaks_.end_step(row[at(run_.channels.time)], contact_rows_.values(row));
}

// A look into a step for a largest value. False where nothing can be seen there.
bool Recorder::look_for_peak(double s, const Ends& step, bool wanted_row) {
  if (!observe_inside(step.start.t() + s * (step.end.t() - step.start.t()), step, row_between_)) return false;
  statistics_.note(row_between_);
  maxima_.see(row_between_);
  if (contact_rows_.active() || feed_.active()) {
    run_.energy.fill_inside(s, run_.e_between, run_.between.lambda(), run_.channels, row_between_);
    feed_.see_inside(row_between_);
    if (contact_rows_.active()) contact_rows_.see_inside(row_between_, wanted_row);
  }
  doubt_forces(step, row_between_[at(run_.channels.time)]);
  return true;
}

// The root of the regularity where an interpolated motion is at t, of which row_aside_ is made; negative: not known.
double Recorder::distance_at(double t, const Ends& step) {
  const double s = (t - step.start.t()) / (step.end.t() - step.start.t());
  DenseStep(run_.model.space, step.start, step.e_start.internal_rate, step.end, step.e_end.internal_rate)
      .at(s, run_.between);
  run_.between.t() = t;
  Fault ignored;
  const bool seen = inside_.settle_between() && attempt_.evaluate_all(run_.between, run_.e_between) &&
                    observer_.observe(run_.between, run_.e_between, row_aside_, ignored);
  return seen ? std::sqrt(std::max(run_.solver.rows().regularities().last, 0.0)) : -1.0;
}

// Of the row at t that statistics saw last: how much the forces of joints differ from those a little farther from a
// singular position, where they are much the same but for roundings of the positions.
void Recorder::doubt_forces(const Ends& step, double t) {
  if (!run_.adaptive || !(run_.solver.regularity() < noisy_forces * noisy_forces)) return;
  const IndependentRows::Regularity then = run_.solver.rows().regularities();
  if (!(std::min(then.attempt, then.last) >= nearest_doubted)) return;
  const double ahead = step.end.t() - t, back = step.start.t() - t, way = ahead >= -back ? ahead : back;
  const double near = distance_at(t, step);
  bool away = false;
  for (double part = first_part; near >= 0.0 && near < noisy_forces && part <= 1.0 && !away; part *= 2.0) {
    const double distance = distance_at(t + part * way, step);
    if (distance < 0.0) break;
    away = distance >= farther * near;
  }
  run_.solver.rows().put_back(then);
  if (away) run_.watch.add_beside(statistics_.largest(), row_aside_, t);
}

// The step ends with the values that statistics saw last.
void Recorder::seek_peaks(const Ends& step) {
  const bool counts = statistics_.counts(step.end.t());
  if (statistics_.counts(step.start.t()) != counts) return peaks_.restart(step.end.t(), statistics_.largest().last());
  peaks_.end_step(step.end.t(), statistics_.largest().last());
  const auto largest = counts ? statistics_.largest().in_window() : statistics_.largest().before();
  for (double s = peaks_.next(largest); s > 0.0; s = peaks_.next(largest)) {
    if (!look_for_peak(s, step, false)) return;
    peaks_.seen(s, statistics_.largest().last());
  }
}

// The same for those of each contact, and what else an impact wants rows of.
void Recorder::seek_contact_peaks(const Ends& step) {
  const auto largest = contact_rows_.largest();
  for (double s = contact_peaks_.next(largest); s > 0.0; s = contact_peaks_.next(largest)) {
    if (!look_for_peak(s, step, false)) return;
    contact_peaks_.seen(s, contact_rows_.values(row_between_));
  }
  for (const double s : contact_rows_.wanted_inside()) {
    if (!look_for_peak(s, step, true)) return;
  }
}

// An event or a kink changes what acts at the end of the step that was just made: until there it goes on smoothly.
bool Recorder::note_abrupt_end() {
  if (!statistics_.counts(run_.trial.t()) && !statistics_.largest().noise().active()) return true;
  const Profile::Timer timer(run_.evaluations.profile, Phase::statistics);
  Fault fault;
  if (!observer_.observe(run_.trial, run_.e_trial, row_between_, fault))
    return failure_.fail_with(fault, run_.trial.t());
  const Ends step{run_.accepted, run_.e_accepted, run_.trial, run_.e_trial};
  const auto row_at = [this, &step](double t) -> std::span<const double> {
    if (!observe_inside(t, step, row_middle_)) return {};
    maxima_.see(row_middle_);
    return row_middle_;
  };
  if (statistics_.end_stretch(row_between_, row_at)) clearances_.add(row_between_, run_.e_trial, {});
  if (contact_rows_.active() || feed_.active()) run_.energy.fill(run_.e_trial, run_.channels, row_between_);
  feed_.see_inside(row_between_);
  if (contact_rows_.active()) see_contact_end(row_between_);
  seek_peaks(step);
  if (contact_rows_.active()) seek_contact_peaks(step);
  return true;
}

// Statistics begin at the very instant that `discard` names, if that is before `until` and inside of the step that is
// being accepted.
bool Recorder::begin_statistics_inside(double until) {
  const double t = statistics_.first_instant();
  if (until < t || !statistics_.begins_inside(run_.accepted.t(), run_.trial.t())) return true;
  const Profile::Timer timer(run_.evaluations.profile, Phase::statistics);
  if (!see_at(t, row_between_)) return false;
  statistics_.add(row_between_, run_.energy.driver_work(), run_.energy.joint_loss(), run_.energy.force_work(), 0.0,
                  0.0);
  clearances_.add(row_between_, run_.e_between, run_.energy.joint_loss());
  feed_.see_inside(row_between_);
  if (contact_rows_.active()) contact_rows_.see_inside(row_between_, false);
  return true;
}

}  // namespace freeplay
