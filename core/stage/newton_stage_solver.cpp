#include "stage/newton_stage_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "freeplay/pairs.h"

namespace freeplay {
namespace {

constexpr double rounding = std::numeric_limits<double>::epsilon();
constexpr double internal_tolerance = 1e-8;  // last change of an internal variable, relative; the next is its square
// A contraction that was seen stands for others that may be so much worse, for so many stages.
constexpr double careful = 10.0, least_contraction = 1e-5;
constexpr int seen_for = 8;
constexpr double most_foreseen = 100.0;  // size of a first update that may be the only one, in tolerances
constexpr int most_stays = 3;            // iterations that roundings alone could have kept large, with old factors
constexpr int noise_for = 64;            // stages, until noise is looked at again
constexpr double immaterial = 0.1;       // part of the tolerance, or of a rounding
constexpr int kept_factors = 4;
constexpr std::size_t few_unknowns = 100;
constexpr double unknown_contraction = 0.5;  // at most, while factors are those of the same forces
constexpr double roundings_of_phi = 16.0;    // of its largest terms: what is left of Phi then says nothing
constexpr double few_units = 10.0;           // a coordinate no larger rounds as a unit does
constexpr double drift = 4.0;                // times as much may come of the steps before
constexpr double small_part = 1e-4;          // of the first update: much less than what the step itself errs
constexpr double many_steps = 5000.0;        // that together may move by the tolerance
constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

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
             },
             [](void* self) noexcept { return static_cast<NewtonStageSolver*>(self)->guess_error_; },
             [](void* self, double beta_q, double beta_v, Span<const double> missed) noexcept {
               return static_cast<NewtonStageSolver*>(self)->unsolved_error(beta_q, beta_v, missed);
             }},
      equations_(system),
      index_one_(equations_, options.max_iterations),
      e_(equations_.evaluation()) {
  const int nv = system.layout().nv(), nc = system.layout().nc();
  for (int i = 0; i < kept_factors; ++i) factors_.push_back({.matrix = StageMatrix(system, true)});
  right_.resize(at(nv + nc));
  update_.resize(at(nv + nc));
  increment_.resize(at(nv));
  drift_.resize(at(nv));
  z_rate_.resize(at(system.layout().nz()));
  work_.resize(at(nv + nc));
  quiet_phi_.resize(at(nc));
  other_a_.resize(at(nv));
  other_lambda_.resize(at(nc));
  other_z_.resize(at(system.layout().nz()));
  other_rate_.resize(other_z_.size());
  const Model& model = system.model();
  for (const Gear& gear : model.gears) {
    const std::size_t row = at(system.layout().rows(gear.joint).offset);
    coordinate_terms_.push_back({row, at(gear.first), std::abs(gear.ratio)});
    coordinate_terms_.push_back({row, at(gear.second), 1.0});
  }
  for (std::size_t d = 0; d < model.drivers.size(); ++d) {
    const int row = system.layout().driver_row(static_cast<int>(d));
    if (row >= 0 && row < nc) coordinate_terms_.push_back({at(row), at(model.drivers[d].joint), 1.0});
  }
}

NewtonStageSolver::Factor& NewtonStageSolver::factor_for(double beta_q, double beta_v) {
  follow_choice_of_rows();
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

// Where little is needed, that of all factors: no step length allocates then.
void NewtonStageSolver::set_pattern(Factor& factor) {
  const Profile::Timer start(system_.profile(), Phase::start);
  for (Factor& each : factors_) {
    if (&each != &factor && update_.size() > few_unknowns) continue;
    each.matrix.set_pattern(equations_.dependent());
    each.has_pattern = true;
  }
}

double NewtonStageSolver::factor_once(Factor& factor) {
  if (!factor.has_pattern) set_pattern(factor);
  ++factorizations_;
  return factor.matrix.factor(e_, factor.beta_q, factor.beta_v, factor.beta_z);
}

bool NewtonStageSolver::refactor(Factor& factor) {
  const Profile::Timer timer(system_.profile(), Phase::factorization);
  index_one_.know_rows();
  follow_choice_of_rows();
  double pivot = factor_once(factor);
  // The rank may have changed along the motion: rows that say nothing new are then left out.
  if (!(pivot > IndependentRows::singular_pivot) && find_dependent_rows()) pivot = factor_once(factor);
  note_rounding_of_phi();
  factor.valid = pivot > 0.0 && std::isfinite(pivot);
  if (!factor.valid) equations_.note_trouble("the equations of motion are singular");
  return factor.valid;
}

// A row rounds as the coordinates do that it is made of: by units, where they are not many units large.
void NewtonStageSolver::note_rounding_of_phi() {
  const std::size_t width = at(system_.body_velocities());
  const std::span<const double> unit = equations_.units();
  coarse_ = 1.0;
  for (std::size_t i = 0; i < equations_.units().size(); ++i) {
    const std::size_t body = i / width, c = i % width;
    const bool told = width == 3 || c < 3;  // else part of a quaternion
    const double size = told ? std::abs(e_->q[(width == 3 ? 3 : 7) * body + c]) / (few_units * unit[i]) : 0.0;
    work_[i] = unit[i] * std::max(1.0, size);
    coarse_ = std::max(coarse_, size);
  }
  for (std::size_t r = 0; r < quiet_phi_.size(); ++r) {
    double largest_term = 0.0;
    for (const System::RowPiece& piece : system_.row_pieces(r)) {
      for (std::size_t c = 0; c < width; ++c) {
        largest_term =
            std::max(largest_term, std::abs(e_->jacobian[at(piece.offset) + c]) * work_[at(piece.velocity) + c]);
      }
    }
    quiet_phi_[r] = roundings_of_phi * rounding * largest_term;
  }
  note_turns();
}

// Coordinates of joints are counted over turns: they grow while matrices stay.
void NewtonStageSolver::note_turns() {
  for (const CoordinateTerm& term : coordinate_terms_) {
    const double size = std::abs(e_->coordinate[term.joint]);
    quiet_phi_[term.row] = std::max(quiet_phi_[term.row], roundings_of_phi * rounding * term.factor * size);
    coarse_ = std::max(coarse_, size / few_units);
  }
}

bool NewtonStageSolver::find_dependent_rows() {
  const bool others = equations_.rows().find(e_);
  follow_choice_of_rows();
  return others;
}

// Factors with other rows than those that are kept are of no use.
void NewtonStageSolver::follow_choice_of_rows() {
  if (choice_of_rows_ == equations_.rows().choice()) return;
  choice_of_rows_ = equations_.rows().choice();
  for (Factor& factor : factors_) factor.valid = factor.has_pattern = false;
}

void NewtonStageSolver::follow_accelerations(const Stage& stage, StateView& out) {
  in_pairs(increment_.size(), [&](auto at) {
    at(out.v) = at(stage.v_known) + stage.beta_v * at(out.a);
    at(increment_) = at(stage.increment_known) + stage.beta_q * at(out.a);
  });
  system_.retract(stage.q_base, increment_, out.q);
  for (std::size_t i = 0; i < z_rate_.size(); ++i) out.z[i] = stage.z_known[i] + stage.beta_z * z_rate_[i];
}

bool NewtonStageSolver::solve(const Stage& stage, StateView& out, StageResult& result) {
  const int nv = system_.layout().nv(), nc = system_.layout().nc();
  const double beta_v = stage.beta_v, beta_q = stage.beta_q;
  const double way = std::max(beta_q, beta_v);
  const std::span<const char> dependent = equations_.dependent();
  double allowed = options_.tolerance;  // in velocity, with a unit time of 1 s
  const bool position = stage.level == ConstraintLevel::position;
  result = {0, 0};
  worst_row_ = -1;
  equations_.note_trouble("");
  *out.t = stage.t;
  std::ranges::fill(z_rate_, 0.0);
  Factor& factor = factor_for(beta_q, beta_v);
  factor.beta_z = stage.beta_z;
  bool fresh = false, drifted = false;
  double previous = std::numeric_limits<double>::infinity(), ratio = 1.0;
  int diverging = 0;
  for (int iteration = 0; iteration <= options_.max_iterations; ++iteration) {
    follow_accelerations(stage, out);
    // Without rows what is looked at here may be the end of the step already, see below.
    const unsigned terms = term_position | term_force | (nc == 0 ? term_velocity | term_acceleration : 0u) |
                           (position ? 0u : term_velocity);
    const bool renew = !factor.valid || (!fresh && ratio > IndexOneSolver::slow_contraction && iteration > 1);
    if (!equations_.evaluate(out, terms | (renew ? term_derivative : 0u))) return false;
    if (renew) {
      if (!refactor(factor)) return true;  // singular: not converged, a shorter step may do
      fresh = true;
      factor.contraction = 1.0;
    }
    const bool same_forces = e_->acting == factor.acting;
    if (iteration == 0) note_turns();
    if (iteration == 0 && !same_forces) factor.contraction = 1.0, factor.noise = 0.0;
    factor.acting = e_->acting;
    ++iterations_;
    ++result.iterations;

    std::fill(right_.begin(), right_.end(), 0.0);
    system_.add_transposed(e_, out.lambda, std::span(right_).first(at(nv)));
    in_pairs(at(nv), [&](auto at) { at(right_) = at(e_->force) - at(system_.mass()) * at(out.a) - at(right_); });
    if (position) {
      const bool held = rows_hold();
      if (iteration == 0) drifted = is_drift(factor, held);
      if (!held) ask_for_rows(beta_q, drifted);
    } else {
      system_.multiply(e_, out.v, std::span(work_).first(at(nc)));
      for (std::size_t r = 0; r < at(nc); ++r) right_[at(nv) + r] = (e_->nu[r] - work_[r]) / beta_v;
    }
    if (equations_.rows().any_dependent()) {
      for (std::size_t r = 0; r < at(nc); ++r) {
        if (dependent[r]) right_[at(nv) + r] = 0.0;
      }
    }
    if (!factor.matrix.internal().empty()) {
      factor.matrix.internal().add_to_right(e_->internal_rate, z_rate_, std::span(right_).first(at(nv)));
    }
    factor.matrix.solve(right_, update_);
    const double change = equations_.norm(std::span(update_).first(at(nv)));
    if (iteration == 0) {
      const double most = options_.tolerance * std::max(1.0, 1.0 / (many_steps * beta_v));
      allowed = std::clamp(small_part * change * beta_v, options_.tolerance, most);
      guess_error_ = change * way / allowed;
      if (drifted) learn_drift(factor, out);
    }
    // What moves nothing any more is left as it was looked at: the accelerations there cost no other look.
    const bool there =
        nc == 0 && iteration > 0 && factor.matrix.internal().empty() && change * way <= immaterial * allowed;
    if (there) std::ranges::fill(update_, 0.0);
    in_pairs(at(nv), [&](auto at) { at(out.a) += at(update_); });
    in_pairs(at(nc), [&](auto row) { row(out.lambda) += row(std::span(update_).subspan(at(nv))); });
    bool internal_settled = true;
    if (!factor.matrix.internal().empty()) {
      internal_settled = factor.matrix.internal().advance(std::span(update_).first(at(nv)), stage.beta_z, out.z,
                                                          z_rate_) <= internal_tolerance;
    }

    if (!std::isfinite(change)) {
      equations_.note_trouble("a number in the state is not finite");
      return true;
    }
    const double change_before = previous;
    ratio = iteration == 0 ? 1.0 : change / previous;
    previous = change;
    // Left over after this update: a geometric series of ratio r. Below the noise of Phi (rounding of coordinates,
    // divided by beta_q) nothing more can be won.
    if (iteration > 0 && change_before * beta_q > 8.0 * rounding) {
      factor.contraction = std::max({careful * ratio, 0.5 * factor.contraction, least_contraction});
      factor.since_seen = 0;
    }
    // The first update has no ratio of its own. Where it is small, that of a stage not long ago stands for it, with the
    // same forces on.
    const bool foreseen = iteration == 0 && factor.contraction < 0.1 && change * way <= most_foreseen * allowed &&
                          ++factor.since_seen <= seen_for;
    const double part = foreseen ? factor.contraction : iteration == 0 ? unknown_contraction : ratio;
    const double left = part < 1.0 ? part / (1.0 - part) * change : change;
    const bool judged = iteration > 0 || same_forces;  // which what is foreseen needs, too
    const bool accurate = judged && ((left * beta_q <= options_.tolerance && left * beta_v <= allowed) ||
                                     left * beta_q <= immaterial * rounding * coarse_);
    // What does not shrink although it moves positions by roundings alone is noise, or comes of old factors: which of
    // both, new ones tell.
    const bool tiny = change * beta_q <= 50.0 * rounding * coarse_;
    const bool stays = iteration > 0 && tiny && ratio >= 0.3;
    if (stays && fresh) factor.noise = std::max(change, 0.5 * factor.noise), factor.since_noise = 0;
    if (stays && !fresh && ++factor.stays > most_stays) factor.stays = 0, factor.valid = false;
    const bool quiet = iteration == 0 && tiny && change <= 2.0 * factor.noise && ++factor.since_noise <= noise_for;
    const bool noise = stays || quiet || (iteration > 0 && change * beta_q <= rounding * coarse_);
    const bool stagnates = position && fresh && !accurate && !noise && ratio >= 0.3 && iteration > 0;
    if (internal_settled &&
        (accurate || noise || change == 0.0 || (stagnates && is_rounding_of_phi(factor, way, drifted)))) {
      follow_accelerations(stage, out);
      if (equations_.rows().any_dependent()) {
        // Rows that were left out must hold by themselves.
        for (std::size_t r = 0; r < at(nc); ++r) {
          if (dependent[r] && position && std::abs(e_->phi[r]) > 1e-9 * system_.size()) {
            worst_row_ = static_cast<int>(r);
            if (find_dependent_rows()) break;
            equations_.note_trouble("redundant constraints contradict each other");
            return true;
          }
        }
        if (worst_row_ >= 0) {
          worst_row_ = -1;
          previous = std::numeric_limits<double>::infinity();
          continue;
        }
      }
      if (drifted) system_.retract(out.q, drift_, out.q);
      result.converged = 1;
      return true;
    }
    if (fresh && ratio > 2.0 && iteration > 0 && ++diverging >= 2) break;
    if (fresh && ratio > IndexOneSolver::slow_contraction && iteration > 2)
      factor.valid = false;  // full Newton from here
  }
  equations_.note_trouble("the iteration of a stage did not converge");
  double farthest = -1.0;
  for (int r = 0; r < nc; ++r) {
    if (std::abs(e_->phi[at(r)]) > farthest) farthest = std::abs(e_->phi[at(r)]), worst_row_ = r;
  }
  return true;
}

double NewtonStageSolver::unsolved_error(double beta_q, double beta_v, std::span<const double> missed) {
  Factor& factor = factor_for(beta_q, beta_v);
  note_turns();
  if (!rows_hold(drift)) return std::numeric_limits<double>::infinity();
  ++factor.held;
  return equations_.norm(missed) * std::max(beta_q, beta_v) / options_.tolerance;
}

void NewtonStageSolver::ask_for_rows(double beta_q, bool drifted) {
  const std::span<const char> dependent = equations_.dependent();
  const double* const phi = e_->phi.data();
  double* const right = &right_[equations_.units().size()];
  const double quiet = drifted ? drift : 1.0;
  for (std::size_t r = 0; r < quiet_phi_.size(); ++r) {
    right[r] = std::abs(phi[r]) <= quiet * quiet_phi_[r] || dependent[r] ? 0.0 : -phi[r] / beta_q;
  }
}

bool NewtonStageSolver::rows_hold(double times) const {
  const std::span<const char> dependent = equations_.dependent();
  int off = 0;
  for (std::size_t r = 0; r < quiet_phi_.size(); ++r) {
    off += std::abs(e_->phi[r]) <= times * quiet_phi_[r] || dependent[r] ? 0 : 1;
  }
  return off == 0;
}

bool NewtonStageSolver::is_drift(Factor& factor, bool held) const {
  ++factor.held;
  if (held) return false;
  const bool drifted = rows_hold(drift);
  if (!drifted) factor.held = 0;
  return drifted;
}

void NewtonStageSolver::learn_drift(Factor& factor, StateView& out) {
  const std::size_t nv = equations_.units().size(), nc = e_->phi.size();
  const std::span<const char> dependent = equations_.dependent();
  const double part = 1.0 / factor.held;
  factor.held = 0;
  std::fill(right_.begin(), right_.end(), 0.0);
  for (std::size_t r = 0; r < nc; ++r) right_[nv + r] = dependent[r] ? 0.0 : -e_->phi[r] / factor.beta_q;
  factor.matrix.solve(right_, work_);
  in_pairs(nv, [&](auto at) {
    at(out.a) += part * at(work_);
    at(drift_) = (1.0 - part) * factor.beta_q * at(work_);
  });
  for (std::size_t r = 0; r < nc; ++r) out.lambda[r] += part * work_[nv + r];
}

bool NewtonStageSolver::is_rounding_of_phi(const Factor& factor, double way, bool drifted) {
  for (std::size_t r = 0; r < quiet_phi_.size(); ++r) {
    if (!(std::abs(e_->phi[r]) <= std::max(8.0 * rounding * system_.size(), quiet_phi_[r]))) return false;
  }
  const std::size_t nv = equations_.units().size();
  std::fill(right_.begin(), right_.end(), 0.0);
  ask_for_rows(factor.beta_q, drifted);
  factor.matrix.solve(right_, work_);
  for (std::size_t i = 0; i < nv; ++i) work_[i] = update_[i] - work_[i];
  return equations_.norm(std::span(work_).first(nv)) * way <= options_.tolerance;
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
  const std::span<double> motion = std::span(update_).first(equations_.units().size());
  const bool split = index_one_.part_along_motion(error, motion);
  const std::span<const double> unit = equations_.units();
  const double across_allowed = std::sqrt(allowed * system_.size());
  double largest = 0.0;
  worst_component_ = 0;
  for (std::size_t i = 0; i < equations_.units().size(); ++i) {
    // `allowed` is a length: an angle may err by it over the size of the model.
    const double scale = system_.size() / unit[i], along = split ? motion[i] : error[i];
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
  const Flows* flows = index_one_.integrate_flows(nullptr);
  const bool solved = index_one_.accelerate(other, std::span(other_rate_));
  index_one_.integrate_flows(flows);
  // What a joint refuses is no state to go on from.
  if (!solved) return std::numeric_limits<double>::infinity();
  const std::span<const double> unit = equations_.units();
  double largest = 0.0;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const double part = system_.size() / unit[i] * dt * std::abs(other_a_[i] - end.a[i]) / allowed_rate_;
    if (!(part <= largest)) largest = part, worst_component_ = static_cast<int>(i);
  }
  return largest;
}

}  // namespace freeplay
