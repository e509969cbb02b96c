#include "run/newton_stage_solver.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

namespace freeplay {
namespace {

constexpr double rounding = std::numeric_limits<double>::epsilon();
constexpr double singular_pivot = 1e-13;     // smallest pivot over the largest
constexpr double near_singular = 1e-2;       // regularity below which errors across the motion count less
constexpr double slow_contraction = 0.1;     // a stale factor that contracts less is renewed
constexpr double internal_tolerance = 1e-8;  // last change of an internal variable, relative; the next is its square
constexpr double off_constraints = 10.0;     // relative change of Phi_q by relative size of Phi, about
constexpr int refinement_limit = 30;
// A contraction that was seen stands for others that may be so much worse, for so many stages.
constexpr double careful = 10.0, least_contraction = 1e-5;
constexpr int seen_for = 8;
constexpr double most_foreseen = 100.0;  // size of a first update that may be the only one, in tolerances
constexpr int most_stays = 3;            // iterations that roundings alone could have kept large, with old factors
constexpr int noise_for = 64;            // stages, until noise is looked at again
constexpr int quick_passes = 3;          // of a projection of velocities
constexpr double small_change = 1e-5;    // of velocities, relative, that these may make
constexpr int kept_factors = 4;
constexpr double smallest = std::numeric_limits<double>::min();
constexpr unsigned rows = term_position | term_velocity, index_one = rows | term_acceleration | term_force;
constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

double largest(std::span<const double> numbers) {
  double size = 0.0;
  for (const double x : numbers) size = std::max(size, std::abs(x));
  return size;
}

template <class Call>
Status guarded_call(Message* message, const NewtonStageSolver& solver, Call&& call) noexcept {
  if (call()) return Status::ok;
  abi::copy_text(message->text, sizeof message->text, solver.trouble());
  return Status::failed;
}

}  // namespace

NewtonStageSolver::NewtonStageSolver(const System& system, const StageOptions& options)
    : system_(system),
      options_(options),
      table_{sizeof(abi::StageSolverTable),
             this,
             [](void* self, const Stage* stage, StateView* out, StageResult* result, Message* m) noexcept {
               auto& solver = *static_cast<NewtonStageSolver*>(self);
               return guarded_call(m, solver, [&] { return solver.solve(*stage, *out, *result); });
             },
             [](void* self, StateView* state, Message* m) noexcept {
               auto& solver = *static_cast<NewtonStageSolver*>(self);
               return guarded_call(m, solver, [&] { return solver.project_velocity(*state); });
             },
             [](void* self, StateView* state, Message* m) noexcept {
               auto& solver = *static_cast<NewtonStageSolver*>(self);
               return guarded_call(m, solver, [&] { return solver.project_position(*state); });
             },
             [](void* self, StateView* state, Span<double> z_rate, Message* m) noexcept {
               auto& solver = *static_cast<NewtonStageSolver*>(self);
               return guarded_call(m, solver, [&] { return solver.accelerate(*state, z_rate); });
             },
             [](void* self, Span<const double> position, Span<const double> velocity) noexcept {
               return static_cast<NewtonStageSolver*>(self)->error_norm(position, velocity);
             },
             [](void* self, Span<const double> q_base, Span<const double> increment, Span<double> q) noexcept {
               static_cast<NewtonStageSolver*>(self)->system_.retract(q_base, increment, q);
             },
             0,
             [](void* self, double dt, const StateView* end, Span<const double> error) noexcept {
               return static_cast<NewtonStageSolver*>(self)->internal_error_norm(dt, *end, error);
             },
             [](void* self, Span<const double> increment, Span<const double> v, Span<double> rate) noexcept {
               static_cast<NewtonStageSolver*>(self)->system_.increment_rate(increment, v, rate);
             }},
      e_(system),
      rows_(system.layout().nc(), system.layout().nv()),
      index_one_{.matrix = AccelerationMatrix(system)} {
  const int nv = system.layout().nv(), nc = system.layout().nc();
  for (int i = 0; i < kept_factors; ++i) factors_.push_back({.matrix = StageMatrix(system, true)});
  for (int i = 0; i < nv; ++i) unit_.push_back(system.is_turn(i) ? 1.0 : system.size());
  right_.resize(at(nv + nc));
  update_.resize(at(nv + nc));
  increment_.resize(at(nv));
  z_rate_.resize(at(system.layout().nz()));
  right_a_.resize(at(nv));
  right_c_.resize(at(nc));
  work_.resize(at(nv + nc));
  size_.resize(at(nv + nc));
  factored_at_.resize(at(1 + system.layout().nq()));
  multipliers_.resize(at(nc));
  other_a_.resize(at(nv));
  other_lambda_.resize(at(nc));
  other_z_.resize(at(system.layout().nz()));
  other_rate_.resize(other_z_.size());
  dependent_.assign(at(nc), 0);
}

NewtonStageSolver::Factor& NewtonStageSolver::factor_for(double beta_q, double beta_v) {
  ++clock_;
  Factor* oldest = &factors_[0];
  for (Factor& factor : factors_) {
    // A factor only preconditions the iteration: betas that differ by rounding may share it.
    if (factor.used >= 0 && std::abs(factor.beta_q - beta_q) <= 1e-6 * beta_q &&
        std::abs(factor.beta_v - beta_v) <= 1e-6 * beta_v) {
      factor.used = clock_;
      return factor;
    }
    if (factor.used < oldest->used) oldest = &factor;
  }
  oldest->beta_q = beta_q;
  oldest->beta_v = beta_v;
  oldest->used = clock_;
  oldest->valid = false;
  oldest->noise = 0.0;
  oldest->stays = 0;
  return *oldest;
}

bool NewtonStageSolver::evaluate(const StateView& s, unsigned terms) {
  const Point point{*s.t, s.q, s.v, s.z, h_};
  if (system_.evaluate(point, terms | only_asked, e_)) return true;
  trouble_ = e_.fault.kind == Fault::Kind::plugin ? e_.fault.message.text : e_.fault.motion.text;
  return false;
}

template <class AnyFactor>
double NewtonStageSolver::factor_once(AnyFactor& factor) {
  if (!factor.has_pattern) {
    const Profile::Timer start(system_.profile(), Phase::start);
    factor.matrix.set_pattern(dependent_);
  }
  factor.has_pattern = true;
  ++factorizations_;
  if constexpr (std::is_same_v<AnyFactor, IndexOne>) {
    return factor.matrix.factor(e_);
  } else {
    return factor.matrix.factor(e_, factor.beta_q, factor.beta_v, factor.beta_z);
  }
}

// Much cheaper than to look which ones depend on others, and mostly enough.
bool NewtonStageSolver::rows_are_independent() {
  if (!(factor_once(index_one_) > singular_pivot) || !index_one_.matrix.has_independent_rows()) return false;
  rank_ = system_.layout().nc();
  return true;
}

bool NewtonStageSolver::find_dependent_rows() {
  system_.jacobian_entries(e_, entries_);
  rows_.analyse(entries_);
  return keep_independent_rows();
}

bool NewtonStageSolver::keep_independent_rows() {
  // Fewer than before: this is a singular position.
  if (rank_ >= 0 && rows_.rank() < rank_) regularity_ = last_regularity_ = 0.0;
  rank_ = rows_.rank();
  const bool same = std::ranges::equal(rows_.dependent(), dependent_);
  std::ranges::copy(rows_.dependent(), dependent_.begin());
  any_dependent_ = rank_ < system_.layout().nc();
  if (!same) {
    for (Factor& factor : factors_) factor.valid = factor.has_pattern = false;
    index_one_.valid = index_one_.has_pattern = false;
  }
  return !same;
}

template <class AnyFactor>
bool NewtonStageSolver::refactor(AnyFactor& factor) {
  const Profile::Timer timer(system_.profile(), Phase::factorization);
  if (rank_ < 0) {
    const Profile::Timer start(system_.profile(), Phase::start);
    if (!rows_are_independent()) find_dependent_rows();
  }
  double pivot = factor_once(factor);
  if constexpr (std::is_same_v<AnyFactor, IndexOne>) {
    std::copy_n(e_.place.begin(), factored_at_.size(), factored_at_.begin());
    largest_pivot_ = std::max(largest_pivot_, pivot);
    last_regularity_ = pivot / largest_pivot_;
    regularity_ = std::min(regularity_, last_regularity_);
  }
  // The rank may have changed along the motion: rows that say nothing new are then left out.
  if (!(pivot > singular_pivot) && find_dependent_rows()) pivot = factor_once(factor);
  factor.valid = pivot > 0.0 && std::isfinite(pivot);
  if (!factor.valid) trouble_ = "the equations of motion are singular";
  return factor.valid;
}

double NewtonStageSolver::norm(std::span<const double> increment) const {
  double largest = 0.0;
  for (std::size_t i = 0; i < unit_.size(); ++i) {
    const double scaled = std::abs(increment[i]) / unit_[i];
    if (!(scaled <= largest)) largest = scaled;  // keeps a NaN
  }
  return largest;
}

bool NewtonStageSolver::solve(const Stage& stage, StateView& out, StageResult& result) {
  const int nv = system_.layout().nv(), nc = system_.layout().nc();
  const double beta_v = stage.beta_v, beta_q = stage.beta_q;
  const bool position = stage.level == ConstraintLevel::position;
  result = {0, 0};
  worst_row_ = -1;
  trouble_ = "";
  *out.t = stage.t;
  std::ranges::fill(z_rate_, 0.0);
  Factor& factor = factor_for(beta_q, beta_v);
  factor.beta_z = stage.beta_z;
  bool fresh = false;
  double previous = std::numeric_limits<double>::infinity(), ratio = 1.0;
  int diverging = 0;
  for (int iteration = 0; iteration <= options_.max_iterations; ++iteration) {
    for (std::size_t i = 0; i < at(nv); ++i) {
      out.v[i] = stage.v_known[i] + beta_v * out.a[i];
      increment_[i] = stage.increment_known[i] + beta_q * out.a[i];
    }
    system_.retract(stage.q_base, increment_, out.q);
    for (std::size_t i = 0; i < z_rate_.size(); ++i) out.z[i] = stage.z_known[i] + stage.beta_z * z_rate_[i];
    const unsigned terms = term_position | term_velocity | term_force;
    const bool renew = !factor.valid || (!fresh && ratio > slow_contraction && iteration > 1);
    if (!evaluate(out, terms | (renew ? term_derivative : 0u))) return false;
    if (renew) {
      if (!refactor(factor)) return true;  // singular: not converged, a shorter step may do
      fresh = true;
      factor.contraction = 1.0;
    }
    if (iteration == 0 && e_.acting != factor.acting) factor.contraction = 1.0, factor.noise = 0.0;
    factor.acting = e_.acting;
    ++iterations_;
    ++result.iterations;

    std::fill(right_.begin(), right_.end(), 0.0);
    system_.add_transposed(e_, out.lambda, std::span(right_).first(at(nv)));
    for (std::size_t i = 0; i < at(nv); ++i) {
      right_[i] = e_.force[i] - system_.mass()[i] * out.a[i] - right_[i];
    }
    if (position) {
      for (std::size_t r = 0; r < at(nc); ++r) right_[at(nv) + r] = -e_.phi[r] / beta_q;
    } else {
      system_.multiply(e_, out.v, std::span(work_).first(at(nc)));
      for (std::size_t r = 0; r < at(nc); ++r) right_[at(nv) + r] = (e_.nu[r] - work_[r]) / beta_v;
    }
    for (std::size_t r = 0; r < at(nc); ++r) {
      if (dependent_[r]) right_[at(nv) + r] = 0.0;
    }
    if (!factor.matrix.internal().empty()) {
      factor.matrix.internal().add_to_right(e_.internal_rate, z_rate_, std::span(right_).first(at(nv)));
    }
    factor.matrix.solve(right_, update_);
    for (std::size_t i = 0; i < at(nv); ++i) out.a[i] += update_[i];
    for (std::size_t r = 0; r < at(nc); ++r) out.lambda[r] += update_[at(nv) + r];
    bool internal_settled = true;
    if (!factor.matrix.internal().empty()) {
      internal_settled = factor.matrix.internal().advance(std::span(update_).first(at(nv)), stage.beta_z, out.z,
                                                          z_rate_) <= internal_tolerance;
    }

    const double change = norm(std::span(update_).first(at(nv)));
    if (!std::isfinite(change)) {
      trouble_ = "a number in the state is not finite";
      return true;
    }
    const double change_before = previous;
    ratio = iteration == 0 ? 1.0 : change / previous;
    previous = change;
    // Left over after this update: a geometric series of ratio r. Judged in position and, with a unit time of 1 s, in
    // velocity. Below the noise of Phi (rounding of coordinates, divided by beta_q) nothing more can be won.
    if (iteration > 0 && change_before * beta_q > 8.0 * rounding) {
      factor.contraction = std::max({careful * ratio, 0.5 * factor.contraction, least_contraction});
      factor.since_seen = 0;
    }
    // The first update has no ratio of its own. Where it is small, that of a stage not long ago stands for it, with the
    // same forces on.
    const double size = change * std::max(beta_q, beta_v);
    const bool foreseen = iteration == 0 && factor.contraction < 0.1 && size <= most_foreseen * options_.tolerance &&
                          ++factor.since_seen <= seen_for;
    const double part = foreseen ? factor.contraction : ratio;
    const double left = part < 1.0 ? part / (1.0 - part) * change : change;
    const bool accurate =
        (iteration > 0 || foreseen) && left * beta_q <= options_.tolerance && left * beta_v <= options_.tolerance;
    // What does not shrink although it moves positions by roundings alone is noise, or comes of old factors: which of
    // both, new ones tell.
    const bool tiny = change * beta_q <= 50.0 * rounding;
    const bool stays = iteration > 0 && tiny && ratio >= 0.3;
    if (stays && fresh) factor.noise = std::max(change, 0.5 * factor.noise), factor.since_noise = 0;
    if (stays && !fresh && ++factor.stays > most_stays) factor.stays = 0, factor.valid = false;
    const bool quiet = iteration == 0 && tiny && change <= 2.0 * factor.noise && ++factor.since_noise <= noise_for;
    const bool noise = stays || quiet || (iteration > 0 && change * beta_q <= rounding);
    const bool stagnates = position && fresh && !accurate && !noise && ratio >= 0.3 && iteration > 0;
    if (internal_settled &&
        (accurate || noise || change == 0.0 || (stagnates && is_rounding_of_phi(factor, std::max(beta_q, beta_v))))) {
      for (std::size_t i = 0; i < at(nv); ++i) {
        out.v[i] = stage.v_known[i] + beta_v * out.a[i];
        increment_[i] = stage.increment_known[i] + beta_q * out.a[i];
      }
      system_.retract(stage.q_base, increment_, out.q);
      for (std::size_t i = 0; i < z_rate_.size(); ++i) out.z[i] = stage.z_known[i] + stage.beta_z * z_rate_[i];
      if (any_dependent_) {
        // Rows that were left out must hold by themselves.
        for (std::size_t r = 0; r < at(nc); ++r) {
          if (dependent_[r] && position && std::abs(e_.phi[r]) > 1e-9 * system_.size()) {
            worst_row_ = static_cast<int>(r);
            if (find_dependent_rows()) break;
            trouble_ = "redundant constraints contradict each other";
            return true;
          }
        }
        if (worst_row_ >= 0) {
          worst_row_ = -1;
          previous = std::numeric_limits<double>::infinity();
          continue;
        }
      }
      result.converged = 1;
      return true;
    }
    if (fresh && ratio > 2.0 && iteration > 0 && ++diverging >= 2) break;
    if (fresh && ratio > slow_contraction && iteration > 2) factor.valid = false;  // full Newton from here
  }
  trouble_ = "the iteration of a stage did not converge";
  double farthest = -1.0;
  for (int r = 0; r < nc; ++r) {
    if (std::abs(e_.phi[at(r)]) > farthest) farthest = std::abs(e_.phi[at(r)]), worst_row_ = r;
  }
  return true;
}

bool NewtonStageSolver::is_rounding_of_phi(const Factor& factor, double beta) {
  if (!(largest(e_.phi) <= 8.0 * rounding * system_.size())) return false;
  const std::size_t nv = unit_.size();
  std::fill(right_.begin(), right_.end(), 0.0);
  for (std::size_t r = 0; r < e_.phi.size(); ++r) {
    if (!dependent_[r]) right_[nv + r] = -e_.phi[r] / factor.beta_q;
  }
  factor.matrix.solve(right_, work_);
  for (std::size_t i = 0; i < nv; ++i) work_[i] = update_[i] - work_[i];
  return norm(std::span(work_).first(nv)) * beta <= options_.tolerance;
}

bool NewtonStageSolver::refine(std::span<double> x_a, std::span<double> x_c, double scale, bool multipliers) {
  const std::size_t nv = x_a.size(), nc = x_c.size();
  IndexOne& factor = index_one_;
  bool fresh = false;
  if (!factor.valid) {
    if (!refactor(factor)) return false;
    fresh = true;
  }
  double previous = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < refinement_limit; ++iteration) {
    std::fill(right_.begin(), right_.end(), 0.0);
    system_.add_transposed(e_, x_c, std::span(right_).first(nv));
    system_.multiply(e_, x_a, std::span(work_).first(nc));
    for (std::size_t i = 0; i < nv; ++i) right_[i] = right_a_[i] - system_.mass()[i] * x_a[i] - right_[i];
    for (std::size_t r = 0; r < nc; ++r) right_[nv + r] = dependent_[r] ? 0.0 : right_c_[r] - work_[r];
    factor.matrix.solve(right_, update_);
    for (std::size_t i = 0; i < nv; ++i) x_a[i] += update_[i];
    for (std::size_t r = 0; r < nc; ++r) x_c[r] += update_[nv + r];
    const double moved = norm(std::span(update_).first(nv)), pressed = largest(std::span(update_).subspan(nv));
    if (!std::isfinite(moved) || !std::isfinite(pressed)) {
      trouble_ = "a number in the state is not finite";
      return false;
    }
    double change = moved / std::max({norm(x_a), scale, smallest});
    if (multipliers) {
      // Multipliers that vanish are right to the rounding of the forces and inertias that leave nothing over.
      double forces = std::max(largest(x_c), largest(right_a_));
      for (std::size_t i = 0; i < nv; ++i) forces = std::max(forces, std::abs(system_.mass()[i] * x_a[i]));
      change = std::max(change, pressed / std::max(forces, smallest));
    }
    // What becomes exactly zero has no relative change.
    change = std::min(change, std::numeric_limits<double>::max());
    const double ratio = change / previous;
    previous = change;
    const double left = ratio < 1.0 ? ratio / (1.0 - ratio) * change : change;
    if (iteration > 0 && (left <= 1e-15 || (ratio >= 0.3 && change <= 1e-12))) return true;
    if (change == 0.0) return true;
    if (!fresh && iteration > 0 && ratio > slow_contraction) {
      if (!refactor(factor)) return false;
      fresh = true;
      previous = std::numeric_limits<double>::infinity();
    }
  }
  // A badly conditioned position (close to a singular one) stagnates above the target; what it reached is the best
  // there is.
  return true;
}

template <int width>
bool NewtonStageSolver::equations_hold(std::span<const double> x_a, std::span<const double> x_c) {
  const std::size_t nv = x_a.size();
  for (std::size_t i = 0; i < nv; ++i) {
    const double inertia = system_.mass()[i] * x_a[i];
    work_[i] = right_a_[i] - inertia;
    size_[i] = std::abs(right_a_[i]) + std::abs(inertia);
  }
  for (const JacobianBlock& block : system_.jacobian_blocks()) {
    const double* entry = &e_.jacobian[at(block.offset)];
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

// Leaves what is missing in `left`, by row.
template <int width>
bool NewtonStageSolver::rows_hold_in(std::span<const double> right, std::span<const double> x_a, double tolerance,
                                     std::span<double> left) {
  int failing = 0;
  for (std::size_t r = 0; r < right.size(); ++r) {
    double gap = right[r], size = std::abs(right[r]);
    for (const System::RowPiece& piece : system_.row_pieces(r)) {
      const double *entry = &e_.jacobian[at(piece.offset)], *rate = &x_a[at(piece.velocity)];
      for (int c = 0; c < width; ++c) {
        const double moved = entry[c] * rate[c];
        gap -= moved;
        size += std::abs(moved);
      }
    }
    left[r] = gap;
    failing += std::abs(gap) <= tolerance * rounding * size || dependent_[r] != 0 ? 0 : 1;
  }
  return failing == 0;
}

bool NewtonStageSolver::rows_hold(std::span<const double> right, std::span<const double> x_a, double tolerance,
                                  std::span<double> left) {
  return system_.body_velocities() == 3 ? rows_hold_in<3>(right, x_a, tolerance, left)
                                        : rows_hold_in<6>(right, x_a, tolerance, left);
}

bool NewtonStageSolver::holds_to_rounding(std::span<const double> x_a, std::span<const double> x_c) {
  return rows_hold(right_c_, x_a, 8.0, std::span(work_).first(right_c_.size())) &&
         (system_.body_velocities() == 3 ? equations_hold<3>(x_a, x_c) : equations_hold<6>(x_a, x_c));
}

bool NewtonStageSolver::velocities_hold(std::span<const double> v) { return rows_hold(e_.nu, v, 4.0, right_c_); }

// Phi_q depends on time and coordinates alone.
bool NewtonStageSolver::is_factored_here() const {
  return index_one_.valid &&
         std::memcmp(factored_at_.data(), e_.place.data(), factored_at_.size() * sizeof(double)) == 0;
}

bool NewtonStageSolver::project_velocity(StateView& state) {
  if (state.lambda.size == 0) return true;
  const Point here{*state.t, state.q, state.v, state.z, h_};
  if (!e_.has_rows_at(here) && !evaluate(state, rows)) return false;
  std::ranges::fill(multipliers_, 0.0);
  if (velocities_hold(state.v)) return true;
  const double speed = norm(state.v);
  if (!is_factored_here() && !refactor(index_one_)) return false;
  for (int pass = 0; pass < quick_passes; ++pass) {
    solve_rows(right_c_);
    if (!(norm(std::span(update_).first(increment_.size())) <= small_change * speed)) break;
    for (std::size_t i = 0; i < increment_.size(); ++i) state.v[i] += update_[i];
    for (std::size_t r = 0; r < multipliers_.size(); ++r) multipliers_[r] += update_[increment_.size() + r];
    if (velocities_hold(state.v)) return true;
  }
  std::ranges::fill(right_a_, 0.0);
  std::ranges::fill(increment_, 0.0);
  std::ranges::copy(multipliers_, other_lambda_.begin());
  std::ranges::fill(multipliers_, 0.0);
  // The change is a small part of v: digits below the rounding of v are not asked for.
  if (!refine(increment_, multipliers_, speed)) return false;
  for (std::size_t i = 0; i < increment_.size(); ++i) state.v[i] += increment_[i];
  for (std::size_t r = 0; r < multipliers_.size(); ++r) multipliers_[r] += other_lambda_[r];
  return true;
}

/// update_ <- the motion of least mass norm that changes the rows by `gap`, by the index-1 factors that there are.
void NewtonStageSolver::solve_rows(std::span<const double> gap) {
  const std::size_t nv = increment_.size();
  std::fill_n(right_.begin(), nv, 0.0);
  for (std::size_t r = 0; r < gap.size(); ++r) right_[nv + r] = dependent_[r] ? 0.0 : gap[r];
  index_one_.matrix.solve(right_, update_);
}

bool NewtonStageSolver::project_position(StateView& state) {
  if (state.lambda.size == 0) return true;
  const double target = 1e-14 * system_.size();
  double previous = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < options_.max_iterations; ++iteration) {
    // Where the last projection moved nothing, as of bodies that drivers alone move, accelerate() will follow here.
    if (!evaluate(state, drifts_ ? rows : index_one)) return false;
    const double gap = largest(e_.phi);
    drifts_ = !(gap <= target);
    if (gap <= target || (gap < 1e-12 * system_.size() && gap > 0.5 * previous)) return true;
    const bool slow = gap > slow_contraction * previous;
    if ((!index_one_.valid || slow) && !refactor(index_one_)) return false;
    previous = gap;
    for (std::size_t r = 0; r < e_.phi.size(); ++r) right_c_[r] = -e_.phi[r];
    solve_rows(right_c_);
    system_.retract(state.q, std::span(update_).first(increment_.size()), state.q);
  }
  trouble_ = "positions could not be projected on the constraints";
  return false;
}

bool NewtonStageSolver::accelerate(StateView& state, Span<double> z_rate) {
  if (!e_.is_at({*state.t, state.q, state.v, state.z, h_}, index_one) && !evaluate(state, index_one)) return false;
  if (any_dependent_) {
    const Profile::Timer timer(system_.profile(), Phase::factorization);
    system_.jacobian_entries(e_, entries_);
    // Rows that were left out in a singular position count again; not those that seem to say something new only because
    // a stage is a little off the constraints.
    if (rows_.analyse(entries_, off_constraints * largest(e_.phi) / system_.size()) > rank_) keep_independent_rows();
  }
  if (!is_factored_here() && !refactor(index_one_)) return false;
  // Nothing of the past enters, so that the same state always has the same accelerations.
  const std::size_t nv = state.a.size, nc = state.lambda.size;
  for (std::size_t i = 0; i < nv; ++i) right_[i] = e_.force[i];
  for (std::size_t r = 0; r < nc; ++r) right_[nv + r] = dependent_[r] ? 0.0 : e_.gamma[r];
  index_one_.matrix.solve(right_, update_);
  for (std::size_t i = 0; i < nv; ++i) state.a[i] = update_[i];
  for (std::size_t r = 0; r < nc; ++r) state.lambda[r] = update_[nv + r];
  if (!index_one_.matrix.is_well_conditioned()) {
    std::ranges::copy(e_.force, right_a_.begin());
    std::ranges::copy(e_.gamma, right_c_.begin());
    // Where drivers alone decide the motion, a is right at once and the multipliers are not.
    if (!holds_to_rounding(state.a, state.lambda) && !refine(state.a, state.lambda, 0.0, true)) return false;
  }
  std::ranges::copy(e_.internal_rate, z_rate.begin());
  if (any_dependent_) {
    const Profile::Timer timer(system_.profile(), Phase::solution);
    rows_.least_norm(state.lambda, system_.layout().first_driver_row());
  }
  if (flows_ != nullptr) flows_->flow(e_, state.lambda, z_rate.part(e_.internal_rate.size(), at(flows_->flows())));
  return true;
}

int NewtonStageSolver::weakest_row() {
  system_.jacobian_entries(e_, entries_);
  rows_.analyse(entries_);
  return rows_.weakest();
}

double NewtonStageSolver::error_norm(std::span<const double> position, std::span<const double> velocity) {
  if (!(allowed_ > 0.0)) return 0.0;
  const double in_velocity = part_of_allowed(velocity, allowed_rate_);
  const int worst_velocity = worst_component_;
  const double in_position = part_of_allowed(position, allowed_);
  if (in_position > in_velocity) return in_position;
  worst_component_ = worst_velocity;
  return in_velocity;
}

double NewtonStageSolver::part_of_allowed(std::span<const double> error, double allowed) {
  const bool split = regularity_ < near_singular && index_one_.valid && !right_c_.empty();
  const double across_allowed = std::sqrt(allowed * system_.size());
  if (split) {
    for (std::size_t i = 0; i < error.size(); ++i) right_[i] = system_.mass()[i] * error[i];
    std::fill(right_.begin() + static_cast<std::ptrdiff_t>(error.size()), right_.end(), 0.0);
    index_one_.matrix.solve(right_, update_);
  }
  double largest = 0.0;
  worst_component_ = 0;
  for (std::size_t i = 0; i < unit_.size(); ++i) {
    // `allowed` is a length: an angle may err by it over the size of the model.
    const double scale = system_.size() / unit_[i], along = split ? update_[i] : error[i];
    const double part = scale * (std::abs(along) / allowed + std::abs(error[i] - along) / across_allowed);
    if (!(part <= largest)) largest = part, worst_component_ = static_cast<int>(i);
  }
  return largest;
}

double NewtonStageSolver::internal_error_norm(double dt, const StateView& end, std::span<const double> error) {
  if (!(allowed_ > 0.0) || other_z_.empty()) return 0.0;
  // Behind the variables of the joints stand integrals of the account, which nothing depends on.
  for (std::size_t i = 0; i < other_z_.size(); ++i) other_z_[i] = end.z[i] + error[i];
  std::ranges::copy(end.a, other_a_.begin());
  std::ranges::copy(end.lambda, other_lambda_.begin());
  StateView other{end.t,         end.q, end.v, std::span(other_a_), std::span(other_lambda_), std::span(other_z_),
                  Span<double>{}};
  const EnergyAccount* flows = std::exchange(flows_, nullptr);
  const bool solved = accelerate(other, std::span(other_rate_));
  flows_ = flows;
  // What a joint refuses is no state to go on from.
  if (!solved) return std::numeric_limits<double>::infinity();
  double largest = 0.0;
  for (std::size_t i = 0; i < unit_.size(); ++i) {
    const double part = system_.size() / unit_[i] * dt * std::abs(other_a_[i] - end.a[i]) / allowed_rate_;
    if (!(part <= largest)) largest = part, worst_component_ = static_cast<int>(i);
  }
  return largest;
}

bool NewtonStageSolver::mobility(const State& state, int joint, std::span<double> out) {
  if (!system_.evaluate(point(state), term_position | only_asked, e_)) return false;
  const JointElement& element = system_.model().joints[at(joint)];
  const int markers[2] = {element.marker_a, element.marker_b};
  std::ranges::fill(out, 0.0);
  const std::size_t directions = system_.model().space == Space::planar ? 2 : 3;
  for (std::size_t direction = 0; direction < directions; ++direction) {
    std::ranges::fill(right_a_, 0.0);
    std::ranges::fill(right_c_, 0.0);
    double wrench[6] = {};
    for (const int end : {0, 1}) {
      wrench[direction] = end == 0 ? -1.0 : 1.0;
      if (system_.model().markers[at(markers[end])].body != ground) {
        system_.add_wrench(markers[end], wrench, e_, right_a_);
      }
    }
    std::ranges::fill(increment_, 0.0);
    std::ranges::fill(multipliers_, 0.0);
    if (!refine(increment_, multipliers_, 0.0)) return false;
    const std::size_t width = at(system_.body_velocities());
    for (const int end : {0, 1}) {
      const BodyId body = system_.model().markers[at(markers[end])].body;
      if (body == ground) continue;
      for (std::size_t i = 0; i < directions; ++i) {
        double g[6] = {}, row[6];
        g[i] = end == 0 ? -1.0 : 1.0;
        system_.marker_row(markers[end], g, e_, row);
        for (std::size_t c = 0; c < width; ++c) out[3 * i + direction] += row[c] * increment_[width * at(body) + c];
      }
    }
  }
  return true;
}

}  // namespace freeplay
