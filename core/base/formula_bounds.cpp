#include "base/formula_bounds.h"

#include <algorithm>
#include <cmath>

#include "base/formula_sides.h"

namespace freeplay {
namespace {

constexpr int usual_operands = 16, most_operands = 5004;
constexpr double most_even = 4.0;  // degree of a product that goes as evenly as steps of integrators resolve
constexpr double uneven = 1e3;     // of what is no polynomial

}  // namespace

FormulaBounds::FormulaBounds(const StateFormula& formula) : formula_(formula) {
  std::vector<double> stack;  // degrees
  for (std::size_t i = 0; i < formula.switch_of_.size(); ++i) {
    const Expression::Instruction& instruction = formula.expression_.program_[i];
    const auto count = static_cast<std::size_t>(Expression::operand_count(instruction.operation));
    const std::size_t first = stack.size() - count;
    const double* const x = stack.data() + first;
    if (formula.switch_of_[i] >= 0) {
      const std::size_t decide = instruction.operation == Operation::choose ? 2 : count;
      even_.push_back(*std::max_element(x, x + decide) <= 1.0 ? 1 : 0);
    }
    const double made = degree(instruction, x, count);
    stack.resize(first);
    stack.push_back(made);
  }
  may_hide_ = std::ranges::find(even_, 0) != even_.end() || stack.front() > most_even;
}

// By the variables, as far as switches keep their sides. What depends on time alone is looked at elsewhere.
double FormulaBounds::degree(const Expression::Instruction& instruction, const double* x, std::size_t count) {
  const double largest = count == 0 ? 0.0 : *std::max_element(x, x + count);
  switch (instruction.operation) {
    case Operation::push_variable:
      return 1.0;
    case Operation::negate:
    case Operation::add:
    case Operation::subtract:
    case Operation::absolute:
    case Operation::minimum:
    case Operation::maximum:
      return largest;
    case Operation::sign:
      return 0.0;
    case Operation::multiply:
      return x[0] + x[1];
    case Operation::choose:
      return std::max(x[2], x[3]);
    case Operation::divide:
      if (x[1] == 0.0) return x[0];
      break;
    case Operation::power_constant: {
      const double power = instruction.constant;
      if (power >= 0.0 && power == std::floor(power)) return power * x[0];
      break;
    }
    default:
      break;
  }
  return largest > 0.0 ? uneven : 0.0;
}

void FormulaBounds::bound(const Span& span, Bounds& out, std::span<Bounds> switches) const noexcept {
  formula_.expression_.stack_depth_ <= usual_operands ? bound_in<usual_operands>(span, out, switches)
                                                      : bound_in<most_operands>(span, out, switches);
}

template <int depth>
void FormulaBounds::bound_in(const Span& span, Bounds& out, std::span<Bounds> switches) const noexcept {
  IntervalJet ranges[depth];
  Jet middles[depth];
  std::size_t top = 0;  // one past the last operand
  EvaluationFailure ignored;
  const Expression& expression = formula_.expression_;
  for (std::size_t i = 0; i < formula_.switch_of_.size(); ++i) {
    const Expression::Instruction& instruction = expression.program_[i];
    const std::size_t first = top - static_cast<std::size_t>(Expression::operand_count(instruction.operation));
    IntervalJet* const x = ranges + first;
    Jet* const m = middles + first;
    top = first + 1;
    if (instruction.operation == Operation::push_constant) {
      *x = IntervalJet::constant(Interval::at(instruction.constant));
      *m = Jet::constant(instruction.constant);
    } else if (instruction.operation == Operation::push_time) {
      *x = {{span.middle - span.half, span.middle + span.half}, Interval::at(1.0), {}};
      *m = Jet::time(span.middle);
    } else if (instruction.operation == Operation::push_variable) {
      *x = span.ranges[static_cast<std::size_t>(instruction.constant)];
      *m = span.at_middle[static_cast<std::size_t>(instruction.constant)];
    } else if (const int index = formula_.switch_of_[i]; index >= 0 || has_forms(instruction.operation)) {
      // What time alone decides is no switch: it has the form of its values.
      const Bounds decides = decides_by(instruction, span, x, m);
      if (index >= 0) switches[static_cast<std::size_t>(index)] = decides;
      take_form(instruction, index < 0 || span.sides == nullptr ? 0.0 : span.sides[index], decides, x, m);
      tighten(*x, *m, span.half);
    } else {
      *x = range_of(instruction, x);
      if (!expression.apply_or_lack(instruction, m, ignored)) *m = Jet::constant(std::nan(""));
      tighten(*x, *m, span.half);
    }
  }
  out = {ranges[0], middles[0]};
}

Interval FormulaBounds::values(std::span<const Interval> ranges, const Interval& time) const noexcept {
  return formula_.expression_.stack_depth_ <= usual_operands ? values_in<usual_operands>(ranges, time)
                                                             : values_in<most_operands>(ranges, time);
}

template <int depth>
Interval FormulaBounds::values_in(std::span<const Interval> ranges, const Interval& time) const noexcept {
  Interval operands[depth];
  std::size_t top = 0;  // one past the last operand
  for (const Expression::Instruction& instruction : formula_.expression_.program_) {
    const std::size_t first = top - static_cast<std::size_t>(Expression::operand_count(instruction.operation));
    Interval* const x = operands + first;
    top = first + 1;
    if (instruction.operation == Operation::push_constant) {
      *x = Interval::at(instruction.constant);
    } else if (instruction.operation == Operation::push_time) {
      *x = time;
    } else if (instruction.operation == Operation::push_variable) {
      *x = ranges[static_cast<std::size_t>(instruction.constant)];
    } else {
      *x = value_of(instruction, x);
    }
  }
  return operands[0];
}

bool FormulaBounds::has_forms(Operation operation) noexcept {
  return operation == Operation::absolute || operation == Operation::sign || operation == Operation::minimum ||
         operation == Operation::maximum || operation == Operation::choose;
}

Interval FormulaBounds::value_of(const Expression::Instruction& instruction, const Interval* x) noexcept {
  Interval out;
  if (FormulaSides::take_usual(instruction, x, out)) return out;
  if (has_forms(instruction.operation)) return chosen(instruction, x);
  constexpr std::size_t most = 4;
  IntervalJet jets[most];
  const auto count = static_cast<std::size_t>(Expression::operand_count(instruction.operation));
  for (std::size_t k = 0; k < count; ++k) jets[k] = {x[k], Interval::whole(), Interval::whole()};
  return range_of(instruction, jets).value;
}

// Of what has two forms: both where its operands leave it open.
Interval FormulaBounds::chosen(const Expression::Instruction& instruction, const Interval* x) noexcept {
  switch (instruction.operation) {
    case Operation::absolute:
      return x[0].low >= 0.0 ? x[0] : x[0].high <= 0.0 ? -x[0] : Interval{0.0, std::max(-x[0].low, x[0].high)};
    case Operation::sign:
      return {x[0].low > 0.0 ? 1.0 : -1.0, x[0].high < 0.0 ? -1.0 : 1.0};
    case Operation::minimum:
      return {std::min(x[0].low, x[1].low), std::min(x[0].high, x[1].high)};
    case Operation::maximum:
      return {std::max(x[0].low, x[1].low), std::max(x[0].high, x[1].high)};
    default:
      break;
  }
  const Interval margin = Expression::margin(instruction.comparison(), x[0], x[1]);
  if (margin.low > 0.0) return x[2];
  return margin.high < 0.0 ? x[3] : hull(x[2], x[3]);
}

IntervalJet FormulaBounds::range_of(const Expression::Instruction& instruction, const IntervalJet* x) noexcept {
  if (instruction.operation == Operation::smooth) return smooth(x[0], x[1], x[2]);
  if (instruction.operation == Operation::arctangent2) {
    // It may jump from one side of the half line to the left to the other.
    const bool jumps = x[0].value.contains(0.0) && x[1].value.low <= 0.0;
    return jumps ? IntervalJet{{-M_PI, M_PI}, Interval::whole(), Interval::whole()} : atan2(x[0], x[1]);
  }
  return FormulaSides::range_of(instruction, x);
}

FormulaBounds::Bounds FormulaBounds::decides_by(const Expression::Instruction& instruction, const Span& span,
                                                const IntervalJet* x, const Jet* m) noexcept {
  Bounds out{x[0], m[0]};
  if (instruction.operation == Operation::minimum || instruction.operation == Operation::maximum) {
    out = {x[0] - x[1], m[0] - m[1]};
  } else if (instruction.operation == Operation::choose) {
    const Expression::Comparison comparison = instruction.comparison();
    out = {Expression::margin(comparison, x[0], x[1]), Expression::margin(comparison, m[0], m[1])};
  }
  tighten(out.range, out.at_middle, span.half);
  return out;
}

// The form of a switch on its side, of its operands over the span and in the middle. Where values decide and the span
// has both sides, what either form can come to.
void FormulaBounds::take_form(const Expression::Instruction& instruction, double side, const Bounds& decides,
                              IntervalJet* x, Jet* m) noexcept {
  const Interval& values = decides.range.value;
  const double in_span = side != 0.0 ? side : values.low > 0.0 ? 1.0 : values.high < 0.0 ? -1.0 : 0.0;
  const double at_middle = side != 0.0 ? side : decides.at_middle.value >= 0.0 ? 1.0 : -1.0;
  if (instruction.operation == Operation::sign) {
    *x = in_span != 0.0 ? IntervalJet::constant(Interval::at(in_span))
                        : IntervalJet{{-1.0, 1.0}, Interval::whole(), Interval::whole()};
    *m = Jet::constant(at_middle);
    return;
  }
  const std::size_t above = form_above(instruction.operation), below = above == 0 ? 1 : above == 1 ? 0 : 3;
  const bool negates = instruction.operation == Operation::absolute, jumps = instruction.operation == Operation::choose;
  const IntervalJet over = x[above], under = negates ? -x[0] : x[below];
  if (in_span == 0.0) {
    *x = {hull(over.value, under.value), jumps ? Interval::whole() : hull(over.rate, under.rate), Interval::whole()};
  } else {
    *x = in_span > 0.0 ? over : under;
  }
  *m = at_middle > 0.0 ? m[above] : negates ? -m[0] : m[below];
}

// Which operand is the form above zero.
std::size_t FormulaBounds::form_above(Operation operation) noexcept {
  return operation == Operation::choose ? 2 : operation == Operation::minimum ? 1 : 0;
}

}  // namespace freeplay
