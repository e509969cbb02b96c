// StepError: local error of any one-step method of order 2, from one more evaluation in the middle of the step; and a
// result without it.
#pragma once

#include <algorithm>

#include "freeplay/integrator.h"

namespace freeplay {

/// Compares the end of a step with Simpson's rule on the accelerations at its start, middle and end (n, m, 1; step h):
///
///   e_v = v_1 - v_n - h/6 (a_n + 4 a_m + a_1)          e_d = d_1 - h/6 (d'_n + 4 d'_m + d'_1)
///
/// with the increment d of the position and its rates d' (v itself but for rotations in space) at velocities without
/// their own error, for which e_d = d_1 - h v_n - h^2/6 (a_n + 2 a_m) in the plane; internal variables z and their
/// rates are judged like v and a. The middle is the cubic through (d, d') and (v, a) at both ends, which errs by h^4
/// more than the ends do (likewise z, z'), and a_m solves the equations of motion there. All three accelerations
/// satisfy the constraints, so that no error of a stage's multiplier is in e. e tends to the local error where that is
/// of order h^3: the difference of the two is of order h^4.
///
/// A step that passes is therefore better by an order without e: it is taken off (local extrapolation; Shampine 1977,
/// SIAM J Numer Anal 14), and what is left over a run falls with what a step may err by, whatever the number of steps:
/// that of the method itself would fall with its power 2/3. Not where the equations are stiff in the direction of e,
/// h |da| > |e| by the accelerations at both results: there the method damps what Simpson's rule would amplify.
class StepError {
 public:
  static std::int32_t scratch(const Sizes& n) { return 2 * n.nq + 7 * n.nv + 2 * n.nc + 5 * n.nz; }

  /// `work`: scratch() numbers.
  StepError(const StateView& s, Span<double> work) {
    std::size_t used = 0;
    const auto take = [&](std::size_t count) {
      used += count;
      return work.part(used - count, count);
    };
    middle_ = {nullptr,        take(s.q.size), take(s.v.size), take(s.v.size), take(s.lambda.size),
               take(s.z.size), Span<double>{}};
    increment_ = take(s.v.size);
    position_ = take(s.v.size);
    velocity_ = take(s.v.size);
    rate_ = take(s.z.size);
    internal_ = take(s.z.size);
    before_ = {nullptr,        take(s.q.size), take(s.v.size), take(s.v.size), take(s.lambda.size),
               take(s.z.size), take(s.z.size)};
  }

  /// acceleration() and rate() at the time `dt` after `now`, where the parabola leads.
  void look(double dt, const StateView& now, Span<const double> z_rate, StageSolver& solver) {
    double t = *now.t + dt;
    middle_.t = &t;
    for (std::size_t i = 0; i < now.v.size; ++i) {
      increment_[i] = dt * (now.v[i] + 0.5 * dt * now.a[i]);
      middle_.v[i] = now.v[i] + dt * now.a[i];
    }
    for (std::size_t i = 0; i < now.z.size; ++i) middle_.z[i] = now.z[i] + dt * z_rate[i];
    std::copy(now.a.begin(), now.a.end(), middle_.a.begin());
    std::copy(now.lambda.begin(), now.lambda.end(), middle_.lambda.begin());
    solver.retract(now.q, increment_, middle_.q);
    solver.accelerate(middle_, rate_);
  }
  Span<const double> acceleration() const { return middle_.a; }
  Span<const double> rate() const { return rate_; }

  /// What an attempt overwrites of the state that it starts from.
  struct Start {
    Span<const double> q, v, a, z, z_rate;
  };

  /// Weighted error of the step from `start` by `increment` to `end` with the rate `end_rate` of z, in units of what
  /// the run allows. Takes it off a step that passes.
  double operator()(double dt, const Start& start, Span<const double> increment, StateView& end, Span<double> end_rate,
                    StageSolver& solver) {
    const double error = estimate(dt, start, increment, end, end_rate, solver);
    if (error <= 1.0 && error > 0.0) correct(dt, error, start, increment, end, end_rate, solver);
    return error;
  }

 private:
  double estimate(double dt, const Start& start, Span<const double> increment, const StateView& end,
                  Span<const double> end_rate, StageSolver& solver) {
    const auto& [q, v, a, z, z_rate] = start;
    double t = *end.t - 0.5 * dt;
    middle_.t = &t;
    const Span<double> d_rate = position_;
    solver.increment_rate(increment, end.v, d_rate);
    for (std::size_t i = 0; i < v.size; ++i) {
      increment_[i] = 0.5 * increment[i] + dt / 8.0 * (v[i] - d_rate[i]);
      middle_.v[i] = 0.5 * (v[i] + end.v[i]) + dt / 8.0 * (a[i] - end.a[i]);
      middle_.a[i] = 0.5 * (a[i] + end.a[i]);
    }
    for (std::size_t i = 0; i < z.size; ++i) {
      middle_.z[i] = 0.5 * (z[i] + end.z[i]) + dt / 8.0 * (z_rate[i] - end_rate[i]);
    }
    std::copy(end.lambda.begin(), end.lambda.end(), middle_.lambda.begin());
    solver.retract(q, increment_, middle_.q);
    solver.accelerate(middle_, rate_);
    for (std::size_t i = 0; i < v.size; ++i) {
      velocity_[i] = end.v[i] - v[i] - dt / 6.0 * (a[i] + 4.0 * middle_.a[i] + end.a[i]);
      middle_.v[i] -= 0.5 * velocity_[i];
      middle_.a[i] = end.v[i] - velocity_[i];
    }
    solver.increment_rate(increment_, middle_.v, d_rate);
    solver.increment_rate(increment, middle_.a, middle_.v);
    for (std::size_t i = 0; i < v.size; ++i) {
      position_[i] = increment[i] - dt / 6.0 * (v[i] + 4.0 * d_rate[i] + middle_.v[i]);
    }
    for (std::size_t i = 0; i < z.size; ++i) {
      internal_[i] = end.z[i] - z[i] - dt / 6.0 * (z_rate[i] + 4.0 * rate_[i] + end_rate[i]);
    }
    return std::max(solver.error_norm(position_, velocity_), solver.internal_error_norm(dt, end, internal_));
  }

  void correct(double dt, double error, const Start& start, Span<const double> increment, StateView& end,
               Span<double> end_rate, StageSolver& solver) {
    exchange(end, end_rate, before_, false);
    for (std::size_t i = 0; i < end.v.size; ++i) {
      increment_[i] = increment[i] - position_[i];
      end.v[i] -= velocity_[i];
      position_[i] = 0.0;
    }
    for (std::size_t i = 0; i < end.z.size; ++i) end.z[i] -= internal_[i];
    solver.retract(start.q, increment_, end.q);
    solver.project_position(end);
    solver.project_velocity(end);
    solver.accelerate(end, end_rate);
    for (std::size_t i = 0; i < end.v.size; ++i) velocity_[i] = dt * (end.a[i] - before_.a[i]);
    for (std::size_t i = 0; i < end.z.size; ++i) internal_[i] = dt * (end_rate[i] - before_.memory[i]);
    const bool stiff = !(solver.error_norm(position_, velocity_) <= error) ||
                       !(solver.internal_error_norm(dt, end, internal_) <= error);
    if (stiff) exchange(end, end_rate, before_, true);
  }

  /// Keeps a state and its rates in `kept`, or brings them back.
  static void exchange(StateView& state, Span<double> rate, StateView& kept, bool back) {
    const auto copy = [back](Span<double> now, Span<double> then) {
      back ? std::copy(then.begin(), then.end(), now.begin()) : std::copy(now.begin(), now.end(), then.begin());
    };
    copy(state.q, kept.q), copy(state.v, kept.v), copy(state.a, kept.a), copy(state.lambda, kept.lambda);
    copy(state.z, kept.z), copy(rate, kept.memory);
  }

  StateView middle_{}, before_{};  // the second with the rates of z in place of a memory
  Span<double> increment_, position_, velocity_, rate_, internal_;
};

}  // namespace freeplay
