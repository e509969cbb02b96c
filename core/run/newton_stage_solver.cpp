#include "run/newton_stage_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace freeplay {
namespace {

constexpr double rounding = std::numeric_limits<double>::epsilon();
constexpr double singular_pivot = 1e-13;     // smallest pivot over the largest
constexpr double slow_contraction = 0.1;     // a stale factor that contracts less is renewed
constexpr double internal_tolerance = 1e-8;  // last change of an internal variable, relative; the next is its square
constexpr int refinement_limit = 30;
constexpr double smallest = std::numeric_limits<double>::min();
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
             [](void*, Span<const double> q_base, Span<const double> increment, Span<double> q) noexcept {
               planar::retract(q_base, increment, q);
             },
             0},
      e_(system),
      rows_(system.layout().nc(), system.layout().nv()) {
  const int nv = system.layout().nv(), nc = system.layout().nc();
  const auto body_entries = [&](BodyId row_body, BodyId column_body) {
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        const bool inside = row_body != ground && column_body != ground;
        // Places on ground are pointed at the first diagonal entry and never written.
        entries_.push_back(inside ? MatrixEntry{3 * row_body + r, 3 * column_body + c} : MatrixEntry{0, 0});
      }
    }
  };
  for (int i = 0; i < nv; ++i) entries_.push_back({i, i});
  for (int i = 0; i < nc; ++i) entries_.push_back({nv + i, nv + i});
  for (const ForceBlock& block : system.force_blocks()) {
    const BodyId bodies[2] = {block.a, block.b};
    for (const BodyId row : bodies) {
      for (const BodyId column : bodies) body_entries(row, column);
    }
  }
  for (const JacobianBlock& block : system.jacobian_blocks()) {
    for (int r = 0; r < block.rows; ++r) {
      for (int c = 0; c < 3; ++c) {
        entries_.push_back({nv + block.row + r, 3 * block.body + c});
        entries_.push_back({3 * block.body + c, nv + block.row + r});
      }
    }
  }
  for (Factor& factor : factors_) {
    factor.matrix = make_dense_kkt();
    factor.slots = factor.matrix->set_pattern(nv + nc, entries_);
    factor.internal = std::make_unique<InternalElimination>(system);
  }
  for (int i = 0; i < nv; ++i) unit_.push_back(i % 3 == 2 ? 1.0 : system.size());
  dense_.resize(at(nc) * at(nv));
  right_.resize(at(nv + nc));
  update_.resize(at(nv + nc));
  increment_.resize(at(nv));
  z_rate_.resize(at(system.layout().nz()));
  right_a_.resize(at(nv));
  right_c_.resize(at(nc));
  work_.resize(at(nv + nc));
  multipliers_.resize(at(nc));
  dependent_.assign(at(nc), 0);
}

NewtonStageSolver::Factor& NewtonStageSolver::factor_for(double beta_q, double beta_v) {
  ++clock_;
  Factor* oldest = &factors_[0];
  for (Factor& factor : factors_) {
    // A factor only preconditions the iteration: betas that differ by rounding may share it.
    if (std::abs(factor.beta_q - beta_q) <= 1e-6 * beta_q && std::abs(factor.beta_v - beta_v) <= 1e-6 * beta_v) {
      factor.used = clock_;
      return factor;
    }
    if (factor.used < oldest->used) oldest = &factor;
  }
  oldest->beta_q = beta_q;
  oldest->beta_v = beta_v;
  oldest->used = clock_;
  oldest->valid = false;
  return *oldest;
}

bool NewtonStageSolver::evaluate(const StateView& s, unsigned terms) {
  const Point point{*s.t, s.q, s.v, s.z, h_};
  if (system_.evaluate(point, terms, e_)) return true;
  trouble_ = e_.fault.kind == Fault::Kind::plugin ? e_.fault.message.text : e_.fault.motion.text;
  return false;
}

void NewtonStageSolver::assemble(Factor& factor) {
  const std::span<double> values = factor.matrix->values();
  const int* slot = factor.slots.data();
  std::ranges::fill(values, 0.0);
  for (const double mass : system_.mass()) values[at(*slot++)] += mass;
  for (const char dependent : dependent_) values[at(*slot++)] += dependent ? 1.0 : 0.0;
  const bool forces = factor.beta_q > 0.0 || factor.beta_v > 0.0;
  if (forces && !factor.internal->empty()) {
    factor.internal->prepare(e_, factor.beta_q, factor.beta_v, factor.beta_z);
    factor.internal->add_to_matrix([&](std::size_t block, int r, int c, double value) {
      const BodyId row = r < 3 ? system_.force_blocks()[block].a : system_.force_blocks()[block].b;
      const BodyId column = c < 3 ? system_.force_blocks()[block].a : system_.force_blocks()[block].b;
      // Slots of a force block: four 3 x 3 pieces, row body by column body.
      const int piece = 9 * (2 * (r / 3) + c / 3) + 3 * (r % 3) + c % 3;
      if (row != ground && column != ground) values[at(slot[36 * block + at(piece)])] += value;
    });
  }
  for (std::size_t f = 0; f < system_.force_blocks().size(); ++f) {
    const ForceBlock& block = system_.force_blocks()[f];
    const BodyId bodies[2] = {block.a, block.b};
    for (int i = 0; i < 2; ++i) {
      for (int k = 0; k < 2; ++k) {
        if (!forces || bodies[i] == ground || bodies[k] == ground) {
          slot += 9;
          continue;
        }
        for (int r = 0; r < 3; ++r) {
          for (int c = 0; c < 3; ++c) {
            const std::size_t entry = 36 * f + at((3 * i + r) * 6 + 3 * k + c);
            values[at(*slot++)] -= factor.beta_v * e_.force_v[entry] + factor.beta_q * e_.force_q[entry];
          }
        }
      }
    }
  }
  for (const JacobianBlock& block : system_.jacobian_blocks()) {
    for (int r = 0; r < block.rows; ++r) {
      const bool dependent = dependent_[at(block.row + r)] != 0;
      for (int c = 0; c < 3; ++c) {
        const double entry = dependent ? 0.0 : e_.jacobian[at(block.offset + 3 * r + c)];
        values[at(*slot++)] += entry;
        values[at(*slot++)] += entry;
      }
    }
  }
}

bool NewtonStageSolver::find_dependent_rows() {
  system_.dense_jacobian(e_, dense_);
  rows_.analyse(dense_);
  rank_known_ = true;
  const bool same = std::ranges::equal(rows_.dependent(), dependent_);
  std::ranges::copy(rows_.dependent(), dependent_.begin());
  any_dependent_ = rows_.rank() < system_.layout().nc();
  if (!same) {
    for (Factor& factor : factors_) factor.valid = false;
  }
  return !same;
}

bool NewtonStageSolver::refactor(Factor& factor) {
  if (!rank_known_) find_dependent_rows();
  assemble(factor);
  ++factorizations_;
  double pivot = factor.matrix->factor();
  if (!(pivot > singular_pivot) && find_dependent_rows()) {
    // The rank has changed along the motion: the rows that say nothing new are left out.
    assemble(factor);
    ++factorizations_;
    pivot = factor.matrix->factor();
  }
  factor.valid = pivot > 0.0 && std::isfinite(pivot);
  if (!factor.valid) trouble_ = "the equations of motion are singular";
  return factor.valid;
}

void NewtonStageSolver::solve_with(const Factor& factor) { factor.matrix->solve(right_, update_); }

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
    planar::retract(stage.q_base, increment_, out.q);
    for (std::size_t i = 0; i < z_rate_.size(); ++i) out.z[i] = stage.z_known[i] + stage.beta_z * z_rate_[i];
    const unsigned terms = term_position | term_velocity | term_force;
    const bool renew = !factor.valid || (!fresh && ratio > slow_contraction && iteration > 1);
    if (!evaluate(out, terms | (renew ? term_derivative : 0u))) return false;
    if (renew) {
      if (!refactor(factor)) return true;  // singular: not converged, a shorter step may do
      fresh = true;
    }
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
    if (!factor.internal->empty()) {
      factor.internal->add_to_right(e_.internal_rate, z_rate_, std::span(right_).first(at(nv)));
    }
    solve_with(factor);
    for (std::size_t i = 0; i < at(nv); ++i) out.a[i] += update_[i];
    for (std::size_t r = 0; r < at(nc); ++r) out.lambda[r] += update_[at(nv) + r];
    bool internal_settled = true;
    if (!factor.internal->empty()) {
      internal_settled = factor.internal->advance(std::span(update_).first(at(nv)), stage.beta_z, out.z, z_rate_) <=
                         internal_tolerance;
    }

    const double change = norm(std::span(update_).first(at(nv)));
    if (!std::isfinite(change)) {
      trouble_ = "a number in the state is not finite";
      return true;
    }
    ratio = iteration == 0 ? 1.0 : change / previous;
    previous = change;
    // Left over after this update: a geometric series of ratio r. Judged in position and, with a unit time of 1 s, in
    // velocity. Below the noise of Phi (rounding of coordinates, divided by beta_q) nothing more can be won.
    const double left = ratio < 1.0 ? ratio / (1.0 - ratio) * change : change;
    const bool accurate = iteration > 0 && left * beta_q <= options_.tolerance && left * beta_v <= options_.tolerance;
    const bool noise = change * beta_q <= 50.0 * rounding && (ratio >= 0.3 || change * beta_q <= rounding);
    if (internal_settled && (accurate || (iteration > 0 && noise) || change == 0.0)) {
      for (std::size_t i = 0; i < at(nv); ++i) {
        out.v[i] = stage.v_known[i] + beta_v * out.a[i];
        increment_[i] = stage.increment_known[i] + beta_q * out.a[i];
      }
      planar::retract(stage.q_base, increment_, out.q);
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

bool NewtonStageSolver::refine(std::span<double> x_a, std::span<double> x_c, double scale, bool multipliers) {
  const std::size_t nv = x_a.size(), nc = x_c.size();
  Factor& factor = factor_for(0.0, 0.0);
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
    solve_with(factor);
    for (std::size_t i = 0; i < nv; ++i) x_a[i] += update_[i];
    for (std::size_t r = 0; r < nc; ++r) x_c[r] += update_[nv + r];
    double change = norm(std::span(update_).first(nv)) / std::max({norm(x_a), scale, smallest});
    if (multipliers) {
      // Multipliers that vanish are right to the rounding of the forces and inertias that leave nothing over.
      double forces = std::max(largest(x_c), largest(right_a_));
      for (std::size_t i = 0; i < nv; ++i) forces = std::max(forces, std::abs(system_.mass()[i] * x_a[i]));
      change = std::max(change, largest(std::span(update_).subspan(nv)) / std::max(forces, smallest));
    }
    if (!std::isfinite(change)) {
      trouble_ = "a number in the state is not finite";
      return false;
    }
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

bool NewtonStageSolver::project_velocity(StateView& state) {
  if (state.lambda.size == 0) return true;
  if (!evaluate(state, term_position | term_velocity)) return false;
  std::ranges::fill(right_a_, 0.0);
  system_.multiply(e_, state.v, right_c_);
  for (std::size_t r = 0; r < right_c_.size(); ++r) right_c_[r] = e_.nu[r] - right_c_[r];
  std::ranges::fill(increment_, 0.0);
  std::ranges::fill(multipliers_, 0.0);
  // The change is a small part of v: digits below the rounding of v are not asked for.
  if (!refine(increment_, multipliers_, norm(state.v))) return false;
  for (std::size_t i = 0; i < increment_.size(); ++i) state.v[i] += increment_[i];
  return true;
}

bool NewtonStageSolver::project_position(StateView& state) {
  if (state.lambda.size == 0) return true;
  const double target = 1e-14 * system_.size();
  double previous = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < options_.max_iterations; ++iteration) {
    if (!evaluate(state, term_position | term_velocity)) return false;
    double largest = 0.0;
    for (std::size_t r = 0; r < right_c_.size(); ++r) {
      right_c_[r] = -e_.phi[r];
      largest = std::max(largest, std::abs(e_.phi[r]));
    }
    if (largest <= target || (largest < 1e-12 * system_.size() && largest > 0.5 * previous)) return true;
    previous = largest;
    std::ranges::fill(right_a_, 0.0);
    std::ranges::fill(increment_, 0.0);
    std::ranges::fill(multipliers_, 0.0);
    if (!refine(increment_, multipliers_, 0.0)) return false;
    planar::retract(state.q, increment_, state.q);
  }
  trouble_ = "positions could not be projected on the constraints";
  return false;
}

bool NewtonStageSolver::accelerate(StateView& state, Span<double> z_rate) {
  if (!evaluate(state, term_position | term_velocity | term_acceleration | term_force)) return false;
  std::ranges::copy(e_.force, right_a_.begin());
  std::ranges::copy(e_.gamma, right_c_.begin());
  // Where drivers alone decide the motion, a is right at once and the multipliers are not.
  if (!refine(state.a, state.lambda, 0.0, true)) return false;
  std::ranges::copy(e_.internal_rate, z_rate.begin());
  if (any_dependent_) {
    system_.dense_jacobian(e_, dense_);
    rows_.analyse(dense_);
    rows_.least_norm(state.lambda, system_.layout().first_driver_row());
  }
  if (flows_ != nullptr) flows_->flow(e_, state.lambda, z_rate.part(e_.internal_rate.size(), at(flows_->flows())));
  return true;
}

double NewtonStageSolver::error_norm(std::span<const double> position, std::span<const double> velocity) {
  if (!(allowed_ > 0.0)) return 0.0;
  double largest = 0.0;
  for (std::size_t i = 0; i < unit_.size(); ++i) {
    // `allowed_` is a length: an angle may err by it over the size of the model.
    const double scale = system_.size() / unit_[i];
    const double error = scale * std::max(std::abs(position[i]) / allowed_, std::abs(velocity[i]) / allowed_rate_);
    if (!(error <= largest)) largest = error, worst_component_ = static_cast<int>(i);
  }
  return largest;
}

bool NewtonStageSolver::mobility(const State& state, int joint, std::span<double> out) {
  if (!system_.evaluate(point(state), term_position, e_)) return false;
  const JointElement& element = system_.model().joints[at(joint)];
  const int markers[2] = {element.marker_a, element.marker_b};
  std::ranges::fill(out, 0.0);
  for (std::size_t direction = 0; direction < 2; ++direction) {
    std::ranges::fill(right_a_, 0.0);
    std::ranges::fill(right_c_, 0.0);
    for (std::size_t end = 0; end < 2; ++end) {
      const BodyId body = system_.model().markers[at(markers[end])].body;
      if (body == ground) continue;
      double wrench[6] = {};
      wrench[direction] = end == 0 ? -1.0 : 1.0;
      planar::add_wrench(wrench, e_.arms[at(markers[end])], &right_a_[3 * at(body)]);
    }
    std::ranges::fill(increment_, 0.0);
    std::ranges::fill(multipliers_, 0.0);
    if (!refine(increment_, multipliers_, 0.0)) return false;
    for (std::size_t end = 0; end < 2; ++end) {
      const BodyId body = system_.model().markers[at(markers[end])].body;
      if (body == ground) continue;
      const double* x = &increment_[3 * at(body)];
      const planar::Arm& arm = e_.arms[at(markers[end])];
      const double sign = end == 0 ? -1.0 : 1.0;
      out[direction] += sign * (x[0] - arm.y * x[2]);
      out[3 + direction] += sign * (x[1] + arm.x * x[2]);
    }
  }
  return true;
}

}  // namespace freeplay
