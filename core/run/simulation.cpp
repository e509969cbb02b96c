#include "run/simulation.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/index.h"
#include "run/adaptive_run.h"
#include "run/fixed_run.h"

namespace freeplay {

std::vector<int> inputs_of(const Model& model) {
  std::vector<int> inputs;
  for (std::size_t d = 0; d < model.drivers.size(); ++d) {
    if (model.drivers[d].input) inputs.push_back(static_cast<int>(d));
  }
  return inputs;
}

// The parts of a run, each of which knows those above it.
struct Simulation::Impl {
  Impl(std::shared_ptr<const RunEquations> equations, const Channels& channels, std::span<Sink* const> sinks)
      : context(std::move(equations), channels),
        inputs(inputs_of(context.model)),
        recorder(context, failure, attempt, inside, sinks) {}

  void begin(const RunHooks& hooks);
  bool advance(RunGoal goal);
  bool know_row();
  bool renew();
  std::span<double> input(std::size_t index);
  std::vector<double> acting_efforts();
  const Outcome& finish();
  [[gnu::cold]] RunState save() const;
  EndedMotion motion() const;
  void restore(const RunState& state);
  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.context, self.attempt, self.recorder, self.doubts, self.growth, self.corners, self.motion_loads,
            self.stop, self.fixed, self.adaptive);
  }

  RunContext context;
  const std::vector<int> inputs;    // drivers
  bool goes_on = false;             // from a saved state
  const RunHooks* hooks = nullptr;  // from its begin on
  bool over = false;
  std::vector<double> efforts;  // that were set, by input; empty: none was
  RunFailure failure{context};
  StepAttempt attempt{context, failure};
  StepInside inside{context, failure, attempt};
  Recorder recorder;
  RunDoubts doubts{context, failure, recorder};
  EnergyGrowth growth{context};
  Corners corners{context, failure, attempt};
  MotionLoads motion_loads{context};
  StepCorners step_corners{context, attempt};
  StepAcceptance acceptance{context, failure, attempt, recorder, doubts, growth, corners, step_corners};
  EventPursuit pursuit{context, failure, attempt, inside};
  EndCheck end{context};
  StopSearch stop{context, recorder};
  RunParts parts{context, failure, attempt, acceptance, recorder, growth, corners, motion_loads, end, stop};
  FixedRun fixed{parts, step_corners};
  AdaptiveRun adaptive{parts, pursuit};
};

void Simulation::Impl::begin(const RunHooks& run_hooks) {
  hooks = &run_hooks;
  end.start_clock();
  context.evaluations.profile = run_hooks.profile;
  if (run_hooks.profile != nullptr) run_hooks.profile->start();
  if (run_hooks.blind_to_inputs) corners.go_blind(), motion_loads.go_blind();
  recorder.feed(run_hooks.steps);
  context.outcome.time = context.accepted.t();
  over = !goes_on && !(acceptance.begin() && recorder.write_row());
  if (!over && context.outcome.steps == 0) over = !stop.look_at_start();
  end.pause_clock();
}

// An instant that is that of a row but for rounding is that very instant.
bool Simulation::Impl::advance(RunGoal goal) {
  constexpr double same_instant = 1e-6;  // of a step
  if (over) return false;
  end.start_clock();
  goal.until = recorder.instant_at(goal.until, same_instant * context.settings.step);
  over = !renew() || !(context.adaptive ? adaptive.advance(*hooks, goal) : fixed.advance(*hooks, goal));
  end.pause_clock();
  return !over;
}

// Other efforts act from the accepted state on, as after an event.
bool Simulation::Impl::renew() {
  if (efforts.empty()) return true;
  bool changed = false;
  const std::vector<double> acting = acting_efforts();
  for (std::size_t i = 0; i < efforts.size(); ++i) {
    if (acting[i] == efforts[i]) continue;
    changed = true;
    const std::span<double> kept = input(i);
    kept[0] = 1.0;
    kept[1] = efforts[i];
  }
  return !changed || (attempt.restart() && recorder.note_change());
}

bool Simulation::Impl::know_row() {
  if (!over) over = !renew() || !recorder.know_row();
  return !over;
}

const Outcome& Simulation::Impl::finish() {
  Outcome& outcome = context.outcome;
  if (!over && context.accepted.t() < context.settings.end) {
    outcome.status = RunStatus::stopped;
    outcome.reason = fmt::format("closed at t = {:.9g} s", context.accepted.t());
    know_row();  // of the summary
  }
  recorder.write_open_contacts();
  outcome.wall_seconds = end.spent();
  context.watch.note_exchanged(context.energy.exchanged());
  const bool at_dead_point = failure.explain_dead_point();
  if (hooks->profile != nullptr) hooks->profile->stop();
  context.evaluations.profile = nullptr;
  outcome.iterations = context.solver.iterations();
  outcome.factorizations = context.solver.factorizations();
  doubts.format_warnings();
  doubts.note_unused_play();
  // Of forces and steps that grow without bound towards a dead point nothing else is to be said.
  if (!at_dead_point) {
    doubts.note_damped_peaks();
    doubts.judge_motion();
    doubts.note_lasting_blows();
    adaptive.doubt_steps();
  }
  failure.explain_failure();
  corners.format_jumps();
  corners.format_unresolved();
  motion_loads.format();
  context.missed.say(context);
  recorder.slips().say(context);
  return outcome;
}

// Of an input: whether it was set, and what it is.
std::span<double> Simulation::Impl::input(std::size_t index) {
  const std::size_t after = inputs.size() - index, size = Layout::numbers_of_input;
  return context.accepted.h().last(after * size).first(size);
}

std::vector<double> Simulation::Impl::acting_efforts() {
  std::vector<double> acting;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const std::span<const double> kept = input(i);
    acting.push_back(kept[0] != 0.0 ? kept[1] : context.model.drivers[at(inputs[i])].value.constant().value);
  }
  return acting;
}

RunState Simulation::Impl::save() const {
  RunState out{.time = context.accepted.t(),
               .steps = context.outcome.steps,
               .rows = context.outcome.rows,
               .features = context.features()};
  ArchiveWriter write(out.numbers);
  exchange(*this, write);
  return out;
}

EndedMotion Simulation::Impl::motion() const {
  const State& state = context.accepted;
  const Layout &whole = context.equations->whole().layout(), &own = context.system.layout();
  const Evaluation& e = context.e_accepted;  // which has driven bodies, too
  const auto q = at(whole.body_coordinates()), v = at(whole.body_velocities());
  EndedMotion out{.t = state.t(),
                  .q = std::vector<double>(e.q.size()),
                  .v = std::vector<double>(e.v.size()),
                  .z = {state.z().begin(), state.z().begin() + whole.nz()},
                  .h = {state.h().begin(), state.h().end()}};
  for (int body = 0; body < static_cast<int>(context.model.bodies.size()); ++body) {
    const std::size_t from = at(own.place(body)), to = at(whole.place(body));
    std::copy_n(&e.q[q * from], q, &out.q[q * to]);
    std::copy_n(&e.v[v * from], v, &out.v[v * to]);
  }
  return out;
}

void Simulation::Impl::restore(const RunState& state) {
  ArchiveReader::require(state.features == context.features());
  ArchiveReader read(state.numbers);
  exchange(*this, read);
  read.finish();
  goes_on = true;
}

Simulation::Simulation(std::shared_ptr<const RunEquations> equations, const Channels& channels,
                       std::span<Sink* const> sinks)
    : impl_(std::make_unique<Impl>(std::move(equations), channels, sinks)) {}
Simulation::Simulation(const System& whole, const Start& start, const Channels& channels, std::span<Sink* const> sinks)
    : Simulation(std::make_shared<const RunEquations>(whole, start), channels, sinks) {}
Simulation::Simulation(const System& whole, const Start& start, const Channels& channels, std::span<Sink* const> sinks,
                       const RunState& state)
    : Simulation(whole, start, channels, sinks) {
  impl_->restore(state);
}
Simulation::~Simulation() = default;
RunState Simulation::save() const { return impl_->save(); }
EndedMotion Simulation::motion() const { return impl_->motion(); }
std::vector<JointMemory> Simulation::memory() const {
  const RunContext& context = impl_->context;
  const auto part = [](std::span<const double> all, const Slice& slice) {
    const auto own = all.subspan(at(slice.offset), at(slice.size));
    return std::vector<double>(own.begin(), own.end());
  };
  std::vector<JointMemory> all;
  for (int j = 0; j < context.system.joints().count(); ++j) {
    const Layout& layout = context.system.layout();
    all.push_back({part(context.accepted.z(), layout.internal(j)), part(context.accepted.h(), layout.history(j))});
  }
  return all;
}
Outcome Simulation::run(const RunHooks& hooks) {
  begin(hooks);
  advance({});
  return end();
}
void Simulation::begin(const RunHooks& hooks) { impl_->begin(hooks); }
bool Simulation::advance(const RunGoal& goal) { return impl_->advance(goal); }
Outcome Simulation::end() { return impl_->finish(); }
bool Simulation::know_row() { return impl_->know_row(); }
double Simulation::time() const { return impl_->context.accepted.t(); }
long Simulation::steps() const { return impl_->context.outcome.steps; }
void Simulation::set_efforts(std::span<const double> efforts) { impl_->efforts.assign(efforts.begin(), efforts.end()); }
std::vector<double> Simulation::efforts() const {
  return impl_->efforts.empty() ? impl_->acting_efforts() : impl_->efforts;
}
const Statistics& Simulation::statistics() const { return impl_->recorder.statistics(); }
const ClearanceStatistics& Simulation::clearances() const { return impl_->recorder.clearances(); }
const RunExtremes& Simulation::extremes() const { return impl_->context.watch.seen(); }
std::span<const double> Simulation::last_row() const { return impl_->recorder.row(); }
std::span<const std::string> Simulation::warnings() const { return impl_->context.warnings; }

}  // namespace freeplay
