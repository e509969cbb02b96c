// A curve of a marker that a formula gives, and what joints say of it in the model file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "freeplay/plugin.h"

namespace freeplay::curves {

/// A height over x of the marker, or a distance from its origin over the angle.
enum class CurveForm { cartesian, polar };

/// Value, slope and bend of a curve. The bend is the difference of exact slopes at equal distances, short ones, to
/// sixth order: exact for polynomials up to the seventh degree. Where the formula changes its form on one side, as from
/// an arc to a line, they stand on the other.
class Curve {
 public:
  Curve(const Formula& formula, CurveForm form)
      : formula_(formula), step_(form == CurveForm::polar ? 1e-5 : 1e-6), switches_(formula.switches()) {}

  struct Line {
    double value, slope;
  };
  struct At {
    double value, slope, bend;
  };
  At at(double x) const {
    const Line line = line_at(x);
    return {line.value, line.slope, bend_at(x)};
  }
  Line line_at(double x) const {
    const double variables[] = {x};
    double slopes[1] = {};
    const double value = formula_.at(variables, slopes);
    return {value, slopes[0]};
  }
  /// Takes six values of the formula, a line one.
  double bend_at(double x) const {
    double bend = 0.0;
    const double near = step_ * static_cast<double>(between.size()), far = 2.0 * near;
    const bool back = one_form(x, x - far), ahead = one_form(x, x + far);
    if (back == ahead || one_form(x - near, x + near)) {
      for (std::size_t k = 0; k < between.size(); ++k) {
        const double by = step_ * static_cast<double>(k + 1);
        bend += between[k] * (slope_at(x + by) - slope_at(x - by)) / (60.0 * step_);
      }
      return bend;
    }
    const double sense = ahead ? 1.0 : -1.0;
    for (std::size_t k = 0; k < beside.size(); ++k) {
      bend += sense * beside[k] * slope_at(x + sense * step_ * static_cast<double>(k)) / (60.0 * step_);
    }
    return bend;
  }

  /// How many numbers decide() fills: each passes zero where the formula changes its form.
  std::int32_t switches() const { return switches_; }
  void decide(double x, Span<double> g) const {
    const double variables[] = {x};
    formula_.decide(variables, g);
  }

 private:
  static constexpr std::array<double, 3> between{45.0, -9.0, 1.0};                                   // of 60
  static constexpr std::array<double, 7> beside{-147.0, 360.0, -450.0, 400.0, -225.0, 72.0, -10.0};  // of 60
  static constexpr std::int32_t most_switches = 64;

  double slope_at(double x) const { return line_at(x).slope; }
  /// Of more switches than usual nothing is known.
  bool one_form(double x, double y) const {
    if (switches_ <= 0 || switches_ > most_switches) return true;
    std::array<double, most_switches> g{}, h{};
    const auto count = static_cast<std::size_t>(switches_);
    decide(x, {g.data(), count});
    decide(y, {h.data(), count});
    for (std::size_t i = 0; i < count; ++i) {
      if ((g[i] >= 0.0) != (h[i] >= 0.0)) return false;
    }
    return true;
  }

  Formula formula_;
  double step_;  // of differences of slopes [rad or m]
  std::int32_t switches_;
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
     .summary = "Height at x, or distance at the angle x from 0 to one turn; points or arcs as well.",
     .variables = "x: form: m | rad"}};

}  // namespace freeplay::curves
