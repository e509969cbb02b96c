// Simulation: the only loop over time.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "assembly/assembly.h"
#include "model/channel.h"
#include "run/run_state.h"
#include "run/sink.h"
#include "run/statistics.h"
#include "run/trust.h"
#include "run/watch.h"
#include "system/system.h"

namespace freeplay {

enum class RunStatus { completed, stopped, failed, interrupted };

/// How a run ended. A failed run keeps everything up to the last accepted step.
struct Outcome {
  RunStatus status = RunStatus::completed;
  int exit_code = 0;          ///< 0, 4 (numerical failure), 5 (a plugin failed), 6 (a sink failed) or 130
  std::string reason;         ///< which condition stopped it, or what failed, where, and what to try; else empty
  double time = 0.0;          ///< reached [s]
  double wall_seconds = 0.0;  ///< from the assembled start to the last accepted step
  double smallest_step = 0.0, largest_step = 0.0;  ///< of the accepted ones [s]; 0 where there are none
  long steps = 0, rejected = 0, iterations = 0, factorizations = 0, rows = 0, events = 0;
  std::vector<TrustReason> doubts{};  ///< what the loop itself found against its numbers
};

struct RunHooks {
  const std::atomic<int>* interrupt = nullptr;  ///< nonzero: end after the present step
  /// Called at most ten times a second: time reached, steps so far.
  std::function<void(double, long)> progress;
  /// Called after every accepted step, when its rows and events are written: the instants at which to save().
  std::function<void()> stepped;
  Profile* profile = nullptr;  ///< told where the time goes
  /// For tests of what finds wrong runs: steps go over what forces and other inputs do inside them.
  bool blind_to_inputs = false;
};

/// Advances a model from its start to Settings::end and feeds sinks and statistics.
class Simulation {
 public:
  /// `system` and `start` must outlive the simulation.
  Simulation(System& system, const Start& start, const Channels& channels, std::span<Sink* const> sinks);
  /// Goes on from `state`, which was saved in a run of the same model with the same start and channels; the sinks get
  /// what comes next. Throws Error{input} "state-mismatch" where it is the state of something else.
  Simulation(System& system, const Start& start, const Channels& channels, std::span<Sink* const> sinks,
             const RunState& state);
  ~Simulation();
  Outcome run(const RunHooks& hooks);
  /// The run as it is while RunHooks::stepped is called.
  RunState save() const;
  const Statistics& statistics() const;
  const RunExtremes& extremes() const;
  /// The last accepted row, every channel.
  std::span<const double> last_row() const;
  /// Warnings met on the way, such as a law used outside its range.
  std::span<const std::string> warnings() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Throws Error{plugin} "plugin-failed" when the integrator cannot tell what it needs.
void require_sound_integrator(const System& system);

/// Throws Error{input} "out-of-range", in the file where it says so, when the error allowed in a step is below the
/// rounding of positions.
void require_attainable_accuracy(const System& system);

}  // namespace freeplay
