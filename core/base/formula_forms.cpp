#include "base/formula_forms.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace freeplay {
namespace {

using Form = FormulaForms::Form;

constexpr int highest_degree = 10;  // of a polynomial that counts as smooth
constexpr Form no_form{0, std::numeric_limits<double>::infinity()};

Form bounded(const Form& form) { return form.degree > highest_degree ? no_form : form; }
Form sum(const Form& a, const Form& b) { return {std::max(a.degree, b.degree), std::max(a.rate, b.rate)}; }
Form product(const Form& a, const Form& b) { return bounded({a.degree + b.degree, a.rate + b.rate}); }

}  // namespace

FormulaForms::FormulaForms(const Expression& expression) : expression_(expression) {
  const std::size_t depth = static_cast<std::size_t>(expression.stack_depth_) + 1;
  stack_.reserve(depth), forms_.reserve(depth);
}

FormulaForms::Form FormulaForms::between(double low, double high) {
  Form first, second;
  const bool one = look(0.5 * (low + high), first), other = look(low + 0.381966 * (high - low), second);
  if (one && other) return sum(first, second);
  return one ? first : other ? second : no_form;
}

bool FormulaForms::look(double t, Form& form) {
  stack_.clear(), forms_.clear();
  EvaluationFailure failure;
  for (const Expression::Instruction& instruction : expression_.program_) {
    if (instruction.operation == Operation::push_time) {
      stack_.push_back(Jet::time(t));
      forms_.push_back({1, 0.0});
      continue;
    }
    const auto count = static_cast<std::size_t>(Expression::operand_count(instruction.operation));
    if (count == 0) stack_.emplace_back(), forms_.emplace_back();
    const std::size_t first = stack_.size() - std::max<std::size_t>(count, 1);
    Jet* const operands = stack_.data() + first;
    forms_[first] = of(instruction, operands, forms_.data() + first, std::max<std::size_t>(count, 1));
    if (!expression_.apply(instruction, operands, failure)) {
      if (!expression_.chooses_) return false;
      operands[0] = Jet::constant(std::numeric_limits<double>::quiet_NaN());  // a choice may leave it out
      forms_[first] = no_form;
    }
    stack_.resize(first + 1), forms_.resize(first + 1);
  }
  form = forms_.front();
  return true;
}

/// The form of what an operation makes of its operands.
FormulaForms::Form FormulaForms::of(const Expression::Instruction& instruction, const Jet* x, const Form* form,
                                    std::size_t count) const {
  const bool constant = std::all_of(form, form + count, [](const Form& f) { return f.constant(); });
  switch (instruction.operation) {
    case Operation::minimum:
    case Operation::maximum: {
      const bool second_is_less = less_from_right(x[1], x[0]);
      return form[second_is_less == (instruction.operation == Operation::minimum) ? 1 : 0];
    }
    case Operation::sign:
      return {};
    case Operation::choose: {
      const Jet over = Expression::margin(instruction.comparison(), x[0], x[1]);
      return form[over.value > 0.0 || (over.value == 0.0 && !Expression::is_strict(instruction.comparison())) ? 2 : 3];
    }
    case Operation::smooth:
      if (x[0].value <= x[1].value || x[0].value >= x[2].value) return {};
      if (!form[1].constant() || !form[2].constant()) return no_form;
      return bounded({5 * form[0].degree, 5.0 * form[0].rate});
    case Operation::absolute:
    case Operation::negate:
      return form[0];
    case Operation::add:
    case Operation::subtract:
      return sum(form[0], form[1]);
    case Operation::multiply:
      return product(form[0], form[1]);
    case Operation::divide:
      return form[1].constant() ? form[0] : no_form;
    case Operation::power_constant: {
      const double n = instruction.constant;
      if (constant) return {};
      if (!(n >= 0.0 && n <= highest_degree && n == std::floor(n))) return no_form;
      return bounded({form[0].degree * static_cast<int>(n), form[0].rate * n});
    }
    case Operation::sine:
    case Operation::cosine:
    case Operation::exponential:
      return form[0].polynomial(1) ? Form{0, std::abs(x[0].rate)} : no_form;
    default:
      return constant ? Form{} : no_form;
  }
}

bool FormulaForms::bends_without_bound(double corner, double by) const {
  Jet far, near;
  EvaluationFailure failure;
  return expression_.evaluate(corner + 1e-3 * by, far, failure) &&
         expression_.evaluate(corner + 1e-6 * by, near, failure) &&
         !(std::abs(near.acceleration) <= 4.0 * std::abs(far.acceleration));
}

}  // namespace freeplay
