#include "run/jump_error.h"

#include <algorithm>
#include <cmath>

namespace freeplay {
namespace {

constexpr double most_steps_to_sum = 5e6;
constexpr double side_of_jump = 1e-9;    // of a step: there a load is on one side
constexpr double seen_jump_part = 1e-9;  // of its values on both sides
constexpr double whole_step = 1e-6;      // of a step, as FixedRun counts them

bool jumps_at(const Expression& formula, double t, double side) {
  Jet before, after;
  EvaluationFailure failure;
  if (!formula.evaluate(t - side, before, failure) || !formula.evaluate(t + side, after, failure)) return false;
  const double rates = std::abs(before.rate) + std::abs(after.rate);
  return std::abs(after.value - before.value) >
         seen_jump_part * std::max(std::abs(before.value), std::abs(after.value)) + 4.0 * side * rates;
}

/// Sums of a load, and of what steps are off it.
class JumpSums {
 public:
  JumpSums(const Expression& formula, std::span<const double> times) : formula_(formula), next_(times) {}

  bool is_good() const { return good_; }
  JumpError error() const { return {jumps_, off_.farthest > 0.0 ? off_.farthest / load_.farthest : 0.0}; }

  void add(double from, double to) {
    const double side = side_of_jump * (to - from);
    double begin = from + side, exact = 0.0;
    const double even = 0.5 * (to - from) * (value(begin) + value(to - side));
    bool cut = false;
    for (; !next_.empty() && next_.front() < to - side; next_ = next_.subspan(1)) {
      if (next_.front() <= begin) continue;  // at which the step begins
      exact += area(begin, next_.front() - side);
      jumps_ += jumps_at(formula_, next_.front(), side) ? 1 : 0;
      begin = next_.front() + side;
      cut = true;
    }
    if (cut) exact += area(begin, to - side);
    load_.add(to - from, cut ? exact : even);
    off_.add(to - from, cut ? exact - even : 0.0);
  }

 private:
  struct Way {
    double speed = 0.0, place = 0.0, farthest = 0.0;
    void add(double dt, double impulse) {
      place += dt * (speed + 0.5 * impulse);
      speed += impulse;
      farthest = std::max(farthest, std::abs(place));
    }
  };
  double value(double t) {
    Jet jet;
    EvaluationFailure failure;
    good_ = good_ && formula_.evaluate(t, jet, failure) && std::isfinite(jet.value);
    return good_ ? jet.value : 0.0;
  }
  double area(double from, double to) {
    return (to - from) / 6.0 * (value(from) + 4.0 * value(0.5 * (from + to)) + value(to));
  }

  const Expression& formula_;
  std::span<const double> next_;
  Way load_{}, off_{};
  int jumps_ = 0;
  bool good_ = true;
};

}  // namespace

std::optional<JumpError> jump_error(const Expression& formula, std::span<const double> times, const StepTimes& run) {
  if (!((run.to - run.from) / run.step < most_steps_to_sum)) return {};
  const double side = side_of_jump * run.step;
  if (std::ranges::none_of(times, [&](double t) { return jumps_at(formula, t, side); })) return {};
  JumpSums sums(formula, times);
  double row = run.from;
  for (double count = 1.0; row < run.to && sums.is_good(); ++count) {
    const double target = std::min(run.from + count * run.interval, run.to);
    const double steps = std::max(1.0, std::ceil((target - row) / run.step - whole_step));
    double from = row;
    for (double k = 1.0; k <= steps; ++k) {
      const double to = k == steps ? target : row + k * run.step;
      sums.add(from, to);
      from = to;
    }
    row = target;
  }
  if (!sums.is_good()) return {};
  return sums.error();
}

}  // namespace freeplay
