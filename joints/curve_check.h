// What a curve must be for a point to stay on it: in one piece, without corners and, around an origin, closed.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include "curve.h"

namespace freeplay::curves {

/// Looks at a curve once, before anything moves. Throws BadParameter "bad-curve" with the place on the curve and a
/// remedy. Around an origin it looks at one turn, else at 10 m to both sides, as far as the formula has a value.
class CurveCheck {
 public:
  CurveCheck(const Formula& formula, CurveForm form)
      : formula_(formula), polar_(form == CurveForm::polar), switches_(static_cast<std::size_t>(formula.switches())) {}

  void run() {
    if (polar_) {
      look_around();
      judge_seam();
    }
    if (switches_ > 0) judge_switches();
  }

 private:
  static constexpr double turn = 2.0 * std::numbers::pi;
  static constexpr int places_of_turn = 4096, places_of_decade = 300, decades = 6;
  static constexpr double farthest = 10.0;   // over x [m]
  static constexpr double beside = 1e-9;     // of a place, where a side is looked at [rad or m]
  static constexpr double most_gap = 1e-8;   // of the size of the curve: arcs that touch do so up to rounding
  static constexpr double most_turn = 1e-4;  // of its direction at one place [rad]

  /// A curve on one side of a place: its height or distance there, and its slope.
  struct Side {
    double value = 0.0, slope = 0.0;
  };
  double value_at(double x) const { return formula_.at(Span<const double>(&x, 1)); }
  /// The side of `x` on which `from` is, continued to x.
  Side side(double x, double from) const {
    Side out;
    double slope[1] = {};
    out.value = formula_.at(Span<const double>(&from, 1), slope);
    out.slope = slope[0];
    out.value += out.slope * (x - from);
    return out;
  }

  void look_around() {
    for (int i = 0; i < places_of_turn; ++i) {
      const double x = turn * i / places_of_turn, r = value_at(x);
      size_ = std::max(size_, std::abs(r));
      if (r > 0.0) continue;
      refuse("the curve runs through its origin and crosses itself there: its distance from the origin is " +
             metres(r) + " at " + place(x) + "; it must be above 0 all the way round");
    }
  }

  void judge_seam() const {
    const Side begin = side(0.0, beside), end = side(turn, turn - beside);
    const double gap = std::abs(end.value - begin.value);
    if (gap > most_gap * size_) {
      refuse("the curve is not closed: it begins " + metres(begin.value) + " from its origin and ends " +
             metres(end.value) + " from it after one turn (x = 2 pi), " + metres(gap) +
             " apart; write it so that it comes back, as by sin, cos and smooth() of angles in rad or with their unit, "
             "or give points with 'ends: periodic'");
    }
    const double bend = corner(begin, end);
    if (bend > most_turn) {
      refuse("the curve has a corner of " + degrees(bend) +
             " where it closes, at the angle 0; let its slope after one turn be what it was at the beginning (points: "
             "'ends: periodic')");
    }
  }

  /// Where the formula changes its form.
  void judge_switches() const {
    std::vector<double> last(switches_), next(switches_);
    double from = 0.0;
    bool known = false;
    for (const double x : places()) {
      if (!has_value(x)) {
        known = false;
        continue;
      }
      decide(x, next);
      for (std::size_t i = 0; known && i < switches_; ++i) {
        if ((last[i] >= 0.0) != (next[i] >= 0.0)) judge_place(crossing(i, from, x, last[i] >= 0.0));
      }
      last.swap(next);
      from = x;
      known = true;
    }
  }

  std::vector<double> places() const {
    std::vector<double> all;
    if (polar_) {
      for (int i = 0; i <= places_of_turn; ++i) all.push_back(turn * i / places_of_turn);
      return all;
    }
    const int count = places_of_decade * decades;
    for (int i = -count; i <= count; ++i) {
      if (i == 0) continue;
      const double exponent = static_cast<double>(std::abs(i) - count) / places_of_decade;
      all.push_back(std::copysign(farthest * std::pow(10.0, exponent), i));
    }
    return all;
  }
  bool has_value(double x) const {
    if (polar_) return true;
    try {
      value_at(x);
    } catch (const std::exception&) {
      return false;
    }
    return true;
  }
  void decide(double x, std::vector<double>& g) const {
    formula_.decide(Span<const double>(&x, 1), {g.data(), g.size()});
  }
  double crossing(std::size_t which, double low, double high, bool positive_at_low) const {
    std::vector<double> g(switches_);
    while (high - low > 1e-15 * std::max(1.0, std::abs(high))) {
      const double middle = 0.5 * (low + high);
      if (middle <= low || middle >= high) break;
      decide(middle, g);
      ((g[which] >= 0.0) == positive_at_low ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }

  void judge_place(double x) const {
    if (!has_value(x - beside) || !has_value(x + beside)) return;
    const Side before = side(x, x - beside), after = side(x, x + beside);
    const double gap = std::abs(after.value - before.value), size = std::max(size_, std::abs(before.value));
    const double bend = corner(before, after);
    if (gap > most_gap * std::max(size, polar_ ? 0.0 : 1e-3) && gap > 4.0 * beside * std::abs(after.slope)) {
      refuse("the curve jumps at " + place(x) + ", from " + metres(before.value) + " to " + metres(after.value));
    }
    if (bend > most_turn) {
      refuse("the curve has a corner of " + degrees(bend) + " at " + place(x) +
             ", which no point passes without a blow: round it, as by smooth() or by 'arcs' (points: 'interpolation: "
             "cubic')");
    }
  }

  /// By how much the direction differs between two sides of a place [rad].
  double corner(const Side& a, const Side& b) const {
    const auto direction = [&](const Side& s) { return polar_ ? std::atan2(s.slope, s.value) : std::atan(s.slope); };
    return std::abs(direction(a) - direction(b));
  }

  std::string place(double x) const {
    char text[64];
    if (std::abs(x) < 1e-12) x = 0.0;
    if (polar_) {
      std::snprintf(text, sizeof text, "x = %.6g rad (%.5g deg)", x, x * 360.0 / turn);
    } else {
      std::snprintf(text, sizeof text, "x = %.6g m", x);
    }
    return text;
  }
  static std::string metres(double value) {
    char text[64];
    std::snprintf(text, sizeof text, "%.6g m", value);
    return text;
  }
  static std::string degrees(double angle) {
    char text[64];
    std::snprintf(text, sizeof text, "%.3g deg", angle * 360.0 / turn);
    return text;
  }
  [[noreturn]] static void refuse(const std::string& text) { throw BadParameter("curve", "bad-curve", text); }

  const Formula& formula_;
  bool polar_;
  std::size_t switches_;
  double size_ = 0.0;  ///< largest distance from the origin, 0 over x [m]
};

/// A curve that a point may follow: throws where it is none.
inline Curve checked_curve(const Formula& formula, CurveForm form) {
  CurveCheck(formula, form).run();
  return Curve(formula, form);
}

}  // namespace freeplay::curves
