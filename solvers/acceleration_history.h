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
/// with d what the same sum was off in the step before: the error falls with h^4 where the motion is smooth, so that
/// one iteration does. Where the sum was no better than a_n, as behind an impact, and in steps of another length than
/// those before, it is not used. A guess changes what a stage costs, not what it solves.
class AccelerationHistory {
 public:
  static int size(const Sizes& n, int stages) { return 2 + stages + (2 + stages) * n.nv; }
  static void forget(Span<double> memory) { std::fill(memory.begin(), memory.end(), 0.0); }

  /// At the start of a step of length dt; `a` are its accelerations, which stay where they are.
  AccelerationHistory(double dt, int stages, Span<const double> a, Span<double> memory)
      : a_(a), steps_(memory[0]), count_(memory.data[0]) {
    std::size_t used = 2;
    const auto take = [&](std::size_t size) {
      used += size;
      return memory.part(used - size, size);
    };
    good_ = take(static_cast<std::size_t>(stages));
    previous_ = take(a.size);
    older_ = take(a.size);
    off_ = take(static_cast<std::size_t>(stages) * a.size);
    if (!(std::abs(dt - memory[1]) <= 1e-6 * dt)) {
      steps_ = 0.0;
      std::fill(good_.begin(), good_.end(), 0.0);
    }
    memory[1] = dt;
  }

  /// The guess for a stage; `out` is left as it is where there is none.
  void guess(int stage, double c, Span<double> out) {
    const Span<double> off = of_stage(stage);
    const double linear = steps_ > 0.0 ? c : 0.0, square = steps_ > 1.0 ? 0.5 * c * (c + 1.0) : 0.0;
    const bool good = good_[static_cast<std::size_t>(stage)] > 0.0;
    for (std::size_t i = 0; i < a_.size; ++i) {
      const double sum = a_[i] + linear * (a_[i] - previous_[i]) + square * (a_[i] - 2.0 * previous_[i] + older_[i]);
      if (good) out[i] = sum + off[i];
      off[i] = sum;
    }
  }
  /// What it came out as.
  void solved(int stage, Span<const double> a) {
    const Span<double> off = of_stage(stage);
    double missed = 0.0, moved = 0.0;
    for (std::size_t i = 0; i < a.size; ++i) {
      off[i] = a[i] - off[i];
      missed = std::max(missed, std::abs(off[i]));
      moved = std::max(moved, std::abs(a[i] - a_[i]));
    }
    good_[static_cast<std::size_t>(stage)] = steps_ > 1.0 && missed <= 0.5 * moved ? 1.0 : 0.0;
  }
  /// After the last stage.
  void finish() {
    count_ = std::min(steps_ + 1.0, 2.0);
    std::copy(previous_.begin(), previous_.end(), older_.begin());
    std::copy(a_.begin(), a_.end(), previous_.begin());
  }

 private:
  Span<double> of_stage(int stage) const { return off_.part(static_cast<std::size_t>(stage) * a_.size, a_.size); }

  Span<const double> a_;
  double steps_;
  double& count_;
  Span<double> good_, previous_, older_, off_;
};

}  // namespace freeplay
