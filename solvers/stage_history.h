// StageHistory: predictor of the accelerations and multipliers of the stages to come, from those of the steps before.
#pragma once

#include <algorithm>
#include <cmath>

#include "freeplay/integrator.h"

namespace freeplay {

/// Numbers in an integrator's memory. A stage at t_n + c h starts its iteration, of x = (a, lambda), at
///
///   x_n + c (x_n - x_n-1) + c (c + 1)/2 (x_n - 2 x_n-1 + x_n-2) + d
///
/// with d the error of the same sum in the step before: the error falls with h^4 where the motion is smooth, so that
/// one iteration does. Where this predictor would have been no better than a_n, as after an impact, and in steps of
/// another length than those before, it is not used. The result of a stage that is solved does not depend on it.
///
/// While the predictor error stays well below the tolerance of the iteration, both stages of a step may be left as they
/// were predicted, for as many steps as this error, growing by itself in each, stays small, and no more than
/// `most_unsolved`. The accelerations that are solved for at the end of such a step judge it: where they differ from
/// the predicted ones by more than an iteration may leave, the step is made again with its stages solved. Where that
/// happens again and again, more and more steps come before the next try, of which the first stage alone is left as
/// predicted: the error at the end of the step judges both.
class StageHistory {
 public:
  static int size(const Sizes& n, int stages) { return scalars + stages + (3 + 2 * stages) * (n.nv + n.nc) + n.nv; }
  static void forget(Span<double> memory) { std::fill(memory.begin(), memory.end(), 0.0); }

  /// At the start of a step of length dt; `a` and `lambda` are those there, and stay where they are.
  StageHistory(double dt, int stages, Span<const double> a, Span<const double> lambda, Span<double> memory,
               double most_unsolved = 0.0)
      : a_(a),
        lambda_(lambda),
        most_unsolved_(most_unsolved),
        steps_(memory[0]),
        count_(memory.data[0]),
        unsolved_(memory.data[2]),
        last_(memory.data[3]),
        pause_(memory.data[4]),
        next_pause_(memory.data[5]) {
    std::size_t used = scalars;
    const auto take = [&](std::size_t size) {
      used += size;
      return memory.part(used - size, size);
    };
    good_ = take(static_cast<std::size_t>(stages));
    int place = static_cast<int>(last_);
    for (int i = 0; i < 3; ++i, place = place == 2 ? 0 : place + 1) past_[place] = take(count());
    off_ = take(static_cast<std::size_t>(stages) * count());
    predicted_ = take(static_cast<std::size_t>(stages) * count());
    beside_ = take(a.size);
    if (!(std::abs(dt - memory[1]) <= 1e-6 * dt)) {
      steps_ = unsolved_ = 0.0;
      std::fill(good_.begin(), good_.end(), 0.0);
    }
    memory[1] = dt;
  }

  /// Writes the predictor of a stage into `to`, or nothing where there is none. Not inlined: a step of few bodies takes
  /// more time to fetch its instructions than to execute them.
  [[gnu::noinline]] void predict(int stage, double c, StateView& to) {
    const Weights w = weights(c);
    const bool good = good_[static_cast<std::size_t>(stage)] > 0.0;
    const auto extrapolate = [&](Span<const double> now, std::size_t first, Span<double> out) {
      const Span<double> previous = past_[0].part(first, now.size), older = past_[1].part(first, now.size),
                         oldest = past_[2].part(first, now.size), off = of_stage(stage, off_).part(first, now.size),
                         predicted = of_stage(stage, predicted_).part(first, now.size);
      for (std::size_t i = 0; i < now.size; ++i) {
        predicted[i] = w.now * now[i] + w.previous * previous[i] + w.older * older[i] - w.oldest * oldest[i] + off[i];
        if (good) out[i] = predicted[i];
      }
    };
    extrapolate(a_, 0, to.a);
    extrapolate(lambda_, a_.size, to.lambda);
  }
  /// What it came out as, `error` (StageSolver::guess_error) off the predictor; the last one is that at the end of the
  /// step.
  [[gnu::noinline]] void solved(int stage, const StateView& to, double error) {
    const Span<double> off = of_stage(stage, off_), predicted = of_stage(stage, predicted_);
    double missed = 0.0, moved = 0.0;
    for (std::size_t i = 0; i < a_.size; ++i) {
      const double miss = to.a[i] - predicted[i];
      missed = std::max(missed, std::abs(miss));
      moved = std::max(moved, std::abs(to.a[i] - a_[i]));
      off[i] += miss;
      beside_[i] = to.a[i];
    }
    for (std::size_t r = 0; r < lambda_.size; ++r) off[a_.size + r] += to.lambda[r] - predicted[a_.size + r];
    const bool good = steps_ > 1.0 && (!is_surprise(error) || missed <= 0.5 * moved);
    good_[static_cast<std::size_t>(stage)] = good ? 1.0 : 0.0;
    const double steps = good ? steps_of(error) : 0.0;
    unsolved_ = stage == 0 ? steps : std::min(steps, unsolved_);
  }
  /// After a step whose stages were solved; `to` has the accelerations at its end.
  void finish(const StateView& to) {
    for (std::size_t i = 0; i < a_.size; ++i) beside_[i] -= to.a[i];
    pause_ = std::max(0.0, pause_ - 1.0);
    keep_start();
  }

  /// Whether the stages of a step may be left as predicted: both, or the first alone. Counts.
  bool leaves_unsolved() {
    if (!(unsolved_ > 0.0)) return false;
    unsolved_ -= 1.0;
    return true;
  }
  bool leaves_first_alone() const { return pause_ > 0.0; }
  /// Whether the error of a prediction (StageSolver::guess_error, unsolved_error) exceeds the tolerance of an
  /// iteration.
  static bool is_surprise(double error) { return !(error <= 1.0); }
  /// Predicted accelerations of both stages: calls use(i, first, end) for every i.
  template <class Use>
  void predict_both(double c_first, double c_end, Use&& use) {
    const Weights first = weights(c_first), end = weights(c_end);
    const Span<const double> now = a_;
    const Span<double> previous = past_[0], older = past_[1], oldest = past_[2], off_first = of_stage(0, off_),
                       off_end = of_stage(1, off_), predicted = of_stage(1, predicted_);
    for (std::size_t i = 0; i < now.size; ++i) {
      const double x = now[i], x1 = previous[i], x2 = older[i], x3 = oldest[i];
      const double at_first = first.now * x + first.previous * x1 + first.older * x2 - first.oldest * x3 + off_first[i],
                   at_end = end.now * x + end.previous * x1 + end.older * x2 - end.oldest * x3 + off_end[i];
      predicted[i] = at_end;
      use(i, at_first, at_end);
    }
  }
  /// By how much the accelerations at the end of such a step, in `to`, differ from the predicted ones.
  void miss(const StateView& to, Span<double> missed) const {
    const Span<double> predicted = of_stage(1, predicted_);
    for (std::size_t i = 0; i < a_.size; ++i) missed[i] = to.a[i] + beside_[i] - predicted[i];
  }
  /// Whether it stands, with such an error (StageSolver::unsolved_error). If so, it is over.
  bool stands(double error) {
    if (is_surprise(error)) {
      unsolved_ = 0.0;
      pause_ = next_pause_;
      next_pause_ = std::min(2.0 * next_pause_ + 1.0, longest_pause);
      return false;
    }
    unsolved_ = std::min(unsolved_, steps_of(error));
    next_pause_ = std::max(0.0, next_pause_ - worth);
    keep_start();
    return true;
  }

 private:
  static constexpr int scalars = 6;
  /// Of the tolerance of the iteration, up to which the error of stages left as predicted may grow: the other half is
  /// for that of the end of the step, which judges them.
  static constexpr double small_part = 0.5;
  /// Most steps before the next try, of a pause that each try that fails doubles: of a thousand steps one is made twice
  /// where no try ever stands.
  static constexpr double longest_pause = 1023.0;
  /// Steps that one which stands takes off the next pause: four pay for one that was made twice.
  static constexpr double worth = 0.25;

  struct Weights {
    double now, previous, older, oldest;
  };
  Weights weights(double c) const {
    const double linear = steps_ > 0.0 ? c : 0.0, square = steps_ > 1.0 ? 0.5 * c * (c + 1.0) : 0.0,
                 cube = steps_ > 2.0 ? c * (c + 1.0) * (c + 2.0) / 6.0 : 0.0;
    return {1.0 + linear + square + cube, -linear - 2.0 * square - 3.0 * cube, square + 3.0 * cube, cube};
  }
  /// Steps over which an error that grows by itself in each stays a small part of what a stage may leave.
  double steps_of(double error) const {
    return error * most_unsolved_ <= small_part ? most_unsolved_ : std::floor(small_part / error);
  }
  void keep_start() {
    count_ = std::min(steps_ + 1.0, 3.0);
    last_ = last_ < 2.0 ? last_ + 1.0 : 0.0;
    std::copy_n(a_.data, a_.size, past_[2].data);
    std::copy_n(lambda_.data, lambda_.size, past_[2].data + a_.size);
  }

  std::size_t count() const { return a_.size + lambda_.size; }
  Span<double> of_stage(int stage, Span<double> all) const {
    return all.part(static_cast<std::size_t>(stage) * count(), count());
  }

  Span<const double> a_, lambda_;
  double most_unsolved_;
  double steps_;
  double &count_, &unsolved_;    // unsolved_: steps to come whose stages may be left as predicted
  double& last_;                 // how far the places of past_ have turned
  double &pause_, &next_pause_;  // steps until both stages may be left, and after the next surprise
  Span<double> past_[3];         // (a, lambda) at the starts of the steps before, the last one first
  Span<double> good_, off_, predicted_;
  Span<double> beside_;  // a of the last stage less that at the end of the step, where it was solved last
};

}  // namespace freeplay
