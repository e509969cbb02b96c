#include "contract/integrator_drive.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "component/declared.h"
#include "stage/solver_table.h"

namespace freeplay {
namespace {

constexpr std::size_t size_of(int count) { return static_cast<std::size_t>(std::max(count, 0)); }

IntegratorLayout declare(const IntegratorRef& integrator, const Layout& sizes, const Conditions& conditions,
                         Findings& findings) {
  IntegratorLayout layout;
  layout.sizes = {sizes.nq(), sizes.nv(), sizes.nc(), sizes.nz()};
  Message message;
  WatchedCall watched(conditions, "declare");
  const bool good = integrator.declare(layout, message);
  watched.end();
  findings.expect("answers", good, [&] { return fmt::format("declare() fails: {}", message.text); });
  const std::string fault = declaration_fault(layout);
  findings.expect("declares-sanely", fault.empty(), [&] { return fault; });
  if (!fault.empty()) layout.memory = layout.scratch = 0;  // what follows must not trip over a wrong count
  return layout;
}

void copy(const std::vector<double>& from, Span<double> to) { std::copy(from.begin(), from.end(), to.begin()); }

}  // namespace

GuardedState::GuardedState(const Layout& layout, int memory_size)
    : t(1),
      q(size_of(layout.nq())),
      v(size_of(layout.nv())),
      a(size_of(layout.nv())),
      lambda(size_of(layout.nc())),
      z(size_of(layout.nz())),
      memory(size_of(memory_size)) {}

bool GuardedState::intact() const {
  return t.intact() && q.intact() && v.intact() && a.intact() && lambda.intact() && z.intact() && memory.intact();
}

std::vector<double> GuardedState::bits() const {
  std::vector<double> all;
  for (const GuardedNumbers* part : {&t, &q, &v, &a, &lambda, &z, &memory}) {
    const std::vector<double> values = part->values();
    all.insert(all.end(), values.begin(), values.end());
  }
  return all;
}

bool GuardedState::finite() const {
  const std::vector<double> all = bits();
  return std::all_of(all.begin(), all.end(), [](double x) { return std::isfinite(x); });
}

FailingStageSolver::FailingStageSolver(const System& system, const ConvergenceParameters& parameters, int good_stages)
    : NewtonStageSolver(system, parameters), table_(stage_solver_table(*this)), good_stages_(good_stages) {}

bool FailingStageSolver::solve(const Stage& stage, StateView& out, StageResult& result) {
  if (stages_++ != good_stages_) return NewtonStageSolver::solve(stage, out, result);
  result = {0, 1};
  return true;
}

IntegratorDrive::IntegratorDrive(const IntegratorRef& integrator, const ReferenceSystem& reference, double tolerance,
                                 const Conditions& conditions, Findings& findings)
    : integrator_(integrator),
      reference_(reference),
      conditions_(conditions),
      findings_(findings),
      layout_(declare(integrator, reference.system().layout(), conditions, findings)),
      parameters_{.tolerance = std::min(tolerance, layout_.newton_tolerance),
                  .max_iterations = std::max(layout_.newton_max_iterations, 1)},
      solver_(std::make_unique<NewtonStageSolver>(reference.system(), parameters_)),
      accepted_(reference.system().layout(), layout_.memory),
      trial_(reference.system().layout(), layout_.memory),
      scratch_(size_of(layout_.scratch)),
      evaluation_(reference.system()) {}

bool IntegratorDrive::start() {
  const KnownState known = reference_.start();
  copy(known.q, accepted_.q.span());
  copy(known.v, accepted_.v.span());
  copy(known.z, accepted_.z.span());
  StateView view = accepted_.view();
  std::vector<double> z_rate(known.z.size());
  if (!solver_->accelerate(view, {z_rate.data(), z_rate.size()})) return false;
  Message message;
  WatchedCall watched(conditions_, "restart");
  const bool good = integrator_.restart(view, solver_->table(), message);
  watched.end();
  findings_.expect("answers", good, [&] { return fmt::format("restart() fails: {}", message.text); });
  findings_.expect("stays-in-span", accepted_.intact(),
                   [] { return std::string("restart() writes beside the state or its memory"); });
  const bool kept = same_bits(accepted_.q.values(), known.q) && same_bits(accepted_.v.values(), known.v);
  findings_.expect("restart", kept, [] { return std::string("restart() changes positions or velocities"); });
  return good && accepted_.intact();
}

bool IntegratorDrive::call_attempt(double dt, GuardedState& to, GuardedNumbers& scratch,
                                   const abi::StageSolverTable& solver, bool watch_allocations, Attempt& attempt) {
  StateView view = to.view();
  Message message;
  WatchedCall watched(conditions_, "attempt");
  const bool good = integrator_.attempt(dt, view, scratch.span(), solver, attempt, message);
  const long allocated = watched.end();
  findings_.expect("answers", good, [&] { return fmt::format("attempt() fails: {}", message.text); });
  if (conditions_.allocations && watch_allocations) {
    findings_.expect("allocation", allocated == 0 || !good, [&] {
      return fmt::format("{}: attempt() allocates, {} in one step", reference_.name(), allocated);
    });
  }
  findings_.expect("stays-in-span", to.intact() && scratch.intact(),
                   [] { return std::string("attempt() writes beside the state, its memory or the scratch"); });
  const bool sane =
      std::isfinite(attempt.error) && attempt.error >= 0.0 && (layout_.error_estimate != 0 || attempt.error == 0.0);
  findings_.expect("error-estimate", !good || attempt.converged == 0 || sane, [&] {
    return fmt::format("the error is {}, declared with{} estimate", attempt.error, layout_.error_estimate ? "" : "out");
  });
  return good && to.intact() && scratch.intact();
}

bool IntegratorDrive::step(double dt) {
  trial_ = accepted_;
  Attempt attempt{};
  // The solver may size its work space in the first steps.
  const bool good = call_attempt(dt, trial_, scratch_, solver_->table(), steps_ >= 3, attempt);
  ++steps_;
  if (!good || attempt.converged == 0) return false;
  const double expected = accepted_.t.values()[0] + dt, reached = trial_.t.values()[0];
  findings_.expect("time", std::abs(reached - expected) <= 1e-12 * (1.0 + std::abs(expected)),
                   [&] { return fmt::format("a step to {} s ends at {} s", expected, reached); });
  if (!findings_.expect("finite", trial_.finite(), [] { return std::string("a number in the state is not finite"); })) {
    return false;
  }
  std::swap(accepted_, trial_);
  return true;
}

std::vector<double> IntegratorDrive::attempt(double dt, double scratch, int good_stages, bool& converged, int& stages) {
  FailingStageSolver solver(reference_.system(), parameters_, good_stages);
  GuardedState to = accepted_;
  GuardedNumbers work(size_of(layout_.scratch), scratch);
  Attempt attempt{};
  converged = false;
  const bool good = call_attempt(dt, to, work, solver.table(), false, attempt);
  stages = solver.stages();
  if (!good) return {};
  converged = attempt.converged != 0;
  return to.bits();
}

double IntegratorDrive::estimate(double dt, double tolerance, double& truth, const KnownState& now,
                                 const KnownState& end) {
  NewtonStageSolver solver(reference_.system(), parameters_);
  solver.control_error(tolerance, tolerance, 0.0);
  GuardedState to = accepted_;
  solver.local_error().begin_attempt(to.v.span(), to.z.span());
  Attempt attempt{};
  GuardedNumbers scratch(size_of(layout_.scratch), 0.0);
  if (!call_attempt(dt, to, scratch, solver.table(), false, attempt) || attempt.converged == 0) return 0.0;
  std::vector<double> position = to.q.values(), velocity = to.v.values();
  const std::vector<double> q = accepted_.q.values(), v = accepted_.v.values();
  for (std::size_t i = 0; i < position.size(); ++i) position[i] -= end.q[i] + (q[i] - now.q[i]);
  for (std::size_t i = 0; i < velocity.size(); ++i) velocity[i] -= end.v[i] + (v[i] - now.v[i]);
  truth = solver.error_norm(position, velocity);
  return attempt.error;
}

void IntegratorDrive::residuals(double& position, double& velocity) {
  const System& system = reference_.system();
  const std::vector<double> t = accepted_.t.values(), q = accepted_.q.values(), v = accepted_.v.values(),
                            z = accepted_.z.values();
  position = velocity = 0.0;
  if (!system.evaluate({t[0], q, v, z, {}}, term_position | term_velocity, evaluation_)) return;
  std::vector<double> flow(evaluation_.phi.size());
  system.jacobian().multiply(evaluation_.jacobian, v, flow);
  for (std::size_t r = 0; r < flow.size(); ++r) {
    position = std::max(position, std::abs(evaluation_.phi[r]) / system.size());
    velocity = std::max(velocity, std::abs(flow[r] - evaluation_.nu[r]));
  }
}

}  // namespace freeplay
