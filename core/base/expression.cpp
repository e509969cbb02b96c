#include "base/expression.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <new>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include "base/token.h"

namespace freeplay {
namespace {

// Formulas that people write need a handful of places; the deepest that 10 000 characters can ask for is one operand
// and one operator a level.
constexpr int shallow_stack = 8, usual_stack = 32, deepest_stack = 5001;

constexpr std::size_t longest_readable = 40'000;  // bytes; anything longer has too many characters to be compiled

/// Why the operands are outside of the operation's domain, or null.
const char* power_domain(double base, double exponent) {
  if (base == 0.0 && exponent < 0.0) return "division by zero: zero to a negative power";
  if (base < 0.0 && exponent != std::floor(exponent)) return "a negative number to a power that is not an integer";
  return nullptr;
}

}  // namespace

bool fits(DimensionKind kind, const Dimension& dimension, const Dimension& field) {
  return kind != DimensionKind::dimensioned || dimension == field;
}

int Expression::operand_count(Operation operation) noexcept {
  switch (operation) {
    case Operation::push_constant:
    case Operation::push_time:
    case Operation::push_variable:
      return 0;
    case Operation::add:
    case Operation::subtract:
    case Operation::multiply:
    case Operation::divide:
    case Operation::power:
    case Operation::arctangent2:
    case Operation::minimum:
    case Operation::maximum:
      return 2;
    case Operation::smooth:
      return 3;
    case Operation::choose:
      return 4;
    default:
      return 1;
  }
}

// Functions that have no value or no derivative somewhere, and smooth. Returns why the operands are outside of its
// domain, or null.
inline const char* Expression::apply_function(const Instruction& instruction, Jet* operands) noexcept {
  Jet& a = operands[0];
  const Jet* const b = operands + 1;  // only read by operations of two and more operands
  const char* outside = nullptr;
  switch (instruction.operation) {
    case Operation::power_constant:
      outside = power_domain(a.value, instruction.constant);
      a = pow(a, instruction.constant);
      break;
    case Operation::power:
      if (!(a.value > 0.0)) outside = "the base must be positive where the exponent depends on t";
      a = pow(a, *b);
      break;
    case Operation::sine:
      a = sin(a);
      break;
    case Operation::cosine:
      a = cos(a);
      break;
    case Operation::tangent:
      a = tan(a);
      break;
    case Operation::arcsine:
      if (std::abs(a.value) > 1.0) outside = "asin of a number beyond -1 to 1";
      a = asin(a);
      break;
    case Operation::arccosine:
      if (std::abs(a.value) > 1.0) outside = "acos of a number beyond -1 to 1";
      a = acos(a);
      break;
    case Operation::root:
      if (a.value < 0.0) outside = "square root of a negative number";
      a = sqrt(a);
      break;
    case Operation::exponential:
      a = exp(a);
      break;
    case Operation::logarithm:
      if (a.value <= 0.0) outside = "logarithm of a number that is not positive";
      a = log(a);
      break;
    case Operation::hyperbolic_tangent:
      a = tanh(a);
      break;
    case Operation::arctangent2:
      if (a.value == 0.0 && b->value == 0.0) outside = "atan2(0, 0) has no value";
      a = atan2(a, *b);
      break;
    case Operation::smooth:
      if (b[0].value >= b[1].value) outside = "smooth(x, a, b) needs a < b";
      a = freeplay::smooth(a, b[0], b[1]);
      break;
    default:
      break;
  }
  return outside;
}

// Replaces operands[0] by the result.
bool Expression::apply(const Instruction& instruction, Jet* operands, EvaluationFailure& failure) const noexcept {
  Jet& a = operands[0];
  const Jet* const b = operands + 1;
  const char* outside = nullptr;
  switch (instruction.operation) {
    case Operation::push_constant:
      a = Jet::constant(instruction.constant);
      break;
    case Operation::push_time:
    case Operation::push_variable:
      break;
    case Operation::negate:
      a = -a;
      break;
    case Operation::add:
      a = a + *b;
      break;
    case Operation::subtract:
      a = a - *b;
      break;
    case Operation::multiply:
      a = a * *b;
      break;
    case Operation::divide:
      if (b->value == 0.0) outside = "division by zero";
      a = a / *b;
      break;
    case Operation::absolute:
      a = abs(a);
      break;
    case Operation::sign:
      a = Jet::constant(less_from_right(a, Jet{}) ? -1.0 : less_from_right(Jet{}, a) ? 1.0 : 0.0);
      break;
    case Operation::minimum:
      a = min(a, *b);
      break;
    case Operation::maximum:
      a = max(a, *b);
      break;
    case Operation::choose: {
      const Jet over = margin(instruction.comparison(), a, b[0]);
      const bool holds = less_from_right(Jet{}, over) ||
                         (!is_strict(instruction.comparison()) && over.value == 0.0 && !less_from_right(over, Jet{}));
      a = std::isnan(over.value) ? over : holds ? b[1] : b[2];
      break;
    }
    default:
      outside = apply_function(instruction, operands);
  }
  if (!outside && a.is_finite(derivatives_)) return true;
  if (outside) {
    failure = {"bad-expression", outside, instruction.offset, instruction.length};
  } else if (std::isfinite(a.value)) {
    failure = {"bad-expression", "a time derivative is not finite", instruction.offset, instruction.length};
  } else {
    failure = {"bad-number", "the result is not finite", instruction.offset, instruction.length};
  }
  return false;
}

// What most formulas are made of, without a call. False for all else, and for what is not finite or has no value, which
// apply() reports.
[[gnu::always_inline]] inline bool Expression::apply_quickly(Operation operation, Jet*& top) noexcept {
  Jet result;
  int fewer = 1;
  switch (operation) {
    case Operation::add:
      result = top[-2] + top[-1];
      break;
    case Operation::subtract:
      result = top[-2] - top[-1];
      break;
    case Operation::multiply:
      result = top[-2] * top[-1];
      break;
    case Operation::divide:
      if (top[-1].value == 0.0) return false;
      result = top[-2] / top[-1];
      break;
    case Operation::sine:
      result = sin(top[-1]);
      fewer = 0;
      break;
    case Operation::cosine:
      result = cos(top[-1]);
      fewer = 0;
      break;
    default:
      return false;
  }
  if (!result.is_finite()) return false;
  top -= fewer;
  top[-1] = result;
  return true;
}

template <int depth>
bool Expression::run(double t, std::span<const double> variables, Jet& out, EvaluationFailure& failure) const noexcept {
  // Operands are written before they are read: to zero all takes longer than most formulas.
  alignas(Jet) std::byte room[depth * sizeof(Jet)];
  Jet* const stack = new (room) Jet;
  Jet* top = stack;  // one past the last operand
  for (const Instruction& instruction : program_) {
    switch (instruction.operation) {
      case Operation::push_time:
        *top++ = Jet::time(t);
        continue;
      case Operation::push_variable:
        *top++ = Jet::constant(variables[static_cast<std::size_t>(instruction.constant)]);
        continue;
      case Operation::push_constant:
        if (!std::isfinite(instruction.constant)) break;
        *top++ = Jet::constant(instruction.constant);
        continue;
      default:
        if (apply_quickly(instruction.operation, top)) continue;
    }
    Jet* const operands = top - operand_count(instruction.operation);
    if (!chooses_) {
      if (!apply(instruction, operands, failure)) return false;
    } else if (!apply_or_lack(instruction, operands, failure)) {
      operands[0] = Jet::constant(std::numeric_limits<double>::quiet_NaN());
    }
    top = operands + 1;
  }
  if (chooses_ && !stack[0].is_finite(derivatives_)) return false;
  out = stack[0];
  return true;
}

// What lacks a value makes what is formed of it lack one, until a choice leaves it out. The failure is the first.
bool Expression::apply_or_lack(const Instruction& instruction, Jet* operands,
                               EvaluationFailure& failure) const noexcept {
  const int counted = instruction.operation == Operation::choose ? 2 : operand_count(instruction.operation);
  for (int i = 0; i < counted; ++i) {
    if (std::isnan(operands[i].value)) return false;
  }
  EvaluationFailure own;
  if (apply(instruction, operands, own)) return true;
  if (*failure.id == '\0') failure = own;
  return false;
}

Expression Expression::part(std::size_t begin, std::size_t end) const {
  Expression part;
  part.program_.assign(program_.begin() + static_cast<std::ptrdiff_t>(begin),
                       program_.begin() + static_cast<std::ptrdiff_t>(end));
  part.stack_depth_ = stack_depth_;
  part.characters_ = characters_;
  part.derivatives_ = derivatives_;
  part.depends_on_time_ = true;
  part.chooses_ = chooses_;
  return part;
}

std::vector<Expression> Expression::time_parts() const {
  struct Value {
    std::size_t begin;
    bool of_time, of_variables;
  };
  std::vector<Expression> parts;
  std::vector<Value> stack;
  const auto take = [&](const Value& value, std::size_t end) {
    if (value.of_time && !value.of_variables) parts.push_back(part(value.begin, end));
  };
  for (std::size_t i = 0; i < program_.size(); ++i) {
    const Operation operation = program_[i].operation;
    const std::size_t first = stack.size() - static_cast<std::size_t>(operand_count(operation));
    Value made{i, operation == Operation::push_time, operation == Operation::push_variable};
    for (std::size_t k = first; k < stack.size(); ++k) {
      made = {std::min(made.begin, stack[k].begin), made.of_time || stack[k].of_time,
              made.of_variables || stack[k].of_variables};
    }
    for (std::size_t k = first; made.of_variables && k < stack.size(); ++k) {
      take(stack[k], k + 1 < stack.size() ? stack[k + 1].begin : i);
    }
    stack.resize(first);
    stack.push_back(made);
  }
  if (!stack.empty()) take(stack.front(), program_.size());
  return parts;
}

bool Expression::evaluate(double t, Jet& out, EvaluationFailure& failure) const noexcept {
  if (program_.size() == 1 && program_[0].operation == Operation::push_constant &&
      std::isfinite(program_[0].constant)) {
    out = Jet::constant(program_[0].constant);
    return true;
  }
  if (stack_depth_ <= shallow_stack) return run<shallow_stack>(t, {}, out, failure);
  return stack_depth_ <= usual_stack ? run<usual_stack>(t, {}, out, failure) : run<deepest_stack>(t, {}, out, failure);
}

double Expression::value(double t, std::span<const double> variables) const noexcept {
  Jet out;
  EvaluationFailure failure;
  const bool good = stack_depth_ <= usual_stack ? run<usual_stack>(t, variables, out, failure)
                                                : run<deepest_stack>(t, variables, out, failure);
  return good ? out.value : std::numeric_limits<double>::quiet_NaN();
}

void Expression::renumber(std::span<const int> to) {
  for (Instruction& instruction : program_) {
    if (instruction.operation == Operation::push_variable)
      instruction.constant = to[static_cast<std::size_t>(instruction.constant)];
  }
}

Quantity Expression::constant() const { return {program_.front().constant, kind_, dimension_}; }

void Expression::require(const Dimension& field) const {
  if (fits(kind_, dimension_, field)) return;
  throw ExpressionError("dimension-mismatch",
                        fmt::format("expected {}, but this is {}", dimension_name(field), dimension_name(dimension_)),
                        0, std::max(1, characters_), {},
                        field.dimensionless() ? "write a number without a unit, or an angle"
                                              : fmt::format("write a unit such as '{}'", si_unit(field)));
}

std::vector<std::string> referenced_parameters(std::string_view text) {
  std::vector<std::string> names;
  if (text.size() > longest_readable) return names;
  std::unordered_set<std::string> known;
  for (std::size_t at = text.find('$'); at != std::string_view::npos; at = text.find('$', at + 1)) {
    std::size_t begin = at + 1;
    if (begin < text.size() && text[begin] == '{') begin = skip_blanks(text, begin + 1);
    std::string name(text.substr(begin, word_end(text, begin) - begin));
    if (!name.empty() && known.insert(name).second) names.push_back(std::move(name));
  }
  return names;
}

}  // namespace freeplay
