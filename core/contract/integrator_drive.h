// IntegratorDrive: steps a reference system with an integrator as the host does, and watches what it writes.
#pragma once

#include <memory>

#include "component/integrator_ref.h"
#include "contract/conditions.h"
#include "contract/finding.h"
#include "contract/guarded_numbers.h"
#include "contract/reference_system.h"
#include "stage/newton_stage_solver.h"

namespace freeplay {

/// The numbers of a state, each kind in an array of its own that is guarded.
class GuardedState {
 public:
  GuardedState(const Layout& layout, int memory);
  StateView view() { return {t.span().data, q.span(), v.span(), a.span(), lambda.span(), z.span(), memory.span()}; }
  bool intact() const;
  bool finite() const;
  std::vector<double> bits() const;

  GuardedNumbers t, q, v, a, lambda, z, memory;
};

/// A stage solver that gives up at one of the stages: the one after `good_stages` others, none where these are
/// negative.
class FailingStageSolver : public NewtonStageSolver {
 public:
  FailingStageSolver(const System& system, const ConvergenceParameters& parameters, int good_stages);
  const abi::StageSolverTable& table() const { return table_; }
  bool solve(const Stage& stage, StateView& out, StageResult& result);
  int stages() const { return stages_; }

 private:
  abi::StageSolverTable table_;
  int good_stages_, stages_ = 0;
};

class IntegratorDrive {
 public:
  /// `tolerance`: of the stages, at most; the integrator's own if that is smaller.
  IntegratorDrive(const IntegratorRef& integrator, const ReferenceSystem& reference, double tolerance,
                  const Conditions& conditions, Findings& findings);

  const IntegratorLayout& layout() const { return layout_; }
  const GuardedState& accepted() const { return accepted_; }
  /// Consistent start and restart(). False when something fails, which is noted.
  bool start();
  /// One attempt from the accepted state, which becomes the accepted one. False when it does not converge.
  bool step(double dt);
  /// One attempt with a solver that has solved nothing before and scratch filled with `scratch`; nothing is accepted.
  /// With `good_stages` >= 0 the stage after these gives up. Empty when the call fails.
  std::vector<double> attempt(double dt, double scratch, int good_stages, bool& converged, int& stages);
  /// Error that one attempt from the accepted state estimates, and about the true one, where `tolerance` [m] is
  /// allowed: how much further it is from the known motion at its end than at its start. Nothing is accepted.
  double estimate(double dt, double tolerance, double& truth, const KnownState& now, const KnownState& end);
  /// Largest residuals of the accepted state: position [model sizes] and velocity [m/s].
  void residuals(double& position, double& velocity);

 private:
  bool call_attempt(double dt, GuardedState& to, GuardedNumbers& scratch, const abi::StageSolverTable& solver,
                    bool watch_allocations, Attempt& attempt);

  IntegratorRef integrator_;
  const ReferenceSystem& reference_;
  Conditions conditions_;
  Findings& findings_;
  IntegratorLayout layout_;
  ConvergenceParameters parameters_;
  std::unique_ptr<NewtonStageSolver> solver_;
  GuardedState accepted_, trial_;
  GuardedNumbers scratch_;
  Evaluation evaluation_;
  int steps_ = 0;
};

}  // namespace freeplay
