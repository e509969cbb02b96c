// Antiderivative: the integral of an expression over time, for drivers that prescribe a speed.
#pragma once

#include <vector>

#include "base/error.h"
#include "base/expression.h"

namespace freeplay {

/// F(t) = integral of f from `start` to t, to about 1e-14 of the largest panel. The interval is cut once, at the
/// corners of f and in between into panels on which one Gauss rule is exact to rounding; F depends on t alone, never on
/// earlier calls.
class Antiderivative {
 public:
  Antiderivative() = default;
  /// `integrand` must live as long as this. Throws Error{input} "bad-expression" where f has no value.
  Antiderivative(const Expression& integrand, double start, double end, const Location& location);

  /// False, with `failure`, where the integrand has no value.
  bool evaluate(double t, double& integral, EvaluationFailure& failure) const noexcept;

 private:
  struct Panel {
    double start, integral;  ///< integral up to its start
  };
  bool gauss(double from, double to, double& sum, EvaluationFailure& failure) const noexcept;
  void cut(double from, double to, double whole, int cuts, const Location& location, int depth = 0,
           double before = 0.0);

  const Expression* integrand_ = nullptr;
  double start_ = 0.0, total_ = 0.0;
  std::vector<Panel> panels_;
};

}  // namespace freeplay
