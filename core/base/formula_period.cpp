#include "base/formula_period.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/formula_course.h"
#include "base/interval_jet.h"

namespace freeplay {

/// What an expression shows of its period, operation by operation.
class FormulaCourse::PeriodFinder {
 public:
  PeriodFinder(const Expression& expression, double from, double to) : expression_(expression), from_(from), to_(to) {}

  std::optional<Recurrence> find() const;

 private:
  using Operation = Expression::Operation;
  /// A value grows evenly and comes again besides, or it is not known how it goes.
  struct Course {
    bool known = true;
    double slope = 0.0, period = 0.0;
    IntervalJet range = unknown_jet();

    bool recurs() const { return known && slope == 0.0; }
    bool constant() const { return recurs() && period == 0.0; }
  };
  Course of(const Expression::Instruction& instruction, const Course* x) const;
  static Course with(const Course& a, const Course& b, double slope);
  static Course product(const Course* x, bool quotient);
  static Course wave(const Course& x, double turn);
  static IntervalJet range_of(const Expression::Instruction& instruction, const Course* x);

  const Expression& expression_;
  double from_, to_;
};

namespace {

constexpr double sameness = 1e-6;  // of values a period apart, by the largest
constexpr double roundings = 1e-9;
// Of the period that operations show: what comes again after less is constant but for instants.
constexpr double constant_below = 1e-6;
constexpr int most_multiples = 1000, instants = 256, between_corners = 8, corners_looked_at = 4096;

}  // namespace

std::optional<double> common_period(double a, double b) {
  if (a == 0.0 || b == 0.0) return std::max(a, b);
  for (int n = 1; n <= most_multiples; ++n) {
    const double others = n * a / b;
    if (others > 0.5 && std::abs(others - std::round(others)) <= roundings * others) return n * a;
  }
  return std::nullopt;
}

auto FormulaCourse::PeriodFinder::with(const Course& a, const Course& b, double slope) -> Course {
  Course out;
  const auto period = a.known && b.known ? common_period(a.period, b.period) : std::nullopt;
  out.known = period.has_value();
  out.slope = slope;
  out.period = period.value_or(0.0);
  return out;
}

auto FormulaCourse::PeriodFinder::wave(const Course& x, double turn) -> Course {
  if (!x.known || x.slope == 0.0) return x;
  Course turning;
  turning.period = turn / std::abs(x.slope);
  return with(x, turning, 0.0);
}

IntervalJet FormulaCourse::PeriodFinder::range_of(const Expression::Instruction& instruction, const Course* x) {
  switch (instruction.operation) {
    case Operation::negate:
      return -x[0].range;
    case Operation::add:
      return x[0].range + x[1].range;
    case Operation::subtract:
      return x[0].range - x[1].range;
    case Operation::multiply:
      return x[0].range * x[1].range;
    case Operation::divide:
      return x[0].range / x[1].range;
    case Operation::power_constant:
      return pow(x[0].range, instruction.constant);
    case Operation::sine:
      return sin(x[0].range);
    case Operation::cosine:
      return cos(x[0].range);
    case Operation::exponential:
      return exp(x[0].range);
    case Operation::hyperbolic_tangent:
      return tanh(x[0].range);
    case Operation::smooth:
      return smooth(x[0].range, x[1].range, x[2].range);
    default:
      return unknown_jet();
  }
}

// Of both operands, or of the first over the second.
auto FormulaCourse::PeriodFinder::product(const Course* x, bool quotient) -> Course {
  const Interval &a = x[0].range.value, &b = x[1].range.value;
  Course out = with(x[0], x[1], 0.0);
  if (x[1].constant() && b.low == b.high) {
    out.slope = quotient ? x[0].slope / b.low : x[0].slope * b.low;
  } else if (!quotient && x[0].constant() && a.low == a.high) {
    out.slope = x[1].slope * a.low;
  } else {
    out.known = out.known && x[0].recurs() && x[1].recurs();
  }
  return out;
}

auto FormulaCourse::PeriodFinder::of(const Expression::Instruction& instruction, const Course* x) const -> Course {
  const auto operands = static_cast<std::size_t>(Expression::operand_count(instruction.operation));
  Course out;
  switch (instruction.operation) {
    case Operation::push_constant:
      out.range = IntervalJet::constant(Interval::at(instruction.constant));
      return out;
    case Operation::push_time:
      out.slope = 1.0;
      out.range = {{from_, to_}, Interval::at(1.0), {}};
      return out;
    case Operation::negate:
      out = x[0];
      out.slope = -x[0].slope;
      break;
    case Operation::add:
      out = with(x[0], x[1], x[0].slope + x[1].slope);
      break;
    case Operation::subtract:
      out = with(x[0], x[1], x[0].slope - x[1].slope);
      break;
    case Operation::multiply:
    case Operation::divide:
      out = product(x, instruction.operation == Operation::divide);
      break;
    case Operation::sine:
    case Operation::cosine:
      out = wave(x[0], 2.0 * std::numbers::pi);
      break;
    case Operation::tangent:
      out = wave(x[0], std::numbers::pi);
      break;
    case Operation::absolute:
      if (x[0].range.value.low >= 0.0) return x[0];
      out = x[0];
      out.known = x[0].recurs();
      break;
    case Operation::minimum:
    case Operation::maximum: {
      const Interval difference = (x[0].range - x[1].range).value;
      const bool most = instruction.operation == Operation::maximum;
      if (difference.low >= 0.0) return x[most ? 0 : 1];
      if (difference.high <= 0.0) return x[most ? 1 : 0];
      [[fallthrough]];
    }
    default:
      out = x[0];
      for (std::size_t i = 1; i < operands; ++i) out = with(out, x[i], 0.0);
      for (std::size_t i = 0; i < operands; ++i) out.known = out.known && x[i].recurs();
      out.slope = 0.0;
  }
  out.range = range_of(instruction, x);
  if (out.range.is_constant() && out.range.value.low == out.range.value.high) {
    Course constant;
    constant.range = out.range;
    return constant;
  }
  return out;
}

std::optional<Recurrence> FormulaCourse::PeriodFinder::find() const {
  std::vector<Course> stack;
  for (const Expression::Instruction& instruction : expression_.program_) {
    const auto count = static_cast<std::size_t>(Expression::operand_count(instruction.operation));
    const std::size_t first = stack.size() - count;
    const Course out = of(instruction, stack.data() + first);
    stack.resize(first);
    stack.push_back(out);
  }
  const Course& end = stack.back();
  if (!end.known) return std::nullopt;
  return Recurrence{end.slope, end.period};
}

namespace {

/// Whether the formula, less its slope, is after `period` what it was at instants from `from` on.
bool repeats(const Expression& expression, double from, const Recurrence& found, double period) {
  std::vector<double> times;
  for (int i = 0; i < instants; ++i) times.push_back(from + found.period * i / instants);
  FormulaCourse course(expression, from, from + found.period);
  double begin = from;
  for (int c = 0; c < corners_looked_at && begin < from + found.period; ++c) {
    const double end = std::min(course.next_corner(begin, from + found.period), from + found.period);
    for (int i = 0; i < between_corners; ++i) times.push_back(begin + (end - begin) * (i + 0.5) / between_corners);
    begin = end;
  }
  double size = 0.0, worst = 0.0;
  for (const double t : times) {
    Jet here, later;
    EvaluationFailure failure;
    if (!expression.evaluate(t, here, failure) || !expression.evaluate(t + period, later, failure)) return false;
    const double value = here.value - found.slope * (t - from);
    size = std::max(size, std::abs(value));
    worst = std::max(worst, std::abs(later.value - found.slope * (t + period - from) - value));
  }
  return worst <= sameness * size;
}

}  // namespace

std::optional<Recurrence> recurrence(const Expression& expression, double from, double to) {
  auto found = FormulaCourse::PeriodFinder(expression, from, to).find();
  if (!found || found->period == 0.0 || !(found->period <= to - from)) return found;
  double period = found->period;
  for (const int part : {2, 3, 5}) {
    while (period > constant_below * found->period && repeats(expression, from, *found, period / part)) period /= part;
  }
  found->period = period > constant_below * found->period ? period : 0.0;
  return found;
}

}  // namespace freeplay
