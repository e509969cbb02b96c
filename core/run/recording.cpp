// What is recorded of a run: rows, events, statistics, and largest values inside the steps that an accuracy chooses.
#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "base/index.h"
#include "run/dense_step.h"
#include "run/simulation_impl.h"

namespace freeplay {
namespace {
constexpr double open_rows = 1e-3;  // of the size of the model: constraints that are off by more do not hold
}  // namespace

// The channels of the accepted state: asked for by rows, statistics, stop conditions and warnings, and seldom by all
// steps.
bool Simulation::Impl::know_row() {
  if (row_is_known) return true;
  Fault fault;
  if (!adaptive && !system.complete(point(accepted), e_accepted)) return fail_with(e_accepted->fault, accepted.t());
  if (!observer.observe(point(accepted), e_accepted, accepted.lambda(), row, fault)) {
    return fail_with(fault, accepted.t());
  }
  energy.fill(e_accepted, channels, row);
  return row_is_known = true;
}

bool Simulation::Impl::record_step() {
  const Profile::Timer timer(context.profile, Phase::statistics);
  double position = 0.0, velocity = 0.0;
  for (std::size_t r = 0; r < residual.size(); ++r) position = std::max(position, std::abs(e_accepted->phi[r]));
  watch.add_open(position);
  if (!(position <= open_rows * system.size())) return fail(4, why_open(position));
  const bool counts = statistics.counts(accepted.t());
  if (!counts && !statistics.noise().active()) return true;
  if (!know_row()) return false;
  if (!counts) {
    statistics.note(row);
    if (adaptive)
      ended_abruptly ? peaks.restart(accepted.t(), statistics.values())
                     : seek_peaks({trial, e_trial, accepted, e_accepted});
    return true;
  }
  system.multiply(e_accepted, accepted.v(), residual);
  for (std::size_t r = 0; r < residual.size(); ++r) {
    velocity = std::max(velocity, std::abs(residual[r] - e_accepted->nu[r]));
  }
  statistics.add(row, energy.driver_work(), energy.joint_loss(), energy.force_work(), position, velocity);
  if (adaptive && ended_abruptly) {
    statistics.begin_stretch();
    peaks.restart(accepted.t(), statistics.values());
  }
  if (adaptive && !ended_abruptly) seek_peaks({trial, e_trial, accepted, e_accepted});
  return true;
}

// Roundings of coordinates that have grown without bound, as behind a dead point, can pass for rows that hold.
std::string Simulation::Impl::why_open(double position) const {
  int worst = 0;
  for (int r = 0; r < system.layout().nc(); ++r) {
    if (!(std::abs(e_accepted->phi[at(r)]) <= std::abs(e_accepted->phi[at(worst)]))) worst = r;
  }
  return fmt::format("t = {:.9g} s: the mechanism has come apart: {} stays open by {:.4g} m", accepted.t(),
                     row_name(worst), position);
}

bool Simulation::Impl::write_row() {
  const Profile::Timer timer(context.profile, Phase::output);
  if (!know_row()) return false;
  ++outcome.rows;
  statistics.note_written(row);
  for (Sink* sink : sinks) sink->row(row);
  return sinks_are_well();
}

bool Simulation::Impl::tell_sinks() {
  outcome.events += static_cast<long>(events.happenings().size());
  const Profile::Timer timer(context.profile, Phase::events);
  for (const StepEvents::Happening& happening : events.happenings()) {
    const char* name = system.joint_layout(happening.joint).events[at(happening.event)].name;
    if (std::string_view(name).ends_with("contact_begin")) statistics.add_contact(happening.joint, happening.time);
    statistics.note_event(happening.joint, happening.event, events.fields(happening));
    for (Sink* sink : sinks) {
      sink->event({happening.time, happening.joint, happening.event, events.fields(happening)});
    }
    const EventStorm::Finding found = storm.note(happening.joint, happening.time, outcome.steps);
    if (found.events > 0) return fail_in_storm(happening, found);
  }
  return events.happenings().empty() || sinks_are_well();
}

// What a sink was told may fail later, beside the run: a row or an event to come finds it.
bool Simulation::Impl::sinks_are_well() {
  for (const Sink* sink : sinks) {
    if (!sink->ok()) return fail(6, "a result file could not be written");
  }
  return true;
}

bool Simulation::Impl::fail_in_storm(const StepEvents::Happening& last, const EventStorm::Finding& found) {
  return fail(4, fmt::format("t = {:.9g} s: the events of joint '{}' do not end: {} within {:.2g} s, the last '{}'; {}",
                             last.time, model.joints[at(last.joint)].name, found.events, found.within,
                             system.joint_layout(last.joint).events[at(last.event)].name, event_rule));
}

// The row at t of the interpolated motion, in `row_between`, but for its energies. What cannot be seen there is no
// failure of the run.
bool Simulation::Impl::observe_inside(double t, const Leg& leg) {
  if (solver.regularity() < near_singular) return false;
  const double s = (t - leg.start.t()) / (leg.end.t() - leg.start.t());
  DenseStep(system, leg.start, leg.e_start.internal_rate, leg.end, leg.e_end.internal_rate).at(s, between);
  between.t() = t;
  Fault ignored;
  return settle_between() && evaluate_all(between, e_between) &&
         observer.observe(point(between), e_between, between.lambda(), row_between, ignored);
}

// The step along `leg` ends with the values that statistics saw last.
void Simulation::Impl::seek_peaks(const Leg& leg) {
  const bool counts = statistics.counts(leg.end.t());
  if (statistics.counts(leg.start.t()) != counts) return peaks.restart(leg.end.t(), statistics.values());
  peaks.end_step(leg.end.t(), statistics.values());
  const double dt = leg.end.t() - leg.start.t();
  const auto largest = counts ? statistics.largest() : statistics.largest_before();
  for (double s = peaks.next(largest); s > 0.0; s = peaks.next(largest)) {
    if (!observe_inside(leg.start.t() + s * dt, leg)) return;
    statistics.note(row_between);
    peaks.seen(s, statistics.values());
  }
}

// An event or a kink changes what acts at the end of the step that was just made: until there it goes on smoothly.
bool Simulation::Impl::note_abrupt_end() {
  if (!statistics.counts(trial.t()) && !statistics.noise().active()) return true;
  const Profile::Timer timer(context.profile, Phase::statistics);
  Fault fault;
  if (!observer.observe(point(trial), e_trial, trial.lambda(), row_between, fault)) return fail_with(fault, trial.t());
  statistics.end_stretch(row_between);
  seek_peaks({accepted, e_accepted, trial, e_trial});
  return true;
}

// Statistics begin at the very instant that `discard` names.
bool Simulation::Impl::begin_statistics_inside() {
  const double t = statistics.first_instant();
  if (!statistics.begins_inside(accepted.t(), trial.t())) return true;
  const Profile::Timer timer(context.profile, Phase::statistics);
  if (!observe_inside(t, {accepted, e_accepted, trial, e_trial})) return true;
  energy.fill_inside((t - accepted.t()) / (trial.t() - accepted.t()), e_between, between.lambda(), channels,
                     row_between);
  statistics.add(row_between, energy.driver_work(), energy.joint_loss(), energy.force_work(), 0.0, 0.0);
  return true;
}

}  // namespace freeplay
