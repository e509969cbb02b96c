// Simulation: the only loop over time.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "assembly/warm_start.h"
#include "model/channel.h"
#include "run/clearance_statistics.h"
#include "run/equations.h"
#include "run/goal.h"
#include "run/hooks.h"
#include "run/outcome.h"
#include "run/requirements.h"
#include "run/saved_state.h"
#include "run/sink.h"
#include "run/statistics.h"
#include "run/watch.h"

namespace freeplay {

/// Drivers of a model whose efforts are inputs, in declaration order.
std::vector<int> inputs_of(const Model& model);

/// What a joint remembers: its share of z and h.
struct JointMemory {
  std::vector<double> internal, history;
};

/// Advances a model from its start to Settings::end and feeds sinks and statistics.
class Simulation {
 public:
  /// Simulations that share equations may run at the same time, in threads of their own.
  Simulation(std::shared_ptr<const RunEquations> equations, const Channels& channels, std::span<Sink* const> sinks);
  /// With equations of its own. `whole` and `start` must outlive the simulation.
  Simulation(const System& whole, const Start& start, const Channels& channels, std::span<Sink* const> sinks);
  /// Goes on from `state`, which was saved in a run of the same model with the same start and channels; the sinks get
  /// what comes next. Throws Error{input} "state-mismatch" where it is the state of something else.
  Simulation(const System& whole, const Start& start, const Channels& channels, std::span<Sink* const> sinks,
             const RunState& state);
  ~Simulation();
  Outcome run(const RunHooks& hooks);

  /// The same in parts: begin(), any number of advance(), end(). `hooks` must stay until then.
  void begin(const RunHooks& hooks);
  /// Goes on to `goal`. False once the run is over: at its end, stopped, failed or interrupted.
  bool advance(const RunGoal& goal);
  /// Before the end of the run the outcome is that it was stopped.
  Outcome end();
  double time() const;
  long steps() const;
  /// Efforts of drivers that are inputs, in declaration order, from the accepted state on [N, N m].
  void set_efforts(std::span<const double> efforts);
  std::vector<double> efforts() const;
  /// Every channel at the accepted state, with what was set there. False once the run is over.
  bool know_row();

  /// The run as it is while RunHooks::stepped is called.
  RunState save() const;
  /// The last accepted state, of all bodies.
  EndedMotion motion() const;
  /// Of all joints there.
  std::vector<JointMemory> memory() const;
  const Statistics& statistics() const;
  const ClearanceStatistics& clearances() const;
  const RunExtremes& extremes() const;
  /// The last accepted row, every channel.
  std::span<const double> last_row() const;
  /// Warnings met on the way, such as a law used outside its range.
  std::span<const std::string> warnings() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace freeplay
