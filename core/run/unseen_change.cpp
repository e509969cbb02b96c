#include "run/unseen_change.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace freeplay {
namespace {

constexpr double noticed = 0.1;           // of the range that four steps show
constexpr double little_of_run = 1e-3;    // of that of the whole run
constexpr double slow_enough = 0.5;       // rate times the length of four steps
constexpr long enough_work = 20'000'000;  // instructions of bounds
constexpr double shortest = 1e-12;        // of a step: spans that are not halved any more
constexpr double same_time = 1e-15;       // of times: those closer are one
constexpr double beside_corner = 8.0;     // of these: there the side of a corner is known
constexpr int parts = 64;                 // of a step, to see how far a change goes
constexpr double fewest_looks = 8.0;      // at a step
constexpr double enough_looks = 1e6;
constexpr double unchanged = 1e-9;  // of the largest value
constexpr double rounded = 4.0;  // roundings: between the polynomial of ends, whose weights sum up to 2.2, and a value

const Interval& signal(const IntervalJet& range, int derivative) {
  return derivative == 0 ? range.value : derivative == 1 ? range.rate : range.acceleration;
}

/// One of the signals that are looked at together, as a function of time.
struct OneSignal {
  const UnseenChange::Look& look;
  std::size_t which;
  std::span<double> values;
  bool evaluate(double t, Jet& out, EvaluationFailure& /*failure*/) const {
    if (!look(t, values)) return false;
    out.value = values[which];
    return true;
  }
};

/// What one of them does inside four steps, and over the run at the ends of steps.
struct Sight {
  double low = 0.0, high = 0.0;  // of the ends of these steps
  double inside_low = 0.0, inside_high = 0.0, low_at = 0.0, high_at = 0.0;
  double run_low = std::numeric_limits<double>::infinity(), run_high = -run_low;
  double beyond = 0.0, at = 0.0, begin = 0.0;  // the farthest so far

  void begin_with(double value) { low = high = inside_low = inside_high = value, note_end(value); }
  void note_end(double value) {
    low = std::min(low, value), high = std::max(high, value);
    run_low = std::min(run_low, value), run_high = std::max(run_high, value);
  }
  void note_inside(double value, double t) {
    if (value < inside_low) inside_low = value, low_at = t;
    if (value > inside_high) inside_high = value, high_at = t;
  }
  void end(double from) {
    const double above = inside_high - high, below = low - inside_low;
    const double most = std::max(above, below);
    if (most > noticed * (high - low) && most > beyond)
      beyond = most, at = above > below ? high_at : low_at, begin = from;
  }
  bool hides() const {
    const double largest = std::max({std::abs(run_low), std::abs(run_high), beyond});
    return beyond > std::max(little_of_run * (run_high - run_low), unchanged * largest);
  }
};

}  // namespace

namespace {

/// How far a derivative of a table may be off because its times and values are rounded, at each of its points:
///
///   slopes          s = (y1 - y0)/(t1 - t0)    by u (|y0| + |y1| + |s| (|t0| + |t1|))/(t1 - t0)
///   second ones     which row i of the spline's system takes from 6 (s1 - s0)/(t2 - t0), and its neighbours half of it
std::vector<double> rounding_of(const TimeTable& table, int derivative) {
  constexpr double unit = std::numeric_limits<double>::epsilon();
  const std::span<const double> t = table.times(), y = table.values();
  const std::size_t n = t.size();
  std::vector<double> slopes(n + 1, 0.0), lengths(n + 1, 0.0), out(n, 0.0);  // of the piece before each point
  for (std::size_t i = 1; i < n; ++i) {
    const double h = lengths[i] = t[i] - t[i - 1], slope = (y[i] - y[i - 1]) / h;
    const double values = std::abs(y[i - 1]) + std::abs(y[i]), times = std::abs(t[i - 1]) + std::abs(t[i]);
    slopes[i] = unit * (values + std::abs(slope) * times) / h;
  }
  if (derivative == 0 || (derivative == 2 && table.is_straight())) {
    for (std::size_t i = 0; i < n && derivative == 0; ++i) out[i] = 2.0 * unit * std::abs(y[i]);
    return out;
  }
  if (!table.is_straight()) {
    for (std::size_t i = 0; i < n; ++i) out[i] = 6.0 * (slopes[i] + slopes[i + 1]) / (lengths[i] + lengths[i + 1]);
    for (std::size_t i = 1; i < n; ++i) out[i] = std::max(out[i], 0.5 * out[i - 1]);
    for (std::size_t i = n - 1; i > 0; --i) out[i - 1] = std::max(out[i - 1], 0.5 * out[i]);
  }
  for (std::size_t i = 0; i < n && derivative == 1; ++i) {
    out[i] = std::max(slopes[i] + lengths[i] * out[i], slopes[i + 1] + lengths[i + 1] * out[i]);
  }
  return out;
}

/// The largest in [from, to]; of a table that is repeated, in all of it.
double rounding_within(const TimeTable& table, std::span<const double> rounding, double from, double to) {
  const std::span<const double> t = table.times();
  if (from < t.front() || to > t.back()) return *std::ranges::max_element(rounding);
  const auto first = std::max(std::ranges::upper_bound(t, from) - t.begin() - 1, std::ptrdiff_t{0});
  const auto last = std::min(std::ranges::lower_bound(t, to) - t.begin(), std::ssize(t) - 1);
  return *std::max_element(rounding.begin() + first, rounding.begin() + last + 1);
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
  const double middle = span.middle();
  double now = 0.0;
  if (value(formula, middle, now) && window.hides(now)) return middle;
  const bool undivided = span.high - span.low <= shortest * step_ || !(span.low < middle && middle < span.high);
  if (undivided || sides.work() > enough_work) return {};
  if (const auto found = hidden(formula, sides, window, {span.low, middle})) return found;
  return hidden(formula, sides, window, {middle, span.high});
}

std::optional<double> UnseenChange::inside(const Expression& formula, FormulaSides& sides, const Window& window) const {
  const FormulaSides::Span span{window.begin, window.end};
  const bool bends = sides.range(span).acceleration.is_finite();
  const std::optional<double> found = bends ? between(formula, window) : std::nullopt;
  return found ? found : hidden(formula, sides, window, span);
}

// In four steps from t, in which corners lie: from each to the next, or four steps before the first and after the last
// where none is as near.
std::optional<UnseenChange::Found> UnseenChange::between_corners(const Expression& formula, FormulaCourse& course,
                                                                 FormulaSides& sides, double t) const {
  const double length = 4.0 * step_;
  const double side = beside_corner * same_time * std::max(std::abs(from_), std::abs(to_));
  double end = std::min(course.next_corner(t, t + length), to_), begin = std::max(from_, end - length);
  for (const Corner& corner : course.corners()) {
    if (corner.time < end) begin = std::max(begin, corner.time);
  }
  while (sides.work() < enough_work && course.work() < enough_work) {
    if (const double from = begin + side, to = end - side; from < to) {
      UnseenChange part(from_, to_, 0.25 * (to - from), derivative_);
      part.low_ = low_, part.high_ = high_;
      Window window;
      const bool looked = part.look(formula, from, window);
      const std::optional<double> found = looked ? part.inside(formula, sides, window) : std::nullopt;
      if (found) return part.measured(formula, window, *found);
    }
    if (end >= t + length || end >= to_) break;
    begin = end;
    end = std::min({course.next_corner(begin, begin + length), begin + length, to_});
  }
  return {};
}

std::optional<UnseenChange::Found> UnseenChange::of(const Expression& formula, double from, double to, double step,
                                                    int derivative, double cut_form) {
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
    } else if (length <= cut_form && course.next_corner(t, t + length) < std::min(t + length, to)) {
      if (const auto found = change.between_corners(formula, course, sides, t)) return found;
    } else if (change.look(formula, t, window)) {
      if (const auto found = change.inside(formula, sides, window)) return change.measured(formula, window, *found);
    }
    t += span;
  }
  return {};
}

std::optional<UnseenChange::Found> UnseenChange::of(const TimeTable& table, double from, double to, double step,
                                                    int derivative) {
  UnseenChange change(from, to, step, derivative);
  change.note_range(table);
  const std::vector<double> rounding = rounding_of(table, derivative);
  Window window;
  double now = 0.0;
  for (double begin = from; begin < to; begin += 4.0 * step) {
    const double t = std::max(from, std::min(begin, to - 4.0 * step));  // nothing follows the end of the run
    if (!(table.next_point(t) < t + 4.0 * step) || !change.look(table, t, window)) continue;
    window.allowed = std::max(window.allowed, rounded * rounding_within(table, rounding, t, window.end));
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

std::optional<UnseenChange::Found> UnseenChange::of(const Look& look, std::size_t signals, double from, double to,
                                                    double step, double apart) {
  std::vector<double> values(signals);
  std::vector<Sight> sights(signals);
  const double looks = std::clamp(std::ceil(step / apart), fewest_looks, enough_looks), length = 4.0 * step;
  const double stride = std::max(1.0, std::ceil(4.0 * looks * (to - from) / length / enough_looks)) * length;
  for (double begin = from; begin + length <= to + 0.5 * step; begin += stride) {
    for (double k = 0.0; k <= 4.0 * looks; ++k) {
      const double t = std::min(begin + k * step / looks, to);
      if (!look(t, values)) return {};
      const bool at_end = std::fmod(k, looks) == 0.0;
      for (std::size_t c = 0; c < signals; ++c) {
        if (k == 0.0) sights[c].begin_with(values[c]);
        if (at_end) sights[c].note_end(values[c]);
        if (!at_end) sights[c].note_inside(values[c], t);
      }
    }
    for (Sight& sight : sights) sight.end(begin);
  }
  for (std::size_t c = 0; c < signals; ++c) {
    if (!sights[c].hides()) continue;
    UnseenChange change(from, to, step, 0);
    const OneSignal one{look, c, values};
    Window window;
    if (change.look(one, sights[c].begin, window)) return change.measured(one, window, sights[c].at);
  }
  return {};
}

}  // namespace freeplay
