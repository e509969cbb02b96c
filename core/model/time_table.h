// TimeTable: a function of time through given points.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "base/expression.h"

namespace freeplay {

enum class Interpolation { cubic, linear };
/// Ends of a cubic spline: second derivative zero, first derivative zero, or both equal at both ends.
enum class SplineEnds { natural, clamped, periodic };
/// Before the first and after the last time: the end value at rest, the period again, or no value.
enum class Outside { hold, repeat, error };

/// What a table was read from, as written.
struct TableSource {
  std::string file;             ///< path; empty: points in the model file
  std::string time, value;      ///< names of columns; empty: the first and the second
  std::string time_unit, unit;  ///< of the columns; empty: SI
  Interpolation interpolation = Interpolation::cubic;
  SplineEnds ends = SplineEnds::natural;
  Outside outside = Outside::hold;
};

/// Cubic spline (C2) or straight lines through (times, values). On a piece of length h from (t0, y0) to (t1, y1), with
/// a = (t1 - t)/h, b = (t - t0)/h and second derivatives M0, M1 at its ends,
///
///   y = a y0 + b y1 + ((a^3 - a) M0 + (b^3 - b) M1) h^2/6
///
/// whose derivatives and integral are exact. Straight lines are M = 0. At a point the piece on its right counts.
class TimeTable {
 public:
  /// At least 2 points (periodic: 3, and equal values at the ends), times strictly increasing.
  TimeTable(std::vector<double> times, std::vector<double> values, Interpolation interpolation, SplineEnds ends,
            Outside outside);

  /// Value and exact derivatives. False, with "bad-table", where there is none.
  bool evaluate(double t, Jet& out, EvaluationFailure& failure) const noexcept;
  /// The first time after t at which the slope jumps; infinite when there is none. That of a repeated
  /// table may be given twice, with different rounding.
  double next_kink(double t) const noexcept { return next_place(t, straight_); }
  /// The first of its points after t, those of every period and the ends included; infinite when there is none.
  double next_point(double t) const noexcept { return next_place(t, true); }
  /// Straight lines between its points.
  bool is_straight() const { return straight_; }

  std::span<const double> times() const { return times_; }
  std::span<const double> values() const { return values_; }

  /// Integral from the first time to t.
  bool integral(double t, double& out, EvaluationFailure& failure) const noexcept;

 private:
  /// Where t falls: seconds before or after the table, or inside after `periods` whole ones.
  struct Place {
    double t = 0.0, beyond = 0.0, periods = 0.0;
  };
  bool locate(double t, Place& place, EvaluationFailure& failure) const noexcept;
  double next_place(double t, bool inner) const noexcept;
  double end_rounding() const noexcept;
  std::size_t piece(double t) const noexcept;
  double integral_within(double t) const noexcept;
  void solve_open(SplineEnds ends);
  void solve_periodic();
  double slope(std::size_t i) const { return (values_[i + 1] - values_[i]) / (times_[i + 1] - times_[i]); }

  std::vector<double> times_, values_, second_;
  std::vector<double> areas_;  ///< integral up to each point
  Outside outside_;
  bool straight_;
};

}  // namespace freeplay
