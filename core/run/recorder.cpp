#include "run/recorder.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"
#include "component/joint_roles.h"
#include "run/dense_step.h"

namespace freeplay {
namespace {
constexpr int exit_cannot_write = 6;
constexpr double open_rows = 1e-3;  // of the size of the model: constraints that are off by more do not hold
constexpr long whole_look = 16;     // of left-out steps one in so many is looked at as a whole

EventStorm::Limits storm_limits(const Settings& settings, bool adaptive) {
  const double latest = std::max(std::abs(settings.start), std::abs(settings.end));
  const double instant = std::max(2048.0 * rounding * latest, adaptive ? settings.smallest_step : 0.0);
  return {instant, adaptive ? settings.step : 0.0, StepEvents::most_per_step};
}

}  // namespace

Recorder::Recorder(RunContext& run, RunFailure& failure, StepAttempt& attempt, StepInside& inside,
                   std::span<Sink* const> sinks)
    : run_(run),
      failure_(failure),
      attempt_(attempt),
      inside_(inside),
      sinks_(sinks.begin(), sinks.end()),
      observer_(run.system, run.channels),
      left_out_(run.system, run.channels),
      statistics_(run.model, run.channels, run.adaptive),
      difference_(run.system),
      clearances_(run.model, run.system.joints(), run.channels),
      slips_(run.system, run.channels),
      ledger_(run.system.joints(), run.channels),
      maxima_(run.system.joints(), run.channels),
      peaks_(run.adaptive ? statistics_.largest().places().size() : 0,
             run.system.layout().nv() <= run.system.layout().nc()),
      contact_rows_(run.system, run.channels, statistics_, run.adaptive),
      contact_peaks_(contact_rows_.largest().size()),
      storm_(run.model.joints.size() + 1, storm_limits(run.settings, run.adaptive)),
      feed_(run.channels.time, run.channels.all().size()),
      row_(run.channels.all().size(), 0.0),
      row_between_(run.adaptive ? row_.size() : 0, 0.0),
      row_middle_(row_between_.size(), 0.0),
      row_aside_(row_between_.size(), 0.0),
      residual_(at(run.system.layout().nc())) {
  for (int j = 0; j < run.system.joints().count(); ++j) {
    const JointColumns& columns = run.channels.joints[at(j)];
    if (columns.normal_force >= 0 || columns.penetration >= 0) touching_.push_back(j);
  }
}

bool Recorder::observe_start() {
  Fault fault;
  if (!observer_.observe(run_.accepted, run_.e_accepted, row_, fault)) {
    return failure_.fail_with(fault, run_.accepted.t());
  }
  run_.energy.start(run_.e_accepted, run_.accepted.lambda(), run_.channels, row_);
  return row_is_known_ = true;
}

// The channels of the accepted state: asked for by rows, statistics, stop conditions and warnings, and seldom by all
// steps.
bool Recorder::know_row() {
  if (row_is_known_) return true;
  Fault fault;
  if (!run_.adaptive &&
      !run_.system.joints().evaluate_coordinates(point(run_.accepted), term_coordinate, run_.e_accepted))
    return failure_.fail_with(run_.e_accepted->fault, run_.accepted.t());
  if (!observer_.observe(run_.accepted, run_.e_accepted, row_, fault)) {
    return failure_.fail_with(fault, run_.accepted.t());
  }
  run_.energy.fill(run_.e_accepted, run_.channels, row_);
  return row_is_known_ = true;
}

// A joint that sleeps is in flight, as in the row before it fell asleep; one that never touched
// says how far it is from touching.
bool Recorder::know_loads() {
  if (loads_are_known()) return true;
  const bool row_is_due = !(run_.accepted.t() < row_time(next_row_ - 1));
  if (run_.adaptive || feed_.active() || contact_rows_.active() || row_is_due) return know_row();
  observer_.observe_loads(run_.accepted, run_.e_accepted, row_);
  if (!know_contacts()) return false;
  run_.energy.fill(run_.e_accepted, run_.channels, row_, EnergyAccount::Part::sums);
  return loads_are_known_ = true;
}

bool Recorder::know_contacts() {
  const LargestValues& largest = statistics_.largest();
  Fault fault;
  for (const int j : touching_) {
    if (run_.evaluations.is_asleep(j) && largest.before()[largest.places().penetration(j)] >= 0.0) continue;
    if (!observer_.observe_own(j, point(run_.accepted), run_.e_accepted, run_.accepted.lambda(), row_, fault))
      return failure_.fail_with(fault, run_.accepted.t());
  }
  return contacts_are_known_ = true;
}

// A step in the part that `discard` leaves out, of which nothing is asked but largest values: no row, no output, no
// doubt whether to go on.
bool Recorder::is_left_out() const {
  return !run_.adaptive && !feed_.active() && !contact_rows_.active() && run_.outcome.steps % whole_look != 0 &&
         run_.accepted.t() < row_time(next_row_ - 1) && run_.solver.regularity() >= near_singular &&
         !run_.watch.is_due(run_.e_accepted);
}

bool Recorder::record_step() {
  const Profile::Timer timer(run_.evaluations.profile, Phase::statistics);
  if (difference_.is_due(run_.accepted.t())) {
    difference_.follow(run_.accepted);
    statistics_.largest().note_growth(difference_.grown());
  }
  double position = 0.0, velocity = 0.0;
  for (std::size_t r = 0; r < residual_.size(); ++r) position = std::max(position, std::abs(run_.e_accepted->phi[r]));
  run_.watch.add_open(position);
  if (!(position <= open_rows * run_.system.size())) return failure_.fail(4, failure_.why_open(position));
  const bool counts = statistics_.counts(run_.accepted.t());
  const bool noise = statistics_.largest().noise().active();
  if (!counts && !noise && !feed_.active()) return true;
  if (!counts && is_left_out()) {
    if (!know_contacts()) return false;
    run_.energy.fill(run_.e_accepted, run_.channels, row_, EnergyAccount::Part::losses);
    LargestValues& largest = statistics_.largest();
    left_out_.see(run_.accepted, run_.e_accepted, largest);
    for (const int j : touching_) left_out_.see_contact(j, row_, largest);
    return true;
  }
  if (!(counts ? know_row() : know_loads())) return false;
  if (!counts) {
    if (noise) {
      statistics_.note(row_);
      if (run_.adaptive) look_back();
    }
    give_step();
    return true;
  }
  run_.system.jacobian().multiply(run_.e_accepted->jacobian, run_.accepted.v(), residual_);
  for (std::size_t r = 0; r < residual_.size(); ++r) {
    velocity = std::max(velocity, std::abs(residual_[r] - run_.e_accepted->nu[r]));
  }
  statistics_.add(row_, run_.energy.driver_work(), run_.energy.joint_loss(), run_.energy.force_work(), position,
                  velocity);
  clearances_.add(row_, run_.e_accepted, run_.energy.joint_loss());
  if (run_.adaptive && run_.ended_abruptly) statistics_.begin_stretch();
  if (run_.adaptive) look_back();
  give_step();
  return true;
}

// After the swap the step begins at the trial state. In fixed steps rows inside come from here, too.
void Recorder::give_step() {
  if (!feed_.active()) return;
  bool looked = false;
  const Ends step{run_.trial, run_.e_trial, run_.accepted, run_.e_accepted};
  const auto look = [&](double t) {
    looked = true;
    if (!observe_inside(t, step, feed_.inside())) return false;
    run_.energy.fill_inside((t - step.start.t()) / (step.end.t() - step.start.t()), run_.e_between,
                            run_.between.lambda(), run_.channels, feed_.inside());
    return true;
  };
  if (!run_.adaptive && run_.outcome.time > run_.settings.start) {
    feed_.give_instants(step.start.t(), step.end.t(), [&](double t) {
      if (!look(t)) feed_.look_straight(t, row_);
      return true;
    });
  }
  feed_.give_step(row_, look);
  if (looked) run_.energy.fill(run_.e_accepted, run_.channels, row_);  // the account was asked about the inside
}

// Into the step that was just accepted.
void Recorder::look_back() {
  if (run_.ended_abruptly) return peaks_.restart(run_.accepted.t(), statistics_.largest().last());
  const Ends step{run_.trial, run_.e_trial, run_.accepted, run_.e_accepted};
  if (contact_rows_.active()) see_contact_end(row_);
  doubt_forces(step, step.end.t());
  seek_peaks(step);
  if (contact_rows_.active()) seek_contact_peaks(step);
  if (!contact_rows_.active() && !feed_.active()) return;
  run_.energy.fill(run_.e_accepted, run_.channels, row_);  // the account was asked about the inside
}

// What could not be written is written when the run is resumed: until then no row stands in the files that the run
// would not have without the failure.
bool Recorder::write_row() {
  const Profile::Timer timer(run_.evaluations.profile, Phase::output);
  if (run_.outcome.exit_code == exit_cannot_write || !know_row()) return false;
  if (contact_rows_.active()) contact_rows_.give_before_row(run_.accepted.t(), giving());
  ++run_.outcome.rows;
  statistics_.note_written(row_);
  slips_.add(row_, run_.e_accepted);
  for (Sink* sink : sinks_) sink->row(row_);
  return sinks_are_well();
}

bool Recorder::write_events() {
  maxima_.raise(run_.events);
  run_.outcome.events += static_cast<long>(run_.events.happenings().size());
  const Profile::Timer timer(run_.evaluations.profile, Phase::events);
  if (ledger_.active()) {
    Fault fault;
    if (!contacts_are_known_ && !know_loads()) return false;
    if (!ledger_.take_step(row_, run_.energy.joint_loss(), run_.events, point(run_.accepted), run_.e_accepted, fault))
      return failure_.fail_with(fault, run_.accepted.t());
  }
  for (std::size_t i = 0; i < run_.events.happenings().size(); ++i) {
    const StepEvents::Happening& happening = run_.events.happenings()[i];
    const EventRole role = event_role(run_.system.joints().layout(happening.joint), at(happening.event));
    const ContactRecord* ended = ledger_.ended(i);
    if (role == EventRole::contact_begin) statistics_.add_contact(happening.joint, happening.time);
    if (ended != nullptr) {
      statistics_.counts(happening.time) ? clearances_.add_contact(happening.joint, happening.time, *ended)
                                         : clearances_.add_contact_before(happening.joint, *ended);
    }
    statistics_.largest().note_event(happening.joint, happening.event, run_.events.fields(happening));
    contact_rows_.pass(happening.joint, happening.event, happening.time, run_.events.fields(happening));
    for (Sink* sink : sinks_) {
      sink->event({happening.time, happening.joint, happening.event, run_.events.fields(happening), ended});
    }
    const EventStorm::Finding found = storm_.note(happening.joint, happening.time, run_.outcome.steps);
    if (found.events > 0) return failure_.fail_in_storm(happening, found);
  }
  if (run_.events.switched()) {
    const int switches = static_cast<int>(run_.model.joints.size());
    const EventStorm::Finding found = storm_.note(switches, run_.accepted.t(), run_.outcome.steps);
    if (found.events > 0 && run_.adaptive) return failure_.fail_in_switching(found);
  }
  if (contact_rows_.active() && !write_contact_rows()) return false;
  return run_.events.happenings().empty() || sinks_are_well();
}

// After a step. The ends of those that an accuracy chooses were seen before their inside was looked at, unless an event
// came between.
bool Recorder::write_contact_rows() {
  if (!know_row()) return false;
  if (!run_.adaptive || run_.ended_abruptly) {
    contact_rows_.see_end(row_);
    contact_peaks_.restart(run_.accepted.t(), contact_rows_.values(row_));
  }
  contact_rows_.give_after_step(giving());
  return sinks_are_well();
}

void Recorder::write_held_rows() {
  if (contact_rows_.active() && run_.outcome.exit_code != exit_cannot_write) contact_rows_.give_all(giving());
}

void Recorder::write_open_contacts() {
  const bool goes_on = run_.outcome.status == RunStatus::interrupted || run_.outcome.exit_code == exit_cannot_write;
  for (const ContactLedger::Open& open : ledger_.open()) {
    clearances_.add_open_contact(open.joint, open.record);
    if (goes_on || open.event < 0) continue;
    ++run_.outcome.events;
    for (Sink* sink : sinks_) sink->open_contact({run_.accepted.t(), open.joint, open.event, {}, &open.record});
  }
}

ContactRows::Give Recorder::giving() {
  return [this](std::span<const double> row, bool of_grid) {
    ++run_.outcome.rows;
    statistics_.note_written_later(row);
    for (Sink* sink : sinks_) of_grid ? sink->row(row) : sink->row_in_contact(row);
  };
}

// What a sink was given may fail later, beside the run: a row or an event to come finds it.
bool Recorder::sinks_are_well() {
  for (const Sink* sink : sinks_) {
    if (!sink->ok()) return failure_.fail(exit_cannot_write, "a result file could not be written");
  }
  return true;
}

double Recorder::row_time(long index) const {
  const double t = run_.settings.start + static_cast<double>(index) * run_.settings.interval;
  return t > run_.settings.end - 1e-9 * run_.settings.interval ? run_.settings.end : t;
}

double Recorder::instant_at(double t, double within) const {
  const double index = std::round((t - run_.settings.start) / run_.settings.interval);
  if (!(std::abs(index) < 1e15)) return t;
  const double instant = row_time(static_cast<long>(index));
  return std::abs(t - instant) <= within ? instant : t;
}

void Recorder::pass_rows() {
  while (next_row_time() <= run_.accepted.t() && run_.accepted.t() < run_.settings.end) ++next_row_;
}

bool Recorder::write_rows_inside() {
  if (!feed_.give_instants(run_.accepted.t(), run_.trial.t(), [&](double t) { return see_at(t, feed_.inside()); }))
    return false;
  while (row_time(next_row_) < run_.trial.t()) {
    if (!begin_statistics_inside(row_time(next_row_)) || !write_row_at(row_time(next_row_))) return false;
    ++next_row_;
  }
  return begin_statistics_inside(run_.trial.t());
}

bool Recorder::see_ahead(double t, std::span<double> row) {
  const bool inside = t < run_.trial.t();
  if (inside && !inside_.look_inside(t)) return false;
  const State& state = inside ? run_.between : run_.trial;
  Fault fault;
  return observer_.observe(state, inside ? run_.e_between : run_.e_trial, row, fault) || failure_.fail_with(fault, t);
}

// The row at t inside of the step that is being accepted. False when the run is over.
bool Recorder::see_at(double t, std::span<double> row) {
  if (!see_ahead(t, row)) return false;
  const double dt = run_.trial.t() - run_.accepted.t(), s = (t - run_.accepted.t()) / dt;
  if (run_.flows > 0 && run_.inner.known()) {
    const std::span<const double> integrals = std::span<const double>(run_.between.z()).last(at(run_.flows));
    run_.energy.fill_inside(s, run_.e_between, run_.between.lambda(), integrals, run_.channels, row);
  } else if (run_.energy.bends(s, run_.e_between, run_.between.lambda())) {
    if (!inside_.look_inside(run_.accepted.t() + (s <= 0.5 ? 0.5 * s : 0.5 + 0.5 * s) * dt)) return false;
    run_.energy.see_half_way(run_.e_between, run_.between.lambda());
    if (!inside_.look_inside(t)) return false;
    run_.energy.fill_bent(s, run_.e_between, run_.between.lambda(), run_.channels, row);
  } else {
    run_.energy.fill_inside(s, run_.e_between, run_.between.lambda(), run_.channels, row);
  }
  return true;
}

bool Recorder::write_row_at(double t) {
  const Profile::Timer timer(run_.evaluations.profile, Phase::output);
  if (!see_at(t, row_between_)) return false;
  run_.watch.add_inside(row_between_);
  slips_.add(row_between_, run_.e_between);
  maxima_.see(row_between_);
  feed_.see_inside(row_between_);
  if (contact_rows_.active()) {
    if (!contact_rows_.idle()) {
      statistics_.note_inside(row_between_);
      contact_rows_.hold(row_between_);
      return true;
    }
    contact_rows_.give_before_row(t, giving());
  }
  ++run_.outcome.rows;
  statistics_.note_written(row_between_);
  for (Sink* sink : sinks_) sink->row(row_between_);
  doubt_forces({run_.accepted, run_.e_accepted, run_.trial, run_.e_trial}, t);
  return sinks_are_well();
}

bool Recorder::note_change() {
  const Profile::Timer timer(run_.evaluations.profile, Phase::statistics);
  forget_row();
  if (!know_row()) return false;
  if (!statistics_.counts(run_.accepted.t())) {
    statistics_.note(row_);
  } else {
    statistics_.add(row_, run_.energy.driver_work(), run_.energy.joint_loss(), run_.energy.force_work(), 0.0, 0.0);
    if (run_.adaptive) statistics_.begin_stretch();
    clearances_.add(row_, run_.e_accepted, run_.energy.joint_loss());
  }
  if (run_.adaptive) peaks_.restart(run_.accepted.t(), statistics_.largest().last());
  if (!contact_rows_.active()) return true;
  contact_rows_.see_end(row_);
  contact_peaks_.restart(run_.accepted.t(), contact_rows_.values(row_));
  return true;
}

}  // namespace freeplay
