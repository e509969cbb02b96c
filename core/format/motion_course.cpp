#include "format/motion_course.h"

#include <algorithm>
#include <cmath>

namespace freeplay {
namespace {

constexpr int samples = 128;  // of a motion over the run
constexpr int halvings = 40;  // towards the fastest place of a motion

/// `look(t, jet)` is false where the motion has no value.
template <class Look>
Course course_by(const Look& look, const Settings& settings, double spans) {
  Course course;
  double forward = 0.0, back = 0.0, last_rate = 0.0;
  for (int i = 0; i <= samples; ++i) {
    Jet jet;
    if (!look(settings.start + spans * (settings.end - settings.start) * i / samples, jet)) return {};
    if (i == 0) course.begin = course.low = course.high = jet.value;
    course.low = std::min(course.low, jet.value);
    course.high = std::max(course.high, jet.value);
    forward = std::max(forward, jet.rate);
    back = std::max(back, -jet.rate);
    last_rate = std::abs(jet.rate);
  }
  course.fastest = std::max(forward, back);
  const double noise = 1e-9 * course.fastest;
  course.returns = (forward > noise && back > noise) || last_rate <= noise;
  course.known = std::isfinite(course.fastest) && std::isfinite(course.high - course.low);
  return course;
}

}  // namespace

Course course_of(const Expression& motion, const Settings& settings, double spans) {
  EvaluationFailure failure;
  return course_by([&](double t, Jet& jet) { return motion.evaluate(t, jet, failure); }, settings, spans);
}

Course course_of(const Driver& driver, const Settings& settings) {
  EvaluationFailure failure;
  const auto look = [&](double t, Jet& jet) {
    return driver.table ? driver.table->evaluate(t, jet, failure) : driver.value.evaluate(t, jet, failure);
  };
  if (driver.kind != DriverKind::velocity) return course_by(look, settings, 1.0);
  double sum = 0.0, before = 0.0, last = settings.start;
  return course_by(
      [&](double t, Jet& jet) {
        Jet speed;
        if (!look(t, speed)) return false;
        sum += 0.5 * (t - last) * (speed.value + (t > last ? before : speed.value));
        before = speed.value, last = t;
        jet.value = sum, jet.rate = speed.value;
        return true;
      },
      settings, 1.0);
}

double peak_speed(const Expression& motion, const Settings& settings) {
  const auto look = [&](double t, Jet& jet) {
    EvaluationFailure failure;
    return motion.evaluate(t, jet, failure);
  };
  const double span = (settings.end - settings.start) / samples;
  double fastest = 0.0, most = -1.0, to = settings.start, before = 0.0;
  for (int i = 0; i <= samples; ++i) {
    const double t = settings.start + span * i;
    Jet jet;
    if (!look(t, jet)) return 0.0;
    fastest = std::max(fastest, std::abs(jet.rate));
    const double change = i > 0 ? std::abs(jet.value - before) : 0.0;
    if (change > most) most = change, to = t;
    before = jet.value;
  }
  double from = to - span;
  Jet first, last;
  if (!look(from, first) || !look(to, last)) return fastest;
  for (int halving = 0; halving < halvings && to > from; ++halving) {
    const double middle = 0.5 * (from + to);
    Jet jet;
    if (!look(middle, jet)) return fastest;
    fastest = std::max(fastest, std::abs(jet.rate));
    const bool first_half = std::abs(jet.value - first.value) > std::abs(last.value - jet.value);
    (first_half ? to : from) = middle;
    (first_half ? last : first) = jet;
  }
  return fastest;
}

}  // namespace freeplay
