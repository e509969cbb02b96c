// DenseStep: the motion inside an accepted step.
#pragma once

#include "run/inner_motion.h"
#include "system/state.h"

namespace freeplay {

/// Between two states of one motion: the increment of q since the start by the quintic of its value and two derivatives
/// at both ends, v and a as its derivatives (a of bodies in space straight, as lambda is), z by the cubic of (z, z').
/// Errors of order 6 in q and 5 in v where the ends are exact; constraints hold to that order and not better. h is that
/// of the start: no event lies inside. With what is known of the accelerations inside, the increment is of degree 8, of
/// order 9 in q and 8 in v, and z of order 6.
class DenseStep {
 public:
  DenseStep(Space space, const State& start, std::span<const double> start_rate, const State& end,
            std::span<const double> end_rate, const InnerMotion* inner = nullptr)
      : space_(space),
        start_(start),
        end_(end),
        start_rate_(start_rate),
        end_rate_(end_rate),
        inner_(inner != nullptr && inner->known() ? inner : nullptr) {}

  /// The state at the fraction s of the step; `out` has the layout of both.
  void at(double s, State& out) const;
  /// What the interpolation of the ends misses at the fraction s, where `solved` is the state of at() with its
  /// accelerations by the equations of motion and `rate` its z' (see InnerMotion). Uses no inner motion.
  void missing(double s, const State& solved, std::span<const double> rate, std::span<double> bends,
               std::span<double> rates) const;

 private:
  void bodies_in_space(double s, State& out) const;

  Space space_;
  const State& start_;
  const State& end_;
  std::span<const double> start_rate_, end_rate_;  ///< z' of the joints' internal variables
  const InnerMotion* inner_;
};

}  // namespace freeplay
