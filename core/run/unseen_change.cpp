#include "run/unseen_change.h"

#include <algorithm>
#include <cmath>

#include "base/formula_course.h"

namespace freeplay {
namespace {

constexpr double noticed = 0.1;           // of the range that four steps show
constexpr double little_of_run = 1e-3;    // of that of the whole run
constexpr double slow_enough = 0.5;       // rate times the length of four steps
constexpr long enough_work = 20'000'000;  // instructions of bounds
constexpr double shortest = 1e-12;        // of a step: spans that are not halved any more
constexpr double same_time = 1e-15;       // of times: those closer are one
constexpr int parts = 64;                 // of a step, to see how far a change goes

const Interval& signal(const IntervalJet& range, int derivative) {
  return derivative == 0 ? range.value : derivative == 1 ? range.rate : range.acceleration;
}

}  // namespace

double UnseenChange::Window::beyond(double value) const { return std::max(value - high, low - value); }

double UnseenChange::Window::polynomial(double t) const {
  const double x = 4.0 * (t - begin) / (end - begin);
  const double a = x, b = x - 1.0, c = x - 2.0, d = x - 3.0, e = x - 4.0;
  return b * c * d * e / 24.0 * shown[0] - a * c * d * e / 6.0 * shown[1] + a * b * d * e / 4.0 * shown[2] -
         a * b * c * e / 6.0 * shown[3] + a * b * c * d / 24.0 * shown[4];
}

template <class Function>
bool UnseenChange::value(const Function& function, double t, double& out) const {
  Jet jet;
  EvaluationFailure failure;
  if (!function.evaluate(t, jet, failure)) return false;
  out = derivative_ == 0 ? jet.value : derivative_ == 1 ? jet.rate : jet.acceleration;
  return std::isfinite(out);
}

template <class Function>
bool UnseenChange::look(const Function& function, double begin, Window& window) const {
  window.begin = begin, window.end = begin + 4.0 * step_;
  for (std::size_t k = 0; k < 5; ++k) {
    if (!value(function, begin + static_cast<double>(k) * step_, window.shown[k])) return false;
  }
  const auto [low, high] = std::ranges::minmax(window.shown);
  window.low = low, window.high = high;
  window.allowed = std::max(noticed * (high - low), little_of_run * (high_ - low_));
  return true;
}

template <class Function>
void UnseenChange::note_range(const Function& function) {
  bool any = false;
  constexpr double most = 100'000.0;
  const double by = std::max(step_, (to_ - from_) / most);
  for (double t = from_; t <= to_; t += by) {
    double now = 0.0;
    if (!value(function, t, now)) continue;
    low_ = any ? std::min(low_, now) : now;
    high_ = any ? std::max(high_, now) : now;
    any = true;
  }
}

// In the middles of steps, where nothing jumps.
template <class Function>
std::optional<double> UnseenChange::between(const Function& function, const Window& window) const {
  for (int k = 0; k < 4; ++k) {
    const double t = window.begin + (k + 0.5) * step_;
    double now = 0.0;
    if (value(function, t, now) && std::abs(now - window.polynomial(t)) > window.allowed) return t;
  }
  return {};
}

template <class Function>
UnseenChange::Found UnseenChange::measured(const Function& function, const Window& window, double t) const {
  double top = t, best = 0.0, now = 0.0;
  std::array<double, 5> sorted = window.shown;
  std::ranges::sort(sorted);
  const auto by = [&] { return std::abs(now - sorted[2]); };
  for (double reach = 2.0 * step_; reach > shortest * step_; reach *= 0.1) {
    const double middle = top;
    for (int k = -parts; k <= parts; ++k) {
      const double time = std::clamp(middle + reach * k / parts, from_, to_);
      if (value(function, time, now) && by() > best) best = by(), top = time;
    }
  }
  double length = step_;
  const auto lasts = [&](double time) { return value(function, time, now) && by() > 0.5 * best; };
  while (length > shortest * step_ && !(lasts(top - length) && lasts(top + length))) length *= 0.8;
  return {top, length};
}

// Whether a signal that bends by no more than `second` is as four steps show it.
bool UnseenChange::is_slow(const Interval& second, double length) const {
  const double bend = std::max(std::abs(second.low), std::abs(second.high));
  return bend * length * length <= 8.0 * little_of_run * (high_ - low_);
}

std::optional<double> UnseenChange::hidden(const Expression& formula, FormulaSides& sides, const Window& window,
                                           const FormulaSides::Span& span) const {
  const Interval range = signal(sides.range(span), derivative_);
  if (!window.hides(range.low) && !window.hides(range.high)) return {};
  double now = 0.0;
  if (value(formula, span.middle(), now) && window.hides(now)) return span.middle();
  if (span.high - span.low <= shortest * step_ || sides.work() > enough_work) return {};
  if (const auto found = hidden(formula, sides, window, {span.low, span.middle()})) return found;
  return hidden(formula, sides, window, {span.middle(), span.high});
}

std::optional<UnseenChange::Found> UnseenChange::of(const Expression& formula, double from, double to, double step,
                                                    int derivative) {
  if (!formula.depends_on_time()) return {};
  UnseenChange change(from, to, step, derivative);
  FormulaCourse course(formula, from, to);
  FormulaSides sides(formula, from, to, same_time * std::max(std::abs(from), std::abs(to)));
  change.note_range(formula);
  const double length = 4.0 * step;
  const auto quiet = [&](double t, double span) {
    course.next_corner(t, t + span);
    return course.rate_within(t, t + span) * length <= slow_enough ||
           (derivative == 0 && change.is_slow(sides.range({t, t + span}).acceleration, length));
  };
  Window window;
  for (double t = from; t < to && sides.work() < enough_work;) {
    double span = length;
    if (quiet(t, span)) {
      while (t + span < to && quiet(t, 2.0 * span)) span *= 2.0;
    } else if (change.look(formula, t, window)) {
      const bool bends = sides.range({t, t + length}).acceleration.is_finite();
      std::optional<double> found = bends ? change.between(formula, window) : std::nullopt;
      if (!found) found = change.hidden(formula, sides, window, {t, t + length});
      if (found) return change.measured(formula, window, *found);
    }
    t += span;
  }
  return {};
}

std::optional<UnseenChange::Found> UnseenChange::of(const TimeTable& table, double from, double to, double step,
                                                    int derivative) {
  UnseenChange change(from, to, step, derivative);
  change.note_range(table);
  Window window;
  double now = 0.0;
  for (double t = from; t < to; t += 4.0 * step) {
    if (!(table.next_point(t) < t + 4.0 * step) || !change.look(table, t, window)) continue;
    std::optional<double> found = table.is_straight() ? std::nullopt : change.between(table, window);
    for (double point = t; point < window.end && !found;) {
      const double next = table.next_point(point);
      const double middle = 0.5 * (point + std::min(next, window.end));
      if (next < window.end && change.value(table, next, now) && window.hides(now)) found = next;
      if (change.value(table, middle, now) && window.hides(now)) found = middle;
      point = next;
    }
    if (found) return change.measured(table, window, *found);
  }
  return {};
}

}  // namespace freeplay
