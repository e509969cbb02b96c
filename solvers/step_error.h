// StepError: local error of any one-step method of order 2, from one more evaluation in the middle of the step.
#pragma once

#include <algorithm>

#include "freeplay/integrator.h"

namespace freeplay {

/// Compares the end of a step with Simpson's rule on the accelerations at its start, middle and end (n, m, 1; step h):
///
///   e_v = v_1 - v_n - h/6 (a_n + 4 a_m + a_1)          e_d = d_1 - h v_n - h^2/6 (a_n + 2 a_m)
///
/// with the increment d_1 of the position; internal variables z and their rates are judged like v and a. The middle is
/// the cubic through (d, v) and (v, a) at both ends, which errs by h^4 more than the ends do (likewise z, z'), and a_m
/// solves the equations of motion there. All three accelerations satisfy the constraints, so that no error of a stage's
/// multiplier is in e. e tends to the local error where that is of order h^3: the difference of the two is of order
/// h^4.
class StepError {
 public:
  static std::int32_t scratch(const Sizes& n) { return n.nq + 5 * n.nv + n.nc + 3 * n.nz; }

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
  /// the run allows.
  double operator()(double dt, const Start& start, Span<const double> increment, const StateView& end,
                    Span<const double> end_rate, StageSolver& solver) {
    const auto& [q, v, a, z, z_rate] = start;
    double t = *end.t - 0.5 * dt;
    middle_.t = &t;
    for (std::size_t i = 0; i < v.size; ++i) {
      increment_[i] = 0.5 * increment[i] + dt / 8.0 * (v[i] - end.v[i]);
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
      position_[i] = increment[i] - dt * (v[i] + dt / 6.0 * (a[i] + 2.0 * middle_.a[i]));
    }
    for (std::size_t i = 0; i < z.size; ++i) {
      internal_[i] = end.z[i] - z[i] - dt / 6.0 * (z_rate[i] + 4.0 * rate_[i] + end_rate[i]);
    }
    return std::max(solver.error_norm(position_, velocity_), solver.internal_error_norm(dt, end, internal_));
  }

 private:
  StateView middle_{};
  Span<double> increment_, position_, velocity_, rate_, internal_;
};

}  // namespace freeplay
