#include "base/state_formula.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

#include "base/partials.h"

namespace freeplay {
namespace {

constexpr int shallow = 16, deepest = 5004;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double value_of(double x) { return x; }
template <class Number>
double value_of(const Number& x) {
  return x.value;
}
template <class Number>
double rate_of(const Number&) {
  return 0.0;
}
double rate_of(const Jet& x) { return x.rate; }

template <class Number>
Number constant(double x) {
  if constexpr (std::is_same_v<Number, double>) {
    return x;
  } else {
    return Number::constant(x);
  }
}

/// Variable `index`, or time where there is none.
template <class Number>
Number changing(double x, double rate, std::size_t index) {
  if constexpr (std::is_same_v<Number, double>) {
    return x;
  } else if constexpr (std::is_same_v<Number, Jet>) {
    return {x, rate, 0.0};
  } else {
    return Number::variable(x, index);
  }
}

constexpr std::size_t no_variable = std::numeric_limits<std::size_t>::max();

}  // namespace

StateFormula::StateFormula(const Expression& expression) : expression_(expression) {
  expression_.need(0);
  std::vector<char> stack;  // whether a value depends on a variable
  for (const Expression::Instruction& instruction : expression_.program_) {
    const auto count = static_cast<std::size_t>(Expression::operand_count(instruction.operation));
    const std::size_t first = stack.size() - count;
    bool depends = instruction.operation == Operation::push_variable;
    for (std::size_t k = first; k < stack.size(); ++k) depends = depends || stack[k] != 0;
    bool decides = false;
    switch (instruction.operation) {
      case Operation::absolute:
      case Operation::sign:
      case Operation::minimum:
      case Operation::maximum:
        decides = depends;
        break;
      case Operation::choose:
        decides = stack[first] != 0 || stack[first + 1] != 0;
        break;
      default:
        break;
    }
    if (decides) switch_at_.push_back(static_cast<int>(switch_of_.size()));
    switch_of_.push_back(decides ? switches_++ : -1);
    stack.resize(first);
    stack.push_back(depends ? 1 : 0);
  }
}

bool StateFormula::value(const Input& in, double& out, EvaluationFailure& failure) const noexcept {
  // Of a force most components are a plain number.
  const std::vector<Expression::Instruction>& program = expression_.program_;
  if (program.size() == 1 && program[0].operation == Operation::push_constant && std::isfinite(program[0].constant)) {
    out = program[0].constant;
    return true;
  }
  return run(in, {}, {}, out, failure);
}

double StateFormula::rate(const Input& in, std::span<const double> rates, double time_rate) const noexcept {
  Jet out;
  EvaluationFailure failure;
  return run(in, {rates, time_rate}, {}, out, failure) && std::isfinite(out.rate) ? out.rate : 0.0;
}

bool StateFormula::slopes(const Input& in, double& out, std::span<double> slopes,
                          EvaluationFailure& failure) const noexcept {
  const auto take = [&]<class Number>(Number found) {
    if (!run(in, {}, {}, found, failure)) return false;
    out = found.value;
    for (std::size_t k = 0; k < slopes.size(); ++k) slopes[k] = std::isfinite(found.slope[k]) ? found.slope[k] : 0.0;
    return true;
  };
  if (slopes.empty()) return take(Partials<0>{});
  if (slopes.size() == 1) return take(Partials<1>{});
  return slopes.size() == 2 ? take(Partials<2>{}) : take(Partials<most_slopes>{});
}

void StateFormula::decide(const Input& in, std::span<const double> rates, double time_rate, std::span<double> values,
                          std::span<double> rate) const noexcept {
  Jet out;
  EvaluationFailure failure;
  run(in, {rates, time_rate}, {values.data(), rate.data()}, out, failure);
}

void StateFormula::decide(const Input& in, std::span<double> values) const noexcept {
  double out = 0.0;
  EvaluationFailure failure;
  std::ranges::fill(values, nan);
  run(in, {}, {values.data(), nullptr}, out, failure);
}

double StateFormula::side_at_zero(int index, double rate) const {
  if (rate != 0.0) return rate > 0.0 ? 1.0 : -1.0;
  const Expression::Instruction& instruction =
      expression_.program_[static_cast<std::size_t>(switch_at_[static_cast<std::size_t>(index)])];
  return instruction.operation == Operation::choose && Expression::is_strict(instruction.comparison()) ? -1.0 : 1.0;
}

template <class Number>
bool StateFormula::run(const Input& in, const Change& change, const Decided& decided, Number& out,
                       EvaluationFailure& failure) const noexcept {
  const auto run_from = [&](const Input& from) {
    return expression_.stack_depth_ <= shallow ? run_in<Number, shallow>(from, change, decided, out, failure)
                                               : run_in<Number, deepest>(from, change, decided, out, failure);
  };
  if (run_from(in)) return true;
  // A form need not have a value beyond its switch, as the root in sqrt(max(0, x)) has none; the formula itself may.
  return in.sides != nullptr && decided.values == nullptr && run_from({in.t, in.variables, nullptr});
}

// What has no value is NaN, which all that is made of it is, too; so only the end need be looked at.
template <class Number, int depth>
bool StateFormula::run_in(const Input& in, const Change& change, const Decided& decided, Number& out,
                          EvaluationFailure& failure) const noexcept {
  Number stack[depth];
  Number* top = stack;  // one past the last operand
  failure = {};
  const Expression::Instruction* const program = expression_.program_.data();
  const bool decides_alone = decided.values != nullptr && !switch_at_.empty();
  const std::size_t count = decides_alone ? static_cast<std::size_t>(switch_at_.back()) + 1 : switch_of_.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Expression::Instruction& instruction = program[i];
    switch (instruction.operation) {
      case Operation::push_time:
        *top++ = changing<Number>(in.t, change.time_rate, no_variable);
        continue;
      case Operation::push_variable: {
        const auto k = static_cast<std::size_t>(instruction.constant);
        *top++ = changing<Number>(in.variables[k], change.rates.empty() ? 0.0 : change.rates[k], k);
        continue;
      }
      case Operation::push_constant:
        *top++ = constant<Number>(instruction.constant);
        continue;
      case Operation::negate:
        top[-1] = -top[-1];
        continue;
      case Operation::add:
        --top;
        top[-1] = top[-1] + top[0];
        continue;
      case Operation::subtract:
        --top;
        top[-1] = top[-1] - top[0];
        continue;
      case Operation::multiply:
        --top;
        top[-1] = top[-1] * top[0];
        continue;
      default:
        break;
    }
    Number* const operands = top - Expression::operand_count(instruction.operation);
    if (switch_of_[i] >= 0) {
      apply_switch(i, in, decided, operands);
    } else {
      apply(instruction, operands, failure);
    }
    top = operands + 1;
  }
  out = stack[0];
  if (std::isfinite(value_of(out))) return true;
  if (*failure.id == '\0') failure = {"bad-number", "the result is not finite", 0, expression_.characters_};
  return false;
}

// Of what most formulas are made of, where it is defined: without the derivatives that a jet brings. Else NaN.
double StateFormula::usual_value(const Expression::Instruction& instruction, const double* operands) noexcept {
  const double x = operands[0];
  switch (instruction.operation) {
    case Operation::divide:
      return x / operands[1];
    case Operation::power_constant:
      return x == 0.0 ? nan : std::pow(x, instruction.constant);
    case Operation::root:
      return x > 0.0 ? std::sqrt(x) : nan;
    case Operation::sine:
      return std::sin(x);
    case Operation::cosine:
      return std::cos(x);
    case Operation::exponential:
      return std::exp(x);
    default:
      return nan;
  }
}

template <class Number>
void StateFormula::apply(const Expression::Instruction& instruction, Number* operands,
                         EvaluationFailure& failure) const noexcept {
  if constexpr (std::is_same_v<Number, double>) {
    const double usual = usual_value(instruction, operands);
    if (std::isfinite(usual)) {
      operands[0] = usual;
      return;
    }
    Jet jets[4];
    for (int k = 0; k < Expression::operand_count(instruction.operation); ++k) jets[k] = Jet::constant(operands[k]);
    operands[0] = expression_.apply_or_lack(instruction, jets, failure) ? jets[0].value : nan;
  } else if constexpr (!std::is_same_v<Number, Jet>) {
    if (instruction.operation == Operation::divide && operands[1].value != 0.0) {
      operands[0] = operands[0] / operands[1];
    } else if (instruction.operation == Operation::power_constant && operands[0].value > 0.0) {
      operands[0] = pow(operands[0], instruction.constant);
    } else {
      differentiate(instruction, operands, failure);
    }
  } else {
    if (!expression_.apply_or_lack(instruction, operands, failure)) operands[0] = constant<Number>(nan);
  }
}

// By one jet along each operand.
template <class Number>
void StateFormula::differentiate(const Expression::Instruction& instruction, Number* operands,
                                 EvaluationFailure& failure) const noexcept {
  const int count = Expression::operand_count(instruction.operation);
  Number out = constant<Number>(nan);
  for (int along = 0; along < count; ++along) {
    if (along > 0 && !operands[along].changes()) continue;
    Jet jets[4];
    for (int k = 0; k < count; ++k) jets[k] = {operands[k].value, k == along ? 1.0 : 0.0, 0.0};
    if (!expression_.apply_or_lack(instruction, jets, failure)) break;
    if (along == 0) out = constant<Number>(jets[0].value);
    out = out + Number::chain(0.0, jets[0].rate, operands[along]);
  }
  operands[0] = out;
}

template <class Number>
void StateFormula::apply_switch(std::size_t instruction, const Input& in, const Decided& decided,
                                Number* operands) const noexcept {
  const Expression::Instruction& what = expression_.program_[instruction];
  const auto index = static_cast<std::size_t>(switch_of_[instruction]);
  Number decides = operands[0];
  if (what.operation == Operation::minimum || what.operation == Operation::maximum) decides = operands[0] - operands[1];
  if (what.operation == Operation::choose) decides = Expression::margin(what.comparison(), operands[0], operands[1]);
  const double here = value_of(decides);
  if (decided.values != nullptr) {
    decided.values[index] = here;
    if (decided.rates != nullptr) decided.rates[index] = rate_of(decides);
  }
  double side = in.sides == nullptr ? 0.0 : in.sides[index];
  if (side == 0.0) side = here > 0.0 ? 1.0 : here < 0.0 ? -1.0 : 0.0;
  if (std::isnan(here)) {
    operands[0] = decides;
    return;
  }
  switch (what.operation) {
    case Operation::absolute:
      if (side < 0.0) operands[0] = -operands[0];
      return;
    case Operation::sign:
      operands[0] = constant<Number>(side);
      return;
    case Operation::minimum:
      if (side > 0.0) operands[0] = operands[1];
      return;
    case Operation::maximum:
      if (side < 0.0) operands[0] = operands[1];
      return;
    default:
      operands[0] = operands[side > 0.0 || (side == 0.0 && !Expression::is_strict(what.comparison())) ? 2 : 3];
  }
}

}  // namespace freeplay
