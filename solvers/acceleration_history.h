// AccelerationHistory: guesses the accelerations of the stages to come from those of the steps before.
#pragma once

#include <algorithm>
#include <cmath>

#include "freeplay/integrator.h"

namespace freeplay {

/// Numbers in an integrator's memory. A stage at t_n + c h starts its iteration at
///
///   a_n + c (a_n - a_n-1) + c (c + 1)/2 (a_n - 2 a_n-1 + a_n-2) + d
///
/// with d what the same guess was off in the step before: the error falls with h^4 where the motion is smooth, so that
/// one iteration does. Steps of one length only; after another length, or an event, it begins anew. A guess changes
/// what a stage costs, not what it solves.
class AccelerationHistory {
 public:
  static int size(const Sizes& n, int stages) { return 2 + (2 + stages) * n.nv; }
  static void forget(Span<double> memory) { std::fill(memory.begin(), memory.end(), 0.0); }

  /// At the start of a step of length dt; `a` are its accelerations, which stay where they are.
  AccelerationHistory(double dt, Span<const double> a, Span<double> memory)
      : a_(a),
        steps_(memory[0]),
        previous_(memory.part(2, a.size)),
        older_(memory.part(2 + a.size, a.size)),
        off_(memory.part(2 + 2 * a.size, memory.size - 2 - 2 * a.size)) {
    if (!(std::abs(dt - memory[1]) <= 1e-6 * dt)) steps_ = 0.0;
    memory[1] = dt;
    known_ = static_cast<int>(std::min(steps_, 2.0));
  }

  /// The guess for a stage.
  void guess(int stage, double c, Span<double> out) {
    const Span<double> off = of_stage(stage);
    const double linear = known_ > 0 ? c : 0.0, square = known_ > 1 ? 0.5 * c * (c + 1.0) : 0.0;
    const bool corrects = steps_ > 2.0;  // what was off, was so with three points
    for (std::size_t i = 0; i < a_.size; ++i) {
      const double base = a_[i] + linear * (a_[i] - previous_[i]) + square * (a_[i] - 2.0 * previous_[i] + older_[i]);
      out[i] = base + (corrects ? off[i] : 0.0);
      off[i] = base;
    }
  }
  /// What it came out as.
  void solved(int stage, Span<const double> a) {
    const Span<double> off = of_stage(stage);
    for (std::size_t i = 0; i < a.size; ++i) off[i] = a[i] - off[i];
  }
  /// After the last stage.
  void finish(Span<double> memory) {
    memory[0] = std::min(steps_ + 1.0, 3.0);
    std::copy(previous_.begin(), previous_.end(), older_.begin());
    std::copy(a_.begin(), a_.end(), previous_.begin());
  }

 private:
  Span<double> of_stage(int stage) const { return off_.part(static_cast<std::size_t>(stage) * a_.size, a_.size); }

  Span<const double> a_;
  double steps_;
  int known_ = 0;
  Span<double> previous_, older_, off_;
};

}  // namespace freeplay
