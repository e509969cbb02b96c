#include "stage/index_one_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/index.h"
#include "base/same_bits.h"

namespace freeplay {
namespace {

constexpr double rounding = ConvergenceParameters::rounding;
constexpr double smallest = std::numeric_limits<double>::min();
constexpr double near_singular = 1e-2;    // regularity below which errors across the motion count less
constexpr double off_constraints = 10.0;  // relative change of Phi_q by relative size of Phi, about
constexpr int refinement_limit = 30;
constexpr double refined = 1e-15;          // relative error that a refinement may leave
constexpr double stagnation_rate = 0.3;    // of updates that gain nothing more where they are as small as ...
constexpr double stagnation_size = 1e-12;  // ... this, relative
constexpr double on_position = 1e-14;      // Phi that a projection may leave [model sizes] ...
constexpr double near_position = 1e-12;    // ... and where it does not halve any more, or what its terms round to
constexpr int quick_passes = 3;            // of a projection of velocities
constexpr double small_change = 1e-5;      // of velocities, relative, that these may make
constexpr unsigned rows = term_position | term_velocity, index_one = rows | term_acceleration | term_force;

double largest(std::span<const double> numbers) {
  double size = 0.0;
  for (const double x : numbers) size = std::max(size, std::abs(x));
  return size;
}

}  // namespace

IndexOneSolver::IndexOneSolver(StageEquations& equations, const ConvergenceParameters& parameters)
    : equations_(equations),
      system_(equations.system()),
      e_(equations.evaluation()),
      dependent_(equations.dependent()),
      parameters_(parameters),
      floor_(equations, parameters),
      matrix_(system_) {
  const int nv = system_.layout().nv(), nc = system_.layout().nc();
  factored_at_.resize(at(system_.layout().nq()));
  update_.resize(at(nv + nc));
  increment_.resize(at(nv));
  right_a_.resize(at(nv));
  right_c_.resize(at(nc));
  work_.resize(at(nv + nc));
  size_.resize(at(nv + nc));
  multipliers_.resize(at(nc));
  first_multipliers_.resize(at(nc));
  loads_.resize(at(system_.layout().all_rows()));
  set_pattern();
}

// The pivots of all rows are much cheaper than a rank-revealing decomposition, and mostly enough.
void IndexOneSolver::know_rows() {
  if (equations_.rows().is_known()) return;
  const Profile::Timer start(equations_.profile(), Phase::start);
  const bool independent = factor_once() > IndependentRows::singular_pivot && matrix_.has_independent_rows();
  independent ? equations_.rows().keep_all() : static_cast<void>(equations_.rows().find(e_));
}

void IndexOneSolver::set_pattern() {
  const Profile::Timer start(equations_.profile(), Phase::start);
  matrix_.set_pattern(dependent_);
  pattern_choice_ = equations_.rows().choice();
  valid_ = false;
}

void IndexOneSolver::save(ArchiveWriter& archive) const {
  archive(valid_, pattern_choice_, factored_time_, factored_at_, multipliers_, drifts_, factorizations_);
  if (pattern_choice_ == equations_.rows().choice()) archive(matrix_);
}

// The pattern of other rows than the present ones is not used again.
void IndexOneSolver::restore(ArchiveReader& archive) {
  archive(valid_, pattern_choice_, factored_time_, factored_at_, multipliers_, drifts_, factorizations_);
  if (pattern_choice_ != equations_.rows().choice()) return;
  matrix_.set_pattern(dependent_);
  archive(matrix_);
}

double IndexOneSolver::factor_once() {
  if (pattern_choice_ != equations_.rows().choice()) set_pattern();
  ++factorizations_;
  return matrix_.factor(e_);
}

// x = M^-1 (x - Phi_q^T l) and the multipliers l, in place of both right sides.
[[gnu::always_inline]] inline void IndexOneSolver::solve_linear(std::span<double> x, std::span<double> l) {
  const Profile::Timer timer(equations_.profile(), Phase::solution);
  matrix_.solve(x, l);
}

bool IndexOneSolver::factor() {
  const Profile::Timer timer(equations_.profile(), Phase::factorization);
  know_rows();
  double pivot = factor_once();
  factored_time_ = e_->time;
  std::copy_n(e_->q.begin(), factored_at_.size(), factored_at_.begin());
  IndependentRows& choice = equations_.rows();
  choice.note_pivot(pivot);
  // The rank may have changed along the motion: rows that say nothing new are then left out.
  if (!(pivot > IndependentRows::singular_pivot) && choice.find(e_)) pivot = factor_once();
  valid_ = pivot > 0.0 && std::isfinite(pivot);
  if (!valid_) equations_.note_trouble("the equations of motion are singular");
  return valid_;
}

bool IndexOneSolver::refine(std::span<double> x_a, std::span<double> x_c, double scale, bool multipliers, bool solved) {
  bool fresh = false;
  if (!has_factors()) {
    if (!factor()) return false;
    fresh = true;
  }
  double previous = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < refinement_limit; ++iteration) {
    if (!solved) solve_remainder(x_a, x_c);
    solved = false;
    const double change = add_update(x_a, x_c, scale, multipliers);
    if (std::isnan(change)) {
      equations_.note_trouble("a number in the state is not finite");
      return false;
    }
    const double ratio = change / previous;
    previous = change;
    const double left = ratio < 1.0 ? ratio / (1.0 - ratio) * change : change;
    if (iteration > 0 && (left <= refined || (ratio >= stagnation_rate && change <= stagnation_size))) return true;
    if (change == 0.0) return true;
    if (!fresh && iteration > 0 && ratio > parameters_.slow_rate) {
      if (!factor()) return false;
      fresh = true;
      previous = std::numeric_limits<double>::infinity();
    }
  }
  // A badly conditioned position (close to a singular one) stagnates above the target; what it reached is the best
  // there is.
  return true;
}

void IndexOneSolver::solve_remainder(std::span<const double> x_a, std::span<const double> x_c) {
  const std::size_t nv = x_a.size(), nc = x_c.size();
  const std::span<double> motion = std::span(update_).first(nv), pressure = std::span(update_).subspan(nv);
  std::ranges::fill(motion, 0.0);
  system_.jacobian().add_transposed(e_->jacobian, x_c, motion);
  system_.jacobian().multiply(e_->jacobian, x_a, pressure);
  for (std::size_t i = 0; i < nv; ++i) motion[i] = right_a_[i] - system_.inertia().mass()[i] * x_a[i] - motion[i];
  for (std::size_t r = 0; r < nc; ++r) pressure[r] = dependent_[r] ? 0.0 : right_c_[r] - pressure[r];
  solve_linear(motion, pressure);
}

double IndexOneSolver::add_update(std::span<double> x_a, std::span<double> x_c, double scale, bool multipliers) {
  const std::size_t nv = x_a.size(), nc = x_c.size();
  const std::span<const double> motion = std::span(update_).first(nv), pressure = std::span(update_).subspan(nv);
  for (std::size_t i = 0; i < nv; ++i) x_a[i] += motion[i];
  for (std::size_t r = 0; r < nc; ++r) x_c[r] += pressure[r];
  const double moved = equations_.norm(motion), pressed = largest(pressure);
  if (!std::isfinite(moved) || !std::isfinite(pressed)) return std::numeric_limits<double>::quiet_NaN();
  double change = moved / std::max({equations_.norm(x_a), scale, smallest});
  if (multipliers) {
    // Multipliers that vanish are right to the rounding of the forces and inertias that leave nothing over.
    double forces = std::max(largest(x_c), largest(right_a_));
    for (std::size_t i = 0; i < nv; ++i) forces = std::max(forces, std::abs(system_.inertia().mass()[i] * x_a[i]));
    change = std::max(change, pressed / std::max(forces, smallest));
  }
  // What becomes exactly zero has no relative change.
  return std::min(change, std::numeric_limits<double>::max());
}

template <int width>
bool IndexOneSolver::equations_hold(std::span<const double> x_a, std::span<const double> x_c) {
  const std::size_t nv = x_a.size();
  for (std::size_t i = 0; i < nv; ++i) {
    const double inertia = system_.inertia().mass()[i] * x_a[i];
    work_[i] = right_a_[i] - inertia;
    size_[i] = std::abs(right_a_[i]) + std::abs(inertia);
  }
  for (const JacobianBlock& block : system_.jacobian().blocks()) {
    const double* entry = &e_->jacobian[at(block.offset)];
    double *left = &work_[at(width * block.body)], *size = &size_[at(width * block.body)];
    for (int r = block.row; r < block.row + block.rows; ++r, entry += width) {
      const double multiplier = x_c[at(r)];
      for (int c = 0; c < width; ++c) {
        const double force = entry[c] * multiplier;
        left[c] -= force;
        size[c] += std::abs(force);
      }
    }
  }
  int failing = 0;
  for (std::size_t i = 0; i < nv; ++i) failing += std::abs(work_[i]) <= 8.0 * rounding * size_[i] ? 0 : 1;
  return failing == 0;
}

// Leaves what is missing in `left`, by row. One row that does not hold is enough.
template <int width>
bool IndexOneSolver::rows_hold_in(std::span<const double> right, std::span<const double> x_a, double tolerance,
                                  std::span<double> left) {
  const double *const entries = e_->jacobian.data(), *const rates = x_a.data();
  std::ranges::copy(right, left.begin());
  for (const JacobianBlock& block : system_.jacobian().blocks()) {
    const double *entry = entries + block.offset, *const rate = rates + width * block.body;
    for (int r = 0; r < block.rows; ++r, entry += width) {
      double gap = left[at(block.row + r)];
      for (int c = 0; c < width; ++c) gap -= entry[c] * rate[c];
      left[at(block.row + r)] = gap;
    }
  }
  for (std::size_t r = 0; r < right.size(); ++r) {
    if (dependent_[r] != 0) continue;
    double size = std::abs(right[r]);
    for (const ConstraintJacobian::RowPiece& piece : system_.jacobian().row_pieces(r)) {
      const double *entry = entries + piece.offset, *const rate = rates + piece.velocity;
      for (int c = 0; c < width; ++c) size += std::abs(entry[c] * rate[c]);
    }
    if (!(std::abs(left[r]) <= tolerance * rounding * size)) return false;
  }
  return true;
}

bool IndexOneSolver::rows_hold(std::span<const double> right, std::span<const double> x_a, double tolerance,
                               std::span<double> left) {
  return system_.layout().body_velocities() == 3 ? rows_hold_in<3>(right, x_a, tolerance, left)
                                                 : rows_hold_in<6>(right, x_a, tolerance, left);
}

bool IndexOneSolver::holds_to_rounding(std::span<const double> x_a, std::span<const double> x_c) {
  return rows_hold(right_c_, x_a, 8.0, std::span(work_).first(right_c_.size())) &&
         (system_.layout().body_velocities() == 3 ? equations_hold<3>(x_a, x_c) : equations_hold<6>(x_a, x_c));
}

bool IndexOneSolver::velocities_hold(std::span<const double> v) { return rows_hold(e_->nu, v, 4.0, right_c_); }

// Phi_q depends on time and coordinates only.
bool IndexOneSolver::is_factored_here() const {
  return has_factors() && factored_time_ == e_->time &&
         same_bits(factored_at_, std::span(e_->q).first(factored_at_.size()));
}

bool IndexOneSolver::accelerate(StateView& state, Span<double> z_rate) {
  IndependentRows& choice = equations_.rows();
  if (e_->is_at(equations_.point_of(state), index_one & ~unsigned{term_acceleration})) {
    system_.complete_rates(term_acceleration, e_);
  } else if (!equations_.evaluate(state, index_one)) {
    return false;
  }
  if (choice.any_dependent()) {
    const Profile::Timer timer(equations_.profile(), Phase::factorization);
    // Rows that were left out in a singular position count again, but not those that seem independent only because a
    // stage is a little off the constraints.
    choice.find_more(e_, off_constraints * largest(e_->phi) / system_.size());
  }
  if (!is_factored_here() && !factor()) return false;
  // Nothing of the past enters, so that the same state always has the same accelerations.
  const std::size_t nv = state.a.size, nc = state.lambda.size;
  std::copy_n(e_->force.begin(), nv, state.a.begin());
  for (std::size_t r = 0; r < nc; ++r) state.lambda[r] = dependent_[r] ? 0.0 : e_->gamma[r];
  solve_linear(state.a, state.lambda);
  if (!matrix_.is_well_conditioned()) {
    std::copy_n(e_->force.begin(), nv, right_a_.begin());
    std::ranges::copy(e_->gamma, right_c_.begin());
    // Where drivers determine the motion completely, a is right at once and the multipliers are not.
    if (!holds_to_rounding(state.a, state.lambda) && !refine(state.a, state.lambda, 0.0, true)) return false;
  }
  std::ranges::copy(e_->internal_rate, z_rate.begin());
  if (choice.any_dependent()) {
    const Profile::Timer timer(equations_.profile(), Phase::solution);
    choice.least_norm(state.lambda);
  }
  if (flows_ != nullptr) {
    std::ranges::copy(state.lambda, loads_.begin());
    system_.driven().recover_loads(e_, loads_);
    flows_->flow(e_, loads_, z_rate.part(e_->internal_rate.size(), at(flows_->flows())));
  }
  return true;
}

/// update_ <- the motion of least mass norm that changes the rows by `gap`, by the index-1 factors that there are.
[[gnu::always_inline]] inline void IndexOneSolver::solve_rows(std::span<const double> gap) {
  const std::size_t nv = update_.size() - gap.size();
  std::fill_n(update_.begin(), nv, 0.0);
  double* const pressure = update_.data() + nv;
  for (std::size_t r = 0; r < gap.size(); ++r) pressure[r] = dependent_[r] ? 0.0 : gap[r];
  solve_linear(std::span(update_).first(nv), {pressure, gap.size()});
}

bool IndexOneSolver::project_velocity(StateView& state) {
  const std::size_t nv = state.v.size, nc = state.lambda.size;
  if (nc == 0) return true;
  if (!e_->has_rows_at(equations_.point_of(state))) {
    if (!equations_.evaluate(state, rows)) return false;
  } else {
    system_.complete_rates(term_velocity, e_);
  }
  std::ranges::fill(multipliers_, 0.0);
  if (velocities_hold(state.v)) return true;
  const double speed = equations_.norm(state.v);
  if (!is_factored_here() && !factor()) return false;
  bool solved = false;  // update_ is the first one of a refinement
  for (int pass = 0; pass < quick_passes; ++pass) {
    solve_rows(right_c_);
    const double *const motion = update_.data(), *const pressure = motion + nv;
    solved = !(equations_.norm({motion, nv}) <= small_change * speed);
    if (solved) break;
    for (std::size_t i = 0; i < nv; ++i) state.v[i] += motion[i];
    for (std::size_t r = 0; r < nc; ++r) multipliers_[r] += pressure[r];
    // Factors of a regular matrix leave so little of a small change that it is less than v rounds to.
    if (matrix_.is_well_conditioned() || velocities_hold(state.v)) return true;
  }
  std::ranges::fill(right_a_, 0.0);
  std::ranges::fill(increment_, 0.0);
  std::ranges::copy(multipliers_, first_multipliers_.begin());
  std::ranges::fill(multipliers_, 0.0);
  // The change is a small part of v: digits below the rounding of v are not needed.
  if (!refine(increment_, multipliers_, speed, false, solved)) return false;
  for (std::size_t i = 0; i < nv; ++i) state.v[i] += increment_[i];
  for (std::size_t r = 0; r < nc; ++r) multipliers_[r] += first_multipliers_[r];
  return true;
}

// What no iteration makes smaller: after many turns angles round coarser than lengths.
bool IndexOneSolver::is_rounded(double gap) {
  if (gap < near_position * system_.size()) return true;
  floor_.measure();
  return floor_.all_phi_is_rounding();
}

bool IndexOneSolver::project_position(StateView& state) {
  if (state.lambda.size == 0) return true;
  const double target = on_position * system_.size();
  double previous = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < parameters_.max_iterations; ++iteration) {
    // Where the last projection moved nothing, as of bodies that drivers move, accelerate() follows at this very point.
    if (!equations_.evaluate(state, drifts_ ? rows : index_one)) return false;
    const double gap = largest(e_->phi);
    drifts_ = !(gap <= target);
    if (gap <= target || (gap > 0.5 * previous && is_rounded(gap))) return true;
    const bool slow = gap > parameters_.slow_rate * previous;
    if ((!has_factors() || slow) && !factor()) return false;
    previous = gap;
    for (std::size_t r = 0; r < e_->phi.size(); ++r) right_c_[r] = -e_->phi[r];
    solve_rows(right_c_);
    system_.coordinates().retract(state.q, std::span(update_).first(increment_.size()), state.q);
  }
  equations_.note_trouble("positions could not be projected on the constraints");
  return false;
}

bool IndexOneSolver::part_along_motion(std::span<const double> error, std::span<double> along) {
  if (!(equations_.rows().attempt_regularity() < near_singular && has_factors() && !right_c_.empty())) return false;
  for (std::size_t i = 0; i < error.size(); ++i) along[i] = system_.inertia().mass()[i] * error[i];
  const std::span<double> multipliers = std::span(update_).subspan(error.size());
  std::ranges::fill(multipliers, 0.0);
  solve_linear(along, multipliers);
  return true;
}

bool IndexOneSolver::mobility(const State& state, int joint, std::span<double> out, std::span<double> whole) {
  if (!system_.evaluate(point(state), term_position, e_)) return false;
  if (!is_factored_here() && !factor()) return false;
  const JointElement& element = system_.model().joints[at(joint)];
  const bool planar = system_.model().space == Space::planar;
  constexpr std::size_t directions[] = {0, 1, 2, 3, 4, 5}, in_plane[] = {0, 1, 5};
  constexpr double none[3] = {};
  if (!accelerations_by_units(joint, std::span(directions).first(planar ? 2 : 3), none, 3, out)) return false;
  if (whole.empty()) return true;
  const double *a = e_->markers[at(element.marker_a)].position, *b = e_->markers[at(element.marker_b)].position;
  const double arm[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  return accelerations_by_units(joint, planar ? std::span<const std::size_t>(in_plane) : directions, arm, 6, whole);
}

// `out` (`width` x `width`) <- the acceleration of the second marker against the first, counted at `arm` from it, by
// unit wrenches in these directions on the second marker and their opposites on the first at the same place.
bool IndexOneSolver::accelerations_by_units(int joint, std::span<const std::size_t> directions, const double* arm,
                                            std::size_t width, std::span<double> out) {
  const JointElement& element = system_.model().joints[at(joint)];
  const int markers[2] = {element.marker_a, element.marker_b};
  const auto unit = [&](std::size_t direction, int end, double(&wrench)[6]) {
    std::ranges::fill(wrench, 0.0);
    wrench[direction] = end == 0 ? -1.0 : 1.0;
    if (end == 1 || direction > 2) return;
    const std::size_t next = (direction + 1) % 3, last = (direction + 2) % 3;
    wrench[3 + next] = -arm[last];
    wrench[3 + last] = arm[next];
  };
  std::ranges::fill(out, 0.0);
  std::ranges::fill(right_c_, 0.0);
  for (const std::size_t direction : directions) {
    std::ranges::fill(right_a_, 0.0);
    double wrench[6];
    for (const int end : {0, 1}) {
      unit(direction, end, wrench);
      if (system_.markers().unknown(markers[end]) != ground) {
        system_.markers().apply(markers[end], wrench, e_, right_a_);
      }
    }
    if (!move_by_forces()) return false;
    const std::size_t columns = at(system_.layout().body_velocities());
    for (const int end : {0, 1}) {
      const BodyId body = system_.markers().unknown(markers[end]);
      if (body == ground) continue;
      for (const std::size_t i : directions) {
        double row[6];
        unit(i, end, wrench);
        system_.markers().row(markers[end], wrench, e_, row);
        for (std::size_t c = 0; c < columns; ++c) {
          out[width * i + direction] += row[c] * increment_[columns * at(body) + c];
        }
      }
    }
  }
  return true;
}

// increment_ <- the accelerations by the forces right_a_, with gamma = 0.
bool IndexOneSolver::move_by_forces() {
  if (!matrix_.is_well_conditioned()) {
    std::ranges::fill(increment_, 0.0);
    std::ranges::fill(multipliers_, 0.0);
    return refine(increment_, multipliers_, 0.0);
  }
  const std::span<double> multipliers = std::span(update_).subspan(increment_.size());
  std::ranges::copy(right_a_, increment_.begin());
  std::ranges::fill(multipliers, 0.0);
  solve_linear(increment_, multipliers);
  return true;
}

}  // namespace freeplay
