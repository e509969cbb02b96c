// A curve of a marker that a formula gives, and what joints say of it in the model file.
#pragma once

#include "freeplay/plugin.h"

namespace freeplay::curves {

/// A height over x of the marker, or a distance from its origin over the angle.
enum class CurveForm { cartesian, polar };

/// Value, slope and bend of a curve. The bend is the difference of exact slopes at three places on either side, to
/// sixth order: exact for polynomials up to the seventh degree.
class Curve {
 public:
  Curve(const Formula& formula, CurveForm form) : formula_(formula), step_(form == CurveForm::polar ? 1e-3 : 1e-4) {}

  struct At {
    double value, slope, bend;
  };
  At at(double x) const {
    At out{};
    out.value = value_at(x, out.slope);
    constexpr double weights[] = {45.0, -9.0, 1.0};
    for (int k = 1; k <= 3; ++k) {
      double above = 0.0, below = 0.0;
      value_at(x + k * step_, above);
      value_at(x - k * step_, below);
      out.bend += weights[k - 1] * (above - below) / (60.0 * step_);
    }
    return out;
  }

 private:
  double value_at(double x, double& slope) const {
    const double variables[] = {x};
    double slopes[1] = {};
    const double value = formula_.at(variables, slopes);
    slope = slopes[0];
    return value;
  }

  Formula formula_;
  double step_;  // of differences of slopes [rad or m]
};

inline constexpr Parameter curve_rows[] = {
    {.name = "form",
     .kind = ParameterKind::choice,
     .default_value = 0,
     .choices = "cartesian|polar",
     .summary = "The curve gives y over x of the first frame, or the distance from its origin over the angle."},
    {.name = "curve",
     .kind = ParameterKind::formula,
     .unit = "m",
     .summary = "Height at x, or distance at the angle x from 0 to one turn; points as well.",
     .variables = "x: form: m | rad"}};

}  // namespace freeplay::curves
