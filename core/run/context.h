// RunContext: what all parts of a run share: the mechanism, where it is, and the step that is being made.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "assembly/assembly.h"
#include "model/channel.h"
#include "run/drive_kinks.h"
#include "run/energy_account.h"
#include "run/equations.h"
#include "run/idle_loads.h"
#include "run/inner_motion.h"
#include "run/missed_forces.h"
#include "run/outcome.h"
#include "run/path_edges.h"
#include "run/sleeping_joints.h"
#include "run/step_events.h"
#include "run/watch.h"
#include "stage/newton_stage_solver.h"

namespace freeplay {

inline constexpr double rounding = std::numeric_limits<double>::epsilon();
/// Regularity below which no motion is interpolated and steps that fail are tried in other lengths.
inline constexpr double near_singular = 1e-2;
inline constexpr unsigned terms_of_equations = term_position | term_velocity | term_force;
inline constexpr unsigned all_terms = terms_of_equations | term_coordinate;

/// "the integrator of type 'NAME'": how messages name it.
std::string integrator_words(const Model& model);

struct RunContext {
  [[gnu::cold]] RunContext(std::shared_ptr<const RunEquations> all_equations, const Channels& all_channels);

  /// What outlives a step: `between` may keep memory of the integrator, and evaluations hold what the next ones compare
  /// themselves with.
  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.accepted, self.between, self.evaluations, self.e_accepted, self.e_trial);
    if (self.own_between) archive(*self.own_between);
    archive(self.solver, self.energy, self.events, self.kinks, self.idle_loads, self.sleeping, self.watch);
    archive(self.ended_inside, self.ended_abruptly, self.missed);
    archive.list(self.first_forces);
    auto& counts = self.outcome;
    archive(counts.smallest_step, counts.largest_step, counts.steps, counts.rejected, counts.rows, counts.events);
  }
  /// Of model, integrator and start: what the state of a run has in common with the run that goes on from it.
  Archive features() const;

  std::shared_ptr<const RunEquations> equations;
  const System& system;           ///< of the unknowns
  EvaluationContext evaluations;  ///< sleeping joints, profile, steps in a contact
  const Model& model;
  const Settings& settings;
  const Channels& channels;
  EnergyAccount energy;
  IntegratorLayout integrator_layout;
  bool adaptive;
  int flows;  ///< integrals that the integrator carries along
  NewtonStageSolver solver;
  State accepted, trial, between;
  KeptEvaluation e_accepted, e_trial;
  std::optional<KeptEvaluation> own_between;  // with error control
  KeptEvaluation& e_between;                  // else the solver's, whose contents it does not need between its calls
  StepEvents events;
  SleepingJoints sleeping;
  DriveKinks kinks;  ///< of prescribed motions
  PathEdges path_edges;
  IdleLoads idle_loads;
  RunWatch watch;
  InnerMotion inner;  ///< of the step that was made last, where a row or a peak was sought inside
  MissedForces missed;
  Outcome outcome;
  std::vector<std::string> warnings;
  std::vector<double> z_rate;  ///< room for z'
  MotionWork motion_work;
  std::vector<double> first_forces;  ///< of springs and the like, by joint, at the start [N]
  double allowed = 0.0;              ///< by which positions may err in one step, with error control [m]

  // The last attempt.
  Fault plugin_fault{};
  double error = 0.0;
  bool left_bounds = false;    ///< it ended with numbers that are not finite
  bool ended_inside = false;   ///< it was cut short at an event: the integrator has no memory of its end
  long restarts = 0;           ///< of the integrator: after each the accelerations at the accepted state may be others
  bool ended_abruptly = true;  ///< the last step: at an event or a kink, after which values change abruptly
};

/// Power of the step size with which the integrator's error estimate falls.
int error_power(const IntegratorLayout& layout);

/// Part of the accuracy per second that one step may cost.
inline constexpr double accuracy_per_step = 0.15;

/// By how much a step may err [m].
double local_tolerance(const System& system);

}  // namespace freeplay
