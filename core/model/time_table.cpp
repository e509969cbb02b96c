#include "model/time_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace freeplay {
namespace {

/// Tridiagonal system with rows (lower, diagonal, upper), in place (Thomas); diagonally dominant, so without pivoting.
void solve_tridiagonal(const std::vector<double>& lower, std::vector<double> diagonal, const std::vector<double>& upper,
                       std::vector<double>& right) {
  const std::size_t n = diagonal.size();
  for (std::size_t i = 1; i < n; ++i) {
    const double factor = lower[i] / diagonal[i - 1];
    diagonal[i] -= factor * upper[i - 1];
    right[i] -= factor * right[i - 1];
  }
  right[n - 1] /= diagonal[n - 1];
  for (std::size_t i = n - 1; i-- > 0;) right[i] = (right[i] - upper[i] * right[i + 1]) / diagonal[i];
}

}  // namespace

TimeTable::TimeTable(std::vector<double> times, std::vector<double> values, Interpolation interpolation,
                     SplineEnds ends, Outside outside)
    : times_(std::move(times)),
      values_(std::move(values)),
      second_(times_.size(), 0.0),
      outside_(outside),
      straight_(interpolation == Interpolation::linear) {
  if (interpolation == Interpolation::cubic && ends == SplineEnds::periodic) {
    values_.back() = values_.front();
    solve_periodic();
  } else if (interpolation == Interpolation::cubic) {
    solve_open(ends);
  }
  areas_.assign(times_.size(), 0.0);
  for (std::size_t i = 0; i + 1 < times_.size(); ++i) {
    const double h = times_[i + 1] - times_[i];
    areas_[i + 1] =
        areas_[i] + 0.5 * h * (values_[i] + values_[i + 1]) - h * h * h / 24.0 * (second_[i] + second_[i + 1]);
  }
}

// Continuity of the first derivative at point i, with h the pieces' lengths and d their slopes:
//   h[i-1] M[i-1] + 2 (h[i-1] + h[i]) M[i] + h[i] M[i+1] = 6 (d[i] - d[i-1])
void TimeTable::solve_open(SplineEnds ends) {
  const std::size_t n = times_.size();
  std::vector<double> lower(n, 0.0), diagonal(n, 1.0), upper(n, 0.0), right(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    lower[i] = times_[i] - times_[i - 1];
    upper[i] = times_[i + 1] - times_[i];
    diagonal[i] = 2.0 * (lower[i] + upper[i]);
    right[i] = 6.0 * (slope(i) - slope(i - 1));
  }
  if (ends == SplineEnds::clamped) {
    diagonal[0] = 2.0;
    upper[0] = 1.0;
    right[0] = 6.0 * slope(0) / (times_[1] - times_[0]);
    diagonal[n - 1] = 2.0;
    lower[n - 1] = 1.0;
    right[n - 1] = -6.0 * slope(n - 2) / (times_[n - 1] - times_[n - 2]);
  }
  solve_tridiagonal(lower, diagonal, upper, right);
  second_ = right;
}

// The same with point n - 1 being point 0 again: a cyclic system, solved by Sherman and Morrison's formula.
void TimeTable::solve_periodic() {
  const std::size_t n = times_.size() - 1;
  const auto length = [&](std::size_t i) { return times_[i % n + 1] - times_[i % n]; };
  std::vector<double> lower(n), diagonal(n), upper(n), right(n);
  for (std::size_t i = 0; i < n; ++i) {
    lower[i] = length(i + n - 1);
    upper[i] = length(i);
    diagonal[i] = 2.0 * (lower[i] + upper[i]);
    right[i] = 6.0 * (slope(i) - slope((i + n - 1) % n));
  }
  if (n == 2) {
    // Both neighbours of a point are the same one.
    const double between = lower[0] + upper[0], determinant = diagonal[0] * diagonal[1] - between * between;
    second_ = {(right[0] * diagonal[1] - between * right[1]) / determinant,
               (diagonal[0] * right[1] - between * right[0]) / determinant, 0.0};
  } else {
    const double corner = lower[0], gamma = -diagonal[0];
    diagonal[0] -= gamma;
    diagonal[n - 1] -= corner * corner / gamma;
    std::vector<double> update(n, 0.0);
    update[0] = gamma;
    update[n - 1] = corner;
    solve_tridiagonal(lower, diagonal, upper, right);
    solve_tridiagonal(lower, diagonal, upper, update);
    const double factor =
        (right[0] + corner / gamma * right[n - 1]) / (1.0 + update[0] + corner / gamma * update[n - 1]);
    for (std::size_t i = 0; i < n; ++i) second_[i] = right[i] - factor * update[i];
  }
  second_[n] = second_[0];
}

double TimeTable::end_rounding() const noexcept {
  return 1e-12 * std::max(std::abs(times_.front()), std::abs(times_.back()));
}

bool TimeTable::locate(double t, Place& place, EvaluationFailure& failure) const noexcept {
  const double first = times_.front(), last = times_.back();
  const double inside = std::clamp(t, first, last);
  place = {inside, t - inside, 0.0};
  // A step that ends a rounding error after the last time is still at it.
  if (outside_ != Outside::repeat && std::abs(place.beyond) <= end_rounding()) place.beyond = 0.0;
  if (outside_ == Outside::hold || (place.beyond == 0.0 && (outside_ == Outside::error || t < last))) return true;
  if (outside_ == Outside::repeat) {
    place.periods = std::floor((t - first) / (last - first));
    place.t = std::clamp(t - place.periods * (last - first), first, last);
    place.beyond = 0.0;
    return true;
  }
  failure = {"bad-table", "the time is outside of the table", 0, 1};
  return false;
}

std::size_t TimeTable::piece(double t) const noexcept {
  const auto after = std::upper_bound(times_.begin() + 1, times_.end() - 1, t);
  return static_cast<std::size_t>(after - times_.begin()) - 1;
}

bool TimeTable::evaluate(double t, Jet& out, EvaluationFailure& failure) const noexcept {
  Place place;
  if (!locate(t, place, failure)) return false;
  const std::size_t i = piece(place.t);
  const double h = times_[i + 1] - times_[i], a = (times_[i + 1] - place.t) / h, b = (place.t - times_[i]) / h;
  const double m0 = second_[i], m1 = second_[i + 1];
  out.value = a * values_[i] + b * values_[i + 1] + ((a * a * a - a) * m0 + (b * b * b - b) * m1) * h * h / 6.0;
  out.rate = slope(i) + ((3.0 * b * b - 1.0) * m1 - (3.0 * a * a - 1.0) * m0) * h / 6.0;
  out.acceleration = a * m0 + b * m1;
  if (place.beyond != 0.0) out = Jet::constant(out.value);
  return true;
}

// The next end of the table or, if `inner`, point.
double TimeTable::next_place(double t, bool inner) const noexcept {
  const double first = times_.front(), last = times_.back(), none = std::numeric_limits<double>::infinity();
  const bool repeats = outside_ == Outside::repeat;
  if (!repeats && t < first) return first;
  const double behind_last = repeats ? last : last + end_rounding();
  if (!repeats && t >= behind_last) return none;
  const double period = last - first, passed = repeats ? std::floor((t - first) / period) : 0.0;
  // The time may be at the end of the period before, or rounded to it; from the first time on none is before.
  const double before = t < first ? passed - 1.0 : std::max(passed - 1.0, 0.0);
  for (const double periods : {before, passed, passed + 1.0}) {
    const double shift = periods * period, end = repeats ? last + shift : behind_last;
    if (inner) {
      // What t - shift is rounded to may be one point off on either side. The first is the end of the period before.
      auto point = std::upper_bound(times_.begin() + 1, times_.end() - 1, t - shift);
      if (point != times_.begin() + 1) --point;
      while (point != times_.end() - 1 && !(*point + shift > t)) ++point;
      if (point != times_.end() - 1) return *point + shift;
    }
    if (end > t) return end;
  }
  return none;
}

double TimeTable::integral_within(double t) const noexcept {
  const std::size_t i = piece(t);
  const double h = times_[i + 1] - times_[i], a = (times_[i + 1] - t) / h, b = (t - times_[i]) / h;
  const double bend = b * b * (b * b - 2.0) * second_[i + 1] - (1.0 - a * a) * (1.0 - a * a) * second_[i];
  return areas_[i] + 0.5 * h * ((1.0 - a * a) * values_[i] + b * b * values_[i + 1]) + h * h * h / 24.0 * bend;
}

bool TimeTable::integral(double t, double& out, EvaluationFailure& failure) const noexcept {
  Place place;
  if (!locate(t, place, failure)) return false;
  out = place.periods * areas_.back() + integral_within(place.t);
  if (place.beyond != 0.0) out += place.beyond * (place.beyond < 0.0 ? values_.front() : values_.back());
  return true;
}

}  // namespace freeplay
