// Where a formula has kinks: the times at which abs, min and max change sides.
#include <algorithm>
#include <cmath>

#include "base/expression.h"

namespace freeplay {
namespace {

constexpr int fewest_looks = 4096, most_looks = 1 << 18;

struct Look {
  double t = 0.0;
  std::vector<Jet> sides;  // what decides at each abs, min and max: above or below zero; empty where there is no value
};

bool above(const Jet& side) { return side.value >= 0.0; }

}  // namespace

std::vector<Jet> Expression::sides(double t) const {
  std::vector<Jet> stack, found;
  EvaluationFailure failure;
  for (const Instruction& instruction : program_) {
    if (instruction.operation == Operation::push_time) {
      stack.push_back(Jet::time(t));
      continue;
    }
    const auto count = static_cast<std::size_t>(operand_count(instruction.operation));
    if (count == 0) stack.emplace_back();
    Jet* const operands = stack.data() + (stack.size() - std::max<std::size_t>(count, 1));
    if (instruction.operation == Operation::absolute) found.push_back(operands[0]);
    if (instruction.operation == Operation::minimum || instruction.operation == Operation::maximum) {
      found.push_back(operands[0] - operands[1]);
    }
    if (!apply(instruction, operands, failure)) return {};
    if (count > 1) stack.resize(stack.size() - (count - 1));
  }
  return found;
}

std::vector<double> Expression::kinks(double from, double to) const {
  std::vector<double> times;
  const bool any = std::ranges::any_of(program_, [](const Instruction& i) {
    return i.operation == Operation::absolute || i.operation == Operation::minimum || i.operation == Operation::maximum;
  });
  if (!depends_on_time_ || !any || !(from < to)) return times;

  // The first time after `low` at which a side is what it is at `high`: between neighbouring numbers.
  const auto bisect = [&](std::size_t side, double low, double high, bool at_high) {
    for (double middle = 0.5 * (low + high); low < middle && middle < high; middle = 0.5 * (low + high)) {
      const std::vector<Jet> here = sides(middle);
      (here.empty() || above(here[side]) == at_high ? high : low) = middle;
    }
    times.push_back(high);
  };
  for (int looks = fewest_looks;; looks *= 4) {
    times.clear();
    Look before{from, sides(from)};
    for (int i = 1; i <= looks; ++i) {
      const double t = from + (to - from) * i / looks, h = t - before.t;
      Look now{t, sides(t)};
      for (std::size_t s = 0; s < now.sides.size() && s < before.sides.size(); ++s) {
        const Jet &a = before.sides[s], &b = now.sides[s];
        if (above(a) != above(b)) {
          bisect(s, before.t, t, above(b));
        } else if ((a.rate < 0.0) == above(a) && (b.rate > 0.0) == above(b) && a.rate * b.rate < 0.0) {
          // Towards zero at both ends: the straight lines of (value, rate) meet where it may pass and come back.
          const double meet = std::clamp((b.value - a.value - h * b.rate) / (a.rate - b.rate), 0.0, h);
          const std::vector<Jet> inside = sides(before.t + meet);
          if (inside.empty() || above(inside[s]) == above(a)) continue;
          bisect(s, before.t, before.t + meet, !above(a));
          bisect(s, before.t + meet, t, above(a));
        }
      }
      before = std::move(now);
    }
    if (times.size() < static_cast<std::size_t>(looks / 8) || looks >= most_looks) break;
  }
  std::ranges::sort(times);
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

}  // namespace freeplay
