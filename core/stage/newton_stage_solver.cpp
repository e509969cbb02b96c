#include "stage/newton_stage_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/index.h"
#include "stage/solver_table.h"

namespace freeplay {
NewtonStageSolver::NewtonStageSolver(const System& system, const ConvergenceParameters& parameters,
                                     EvaluationContext* run)
    : system_(system),
      table_(stage_solver_table(*this)),
      equations_(system, run),
      index_one_(equations_, parameters),
      factors_(equations_),
      floor_(equations_, parameters),
      monitor_(parameters),
      local_error_(equations_, index_one_) {
  const int nv = system.layout().nv(), nc = system.layout().nc();
  right_.resize(at(nv + nc));
  update_.resize(at(nv + nc));
  work_.resize(at(nv + nc));
  increment_.resize(at(nv));
  drift_.resize(at(nv));
  z_rate_.resize(at(system.layout().nz()));
  largest_z_rate_.resize(z_rate_.size());
}

// Flattened: in models of few bodies the calls of its short parts would cost as much as the parts.
[[gnu::flatten]] bool NewtonStageSolver::solve(const Stage& stage, StateView& out, StageResult& result) {
  StageFactor& factor = begin_stage(stage, out, result);
  for (int iteration = 0; iteration <= monitor_.parameters().max_iterations; ++iteration) {
    follow_accelerations(stage, out);
    const bool renew = monitor_.needs_jacobian();
    if (!evaluate(stage, out, renew)) return false;
    if (renew && !refactor(factor)) return true;  // singular: not converged, a shorter step may do
    monitor_.forces_act(equations_.evaluation()->acting);
    ++iterations_;
    ++result.iterations;
    fill_right_side(stage, out, factor, iteration == 0);
    solve_linear(factor, update_);
    const Convergence state = apply_update(stage, out, factor, iteration == 0);
    if (state == Convergence::not_finite) return give_up("a number in the state is not finite");
    if (state == Convergence::diverged) break;
    if (state == Convergence::converged || state == Convergence::at_rounding) {
      follow_accelerations(stage, out);
      const int violated = violated_redundant_row(stage);
      if (violated < 0) return accept(out, result);
      // Where the rank has changed along the motion the iteration goes on with other rows.
      if (!find_dependent_rows()) return give_up("redundant constraints contradict each other", violated);
      monitor_.forget_updates();
    }
  }
  return give_up("the iteration of a stage did not converge", row_of_largest_residual());
}

StageFactor& NewtonStageSolver::begin_stage(const Stage& stage, StateView& out, StageResult& result) {
  result = {0, 0};
  worst_row_ = -1;
  drifted_ = false;
  equations_.note_trouble("");
  *out.t = stage.t;
  std::ranges::fill(z_rate_, 0.0);
  std::ranges::fill(largest_z_rate_, 0.0);
  StageFactor& factor = factors_.factor_for(stage.beta_q, stage.beta_v);
  factor.beta_z = stage.beta_z;
  monitor_.begin(stage.beta_q, stage.beta_v, factor.record);
  return factor;
}

void NewtonStageSolver::follow_accelerations(const Stage& stage, StateView& out) {
  const auto follow = [&](std::size_t i) {
    out.v[i] = stage.v_known[i] + stage.beta_v * out.a[i];
    increment_[i] = stage.increment_known[i] + stage.beta_q * out.a[i];
  };
  for (std::size_t i = 0; i < increment_.size(); i += 3) follow(i), follow(i + 1), follow(i + 2);  // bodies have 3 or 6
  system_.coordinates().retract(stage.q_base, increment_, out.q);
  for (std::size_t i = 0; i < z_rate_.size(); ++i) out.z[i] = stage.z_known[i] + stage.beta_z * z_rate_[i];
}

bool NewtonStageSolver::evaluate(const Stage& stage, const StateView& at, bool with_jacobian) {
  unsigned terms = term_position | term_force;
  // Without rows what is evaluated here may be the end of the step already, see update_unknowns().
  if (system_.layout().nc() == 0) terms |= term_velocity | term_acceleration;
  if (stage.level == ConstraintLevel::velocity) terms |= term_velocity;
  if (with_jacobian) terms |= term_derivative;
  return equations_.evaluate(at, terms);
}

bool NewtonStageSolver::refactor(StageFactor& factor) {
  const Profile::Timer timer(equations_.profile(), Phase::factorization);
  index_one_.know_rows();
  factors_.follow_choice_of_rows();
  double pivot = factors_.factorize(factor);
  // The rank may have changed along the motion: rows that say nothing new are then left out.
  if (!(pivot > IndependentRows::singular_pivot) && find_dependent_rows()) pivot = factors_.factorize(factor);
  floor_.measure();
  factor.record.usable = pivot > 0.0 && std::isfinite(pivot);
  if (!factor.record.usable) equations_.note_trouble("the equations of motion are singular");
  if (factor.record.usable) monitor_.jacobian_renewed();
  return factor.record.usable;
}

// From the right side in right_.
void NewtonStageSolver::solve_linear(StageFactor& factor, std::span<double> update) {
  const Profile::Timer timer(equations_.profile(), Phase::solution);
  factor.matrix.solve(right_, update);
}

bool NewtonStageSolver::find_dependent_rows() {
  const bool others = equations_.rows().find(equations_.evaluation());
  factors_.follow_choice_of_rows();
  return others;
}

void NewtonStageSolver::fill_right_side(const Stage& stage, const StateView& out, StageFactor& factor, bool first) {
  Evaluation& e = equations_.evaluation();
  const std::size_t nv = increment_.size();
  const std::span<double> motion = std::span(right_).first(nv);
  if (first) floor_.follow_turns();
  std::fill(right_.begin(), right_.end(), 0.0);
  system_.jacobian().add_transposed(e.jacobian, out.lambda, motion);
  const std::span<const double> mass = system_.inertia().mass();
  for (std::size_t i = 0; i < nv; ++i) right_[i] = e.force[i] - mass[i] * out.a[i] - right_[i];
  if (stage.level == ConstraintLevel::position) {
    const bool on_phi = floor_.phi_is_below(1.0);
    if (first) drifted_ = has_drifted(factor, on_phi);
    if (!on_phi) fill_position_residual(stage.beta_q);
  } else {
    fill_velocity_residual(stage.beta_v, out);
  }
  InternalElimination& internal = factor.matrix.internal();
  if (!internal.empty()) internal.add_to_right(e.internal_rate, z_rate_, motion);
}

void NewtonStageSolver::fill_position_residual(double beta_q) {
  const double* const phi = equations_.evaluation()->phi.data();
  const std::span<const char> dependent = equations_.dependent();
  const std::span<const double> rounding = floor_.of_phi();
  const double times = drifted_ ? monitor_.parameters().drift_roundings : 1.0;
  double* const right = &right_[increment_.size()];
  for (std::size_t r = 0; r < rounding.size(); ++r) {
    right[r] = std::abs(phi[r]) <= times * rounding[r] || dependent[r] ? 0.0 : -phi[r] / beta_q;
  }
}

void NewtonStageSolver::fill_velocity_residual(double beta_v, const StateView& out) {
  const Evaluation& e = equations_.evaluation();
  const std::span<const char> dependent = equations_.dependent();
  const std::span<double> right = std::span(right_).subspan(increment_.size());
  system_.jacobian().multiply(e.jacobian, out.v, std::span(work_).first(right.size()));
  for (std::size_t r = 0; r < right.size(); ++r) right[r] = dependent[r] ? 0.0 : (e.nu[r] - work_[r]) / beta_v;
}

Convergence NewtonStageSolver::apply_update(const Stage& stage, StateView& out, StageFactor& factor, bool first) {
  const bool internal_converged = update_internal(stage, out, factor);
  const double size = equations_.norm(std::span(update_).first(increment_.size()));
  const Convergence state = monitor_.judge(size, floor_.of_coordinates(), internal_converged);
  if (first && drifted_) correct_drift(factor, out);
  update_unknowns(out, factor);
  if (state != Convergence::stagnated) return state;
  return is_rounding_of_phi(stage, factor) ? Convergence::at_rounding : monitor_.go_on();
}

bool NewtonStageSolver::update_internal(const Stage& stage, const StateView& out, StageFactor& factor) {
  const InternalElimination& internal = factor.matrix.internal();
  if (internal.empty()) return true;
  const std::span<const double> da = std::span(update_).first(increment_.size());
  const double change = internal.advance(da, stage.beta_z, out.z, z_rate_, largest_z_rate_);
  return change <= monitor_.parameters().internal_tolerance;
}

void NewtonStageSolver::update_unknowns(StateView& out, StageFactor& factor) {
  const std::size_t nv = increment_.size(), nc = update_.size() - nv;
  // Negligible: the evaluated point is kept, so that accelerate() can reuse it.
  if (nc == 0 && factor.matrix.internal().empty() && monitor_.is_negligible()) std::ranges::fill(update_, 0.0);
  for (std::size_t i = 0; i < nv; ++i) out.a[i] += update_[i];
  for (std::size_t r = 0; r < nc; ++r) out.lambda[r] += update_[nv + r];
}

bool NewtonStageSolver::has_drifted(StageFactor& factor, bool on_phi) const {
  ++factor.on_phi_since;
  if (on_phi) return false;
  const bool drifted = floor_.phi_is_below(monitor_.parameters().drift_roundings);
  if (!drifted) factor.on_phi_since = 0;
  return drifted;
}

void NewtonStageSolver::correct_drift(StageFactor& factor, StateView& out) {
  const std::vector<double>& phi = equations_.evaluation()->phi;
  const std::span<const char> dependent = equations_.dependent();
  const std::size_t nv = increment_.size();
  const double part = 1.0 / factor.on_phi_since;
  factor.on_phi_since = 0;
  std::fill(right_.begin(), right_.end(), 0.0);
  for (std::size_t r = 0; r < phi.size(); ++r) right_[nv + r] = dependent[r] ? 0.0 : -phi[r] / factor.beta_q;
  solve_linear(factor, work_);
  for (std::size_t i = 0; i < nv; ++i) {
    out.a[i] += part * work_[i];
    drift_[i] = (1.0 - part) * factor.beta_q * work_[i];
  }
  for (std::size_t r = 0; r < phi.size(); ++r) out.lambda[r] += part * work_[nv + r];
}

bool NewtonStageSolver::is_rounding_of_phi(const Stage& stage, StageFactor& factor) {
  if (stage.level != ConstraintLevel::position || !floor_.all_phi_is_rounding()) return false;
  const std::size_t nv = increment_.size();
  std::fill(right_.begin(), right_.end(), 0.0);
  fill_position_residual(factor.beta_q);
  solve_linear(factor, work_);
  for (std::size_t i = 0; i < nv; ++i) work_[i] = update_[i] - work_[i];
  return equations_.norm(std::span(work_).first(nv)) * monitor_.largest_beta() <= monitor_.parameters().tolerance;
}

int NewtonStageSolver::violated_redundant_row(const Stage& stage) const {
  if (!equations_.rows().any_dependent() || stage.level != ConstraintLevel::position) return -1;
  const std::span<const char> dependent = equations_.dependent();
  const std::vector<double>& phi = equations_.evaluation()->phi;
  const double allowed = monitor_.parameters().redundancy_tolerance * system_.size();
  for (std::size_t r = 0; r < phi.size(); ++r) {
    if (dependent[r] && std::abs(phi[r]) > allowed) return static_cast<int>(r);
  }
  return -1;
}

int NewtonStageSolver::row_of_largest_residual() const {
  const std::vector<double>& phi = equations_.evaluation()->phi;
  double largest = -1.0;
  int row = -1;
  for (std::size_t r = 0; r < phi.size(); ++r) {
    if (std::abs(phi[r]) > largest) largest = std::abs(phi[r]), row = static_cast<int>(r);
  }
  return row;
}

bool NewtonStageSolver::accept(StateView& out, StageResult& result) {
  if (drifted_) system_.coordinates().retract(out.q, drift_, out.q);
  result.converged = 1;
  return true;
}

bool NewtonStageSolver::give_up(const char* trouble, int worst_row) {
  equations_.note_trouble(trouble);
  worst_row_ = worst_row;
  return true;
}

double NewtonStageSolver::unsolved_error(double beta_q, double beta_v, std::span<const double> missed) {
  StageFactor& factor = factors_.factor_for(beta_q, beta_v);
  const ConvergenceParameters& p = monitor_.parameters();
  floor_.follow_turns();
  if (!floor_.phi_is_below(p.drift_roundings)) return std::numeric_limits<double>::infinity();
  ++factor.on_phi_since;
  return equations_.norm(missed) * std::max(beta_q, beta_v) / p.tolerance;
}

}  // namespace freeplay
