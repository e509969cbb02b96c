#include "system/antiderivative.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/error.h"

namespace freeplay {
namespace {

// Gauss-Legendre rule with 8 points on [-1, 1], positive half (Abramowitz and Stegun, table 25.4).
constexpr double node[4] = {0.1834346424956498049394761, 0.5255324099163289858177390, 0.7966664774136267395915539,
                            0.9602898564975362316835609};
constexpr double weight[4] = {0.3626837833783619829651504, 0.3137066458778872873379622, 0.2223810344533744705443560,
                              0.1012285362903762591525314};
constexpr int first_cuts = 6,
              unknown_cuts = 10;  // into halves, before a rule is believed that may miss what lies between
constexpr int deepest = 40;       // 2^-40 of the run: a kink costs 1e-12 of a panel at most
constexpr int patient_cuts = 6;   // more than at least: then what does not shrink any more is rounding
constexpr double small = 1e-9;    // of the integral: rounding is less
constexpr double shrinks = 0.75;  // of its part: a kink shrinks to a half of that, rounding does not
constexpr std::size_t most_panels = 1 << 20;

}  // namespace

Antiderivative::Antiderivative(const Expression& integrand, double start, double end, const Location& location)
    : integrand_(&integrand), start_(start) {
  if (!integrand.depends_on_time()) return;
  const Outline outline = integrand.outline(start, end);
  const int fewer = static_cast<int>(std::bit_width(outline.corners.size()));
  for (std::size_t i = 0; i <= outline.corners.size(); ++i) {
    const double from = i == 0 ? start : outline.corners[i - 1].time;
    const double to = i < outline.corners.size() ? outline.corners[i].time : end;
    if (!(from < to)) continue;
    double whole = 0.0;
    EvaluationFailure failure;
    if (!gauss(from, to, whole, failure)) {
      throw Error(Error::Category::input, failure.id, failure.reason, location);
    }
    cut(from, to, whole, std::max(0, (std::isfinite(outline.rates[i]) ? first_cuts : unknown_cuts) - fewer), location);
  }
}

// `cuts` are made at least.
void Antiderivative::cut(double from, double to, double whole, int cuts, const Location& location, int depth,
                         double before) {
  const double middle = 0.5 * (from + to);
  double left = 0.0, right = 0.0;
  EvaluationFailure failure;
  if (!gauss(from, middle, left, failure) || !gauss(middle, to, right, failure)) {
    throw Error(Error::Category::input, failure.id, failure.reason, location);
  }
  const double scale = std::abs(left) + std::abs(right) + std::abs(total_);
  const double change = std::abs(left + right - whole);
  const bool rounded = depth >= cuts + patient_cuts && change <= small * scale && change > shrinks * before;
  if (depth >= cuts && (change <= 1e-15 * scale || rounded || depth >= deepest || panels_.size() >= most_panels)) {
    panels_.push_back({from, total_});
    total_ += left + right;
    return;
  }
  // The halves share what is left.
  cut(from, middle, left, cuts, location, depth + 1, 0.5 * change);
  cut(middle, to, right, cuts, location, depth + 1, 0.5 * change);
}

bool Antiderivative::gauss(double from, double to, double& sum, EvaluationFailure& failure) const noexcept {
  const double centre = 0.5 * (from + to), half = 0.5 * (to - from);
  sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    Jet low, high;
    if (!integrand_->evaluate(centre - half * node[i], low, failure)) return false;
    if (!integrand_->evaluate(centre + half * node[i], high, failure)) return false;
    sum += weight[i] * (low.value + high.value);
  }
  sum *= half;
  return true;
}

bool Antiderivative::evaluate(double t, double& integral, EvaluationFailure& failure) const noexcept {
  if (panels_.empty()) {
    Jet value;
    if (!integrand_->evaluate(t, value, failure)) return false;
    integral = value.value * (t - start_);
    return true;
  }
  auto after = std::upper_bound(panels_.begin(), panels_.end(), t,
                                [](double time, const Panel& panel) { return time < panel.start; });
  const Panel& panel = after == panels_.begin() ? *after : *std::prev(after);
  double part = 0.0;
  if (!gauss(panel.start, t, part, failure)) return false;
  integral = panel.integral + part;
  return true;
}

}  // namespace freeplay
