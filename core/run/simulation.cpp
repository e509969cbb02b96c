#include "run/simulation.h"

#include <algorithm>

#include "base/index.h"
#include "run/adaptive_run.h"
#include "run/fixed_run.h"

namespace freeplay {

// The parts of a run, each of which knows those above it.
struct Simulation::Impl {
  Impl(std::shared_ptr<const RunEquations> equations, const Channels& channels, std::span<Sink* const> sinks)
      : context(std::move(equations), channels), recorder(context, failure, attempt, inside, sinks) {}

  Outcome run(const RunHooks& hooks);
  RunState save() const;
  EndedMotion motion() const;
  void restore(const RunState& state);
  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.context, self.attempt, self.recorder, self.doubts, self.growth, self.corners, self.fixed,
            self.adaptive);
  }

  RunContext context;
  bool goes_on = false;  // from a saved state
  RunFailure failure{context};
  StepAttempt attempt{context, failure};
  StepInside inside{context, failure, attempt};
  Recorder recorder;
  RunDoubts doubts{context, failure, recorder};
  EnergyGrowth growth{context};
  Corners corners{context, failure, attempt};
  StepCorners step_corners{context, attempt};
  StepAcceptance acceptance{context, failure, attempt, recorder, doubts, growth, corners, step_corners};
  EventPursuit pursuit{context, failure, attempt, inside};
  EndCheck end{context, recorder};
  RunParts parts{context, failure, attempt, acceptance, recorder, growth, corners, end};
  FixedRun fixed{parts, step_corners};
  AdaptiveRun adaptive{parts, pursuit};
};

Outcome Simulation::Impl::run(const RunHooks& hooks) {
  end.start_clock();
  context.evaluations.profile = hooks.profile;
  if (hooks.profile != nullptr) hooks.profile->start();
  if (hooks.blind_to_inputs) corners.go_blind();
  recorder.feed(hooks.steps);
  Outcome& outcome = context.outcome;
  outcome.time = context.accepted.t();
  if (goes_on || (acceptance.begin() && recorder.write_row())) {
    context.adaptive ? adaptive.run(hooks) : fixed.run(hooks);
  }
  recorder.write_open_contacts();
  outcome.wall_seconds = end.seconds();
  context.watch.note_exchanged(context.energy.exchanged());
  failure.explain_dead_point();
  if (hooks.profile != nullptr) hooks.profile->stop();
  context.evaluations.profile = nullptr;
  outcome.iterations = context.solver.iterations();
  outcome.factorizations = context.solver.factorizations();
  doubts.format_warnings();
  doubts.note_unused_play();
  failure.explain_failure();
  corners.format_jumps();
  corners.format_unresolved();
  return outcome;
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
Outcome Simulation::run(const RunHooks& hooks) { return impl_->run(hooks); }
const Statistics& Simulation::statistics() const { return impl_->recorder.statistics(); }
const ClearanceStatistics& Simulation::clearances() const { return impl_->recorder.clearances(); }
const RunExtremes& Simulation::extremes() const { return impl_->context.watch.seen(); }
std::span<const double> Simulation::last_row() const { return impl_->recorder.row(); }
std::span<const std::string> Simulation::warnings() const { return impl_->context.warnings; }

}  // namespace freeplay
