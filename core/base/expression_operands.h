// ExpressionOperands: the functions of formulas and the program that is made of one, with what is known of the values
// on its stack: their kinds and dimensions, by section 1.5 of the model format.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "base/expression.h"
#include "base/expression_error.h"
#include "base/expression_text.h"

namespace freeplay {

class ExpressionOperands : protected ExpressionText {
 protected:
  using ExpressionText::ExpressionText;
  using Operation = Expression::Operation;

  /// What is known of a value on the stack; [begin, end) are bytes of the text.
  struct Operand {
    DimensionKind kind = DimensionKind::plain;
    Dimension dimension{};
    bool depends_on_time = false;
    std::size_t begin = 0, end = 0;

    bool dimensioned() const { return kind == DimensionKind::dimensioned; }
  };

  struct Function {
    std::string_view name;
    Operation operation;
    int least, most;  // number of arguments
  };

  static constexpr int any_number = 1 << 20;
  static constexpr std::array<Function, 16> functions = {{
      {"sin", Operation::sine, 1, 1},
      {"cos", Operation::cosine, 1, 1},
      {"tan", Operation::tangent, 1, 1},
      {"asin", Operation::arcsine, 1, 1},
      {"acos", Operation::arccosine, 1, 1},
      {"sqrt", Operation::root, 1, 1},
      {"exp", Operation::exponential, 1, 1},
      {"log", Operation::logarithm, 1, 1},
      {"tanh", Operation::hyperbolic_tangent, 1, 1},
      {"abs", Operation::absolute, 1, 1},
      {"sign", Operation::sign, 1, 1},
      {"if", Operation::choose, 3, 3},
      {"atan2", Operation::arctangent2, 2, 2},
      {"min", Operation::minimum, 2, any_number},
      {"max", Operation::maximum, 2, any_number},
      {"smooth", Operation::smooth, 3, 3},
  }};

  static const Function* find_function(std::string_view name) {
    const auto found = std::find_if(functions.begin(), functions.end(), [&](const auto& f) { return f.name == name; });
    return found == functions.end() ? nullptr : &*found;
  }

  static constexpr std::string_view trapezoid_name = "trapezoid", s_curve_name = "s_curve";
  static bool is_speed_law(std::string_view name) { return name == trapezoid_name || name == s_curve_name; }
  static bool is_function(std::string_view name) { return find_function(name) != nullptr || is_speed_law(name); }

  static Operand join(const Operand& left, const Operand& right) {
    Operand result;
    result.depends_on_time = left.depends_on_time || right.depends_on_time;
    result.begin = left.begin;
    result.end = right.end;
    return result;
  }

  /// Operands that are added or compared.
  Operand agree(const Operand& left, const Operand& right) const {
    if (left.dimensioned() && right.dimensioned() && !(left.dimension == right.dimension)) {
      fail("dimension-mismatch", left.begin, right.end,
           fmt::format("{} and {} cannot be added or compared", dimension_name(left.dimension),
                       dimension_name(right.dimension)));
    }
    Operand result = join(left, right);
    const Operand& leading = left.kind >= right.kind ? left : right;  // plain < free < dimensioned
    result.kind = leading.kind;
    result.dimension = leading.dimension;
    return result;
  }

  Operand call_result(const Function& function, const std::vector<Operand>& arguments) const {
    Operand result = arguments.front();
    switch (function.operation) {
      case Operation::absolute:
        return result;
      case Operation::sign:
        break;
      case Operation::root:
        result.dimension = power(result.dimension, 0.5);
        return result;
      case Operation::arctangent2:
      case Operation::smooth:
        for (std::size_t i = 1; i < arguments.size(); ++i) result = agree(result, arguments[i]);
        break;
      default:
        if (result.dimensioned() && !result.dimension.dimensionless()) {
          fail("dimension-mismatch", result.begin, result.end,
               fmt::format("'{}' needs an angle or a number, but this is {}; divide it by a {} to make it a number",
                           function.name, dimension_name(result.dimension), dimension_name(result.dimension)));
        }
    }
    result.kind = DimensionKind::plain;
    result.dimension = {};
    return result;
  }

  // --- program

  Operand raise(const Operand& base, const Operand& exponent, std::size_t caret) {
    if (exponent.dimensioned()) {
      fail("dimension-mismatch", exponent.begin, exponent.end, "an exponent must be a number without a unit");
    }
    const bool plain = exponent.kind == DimensionKind::plain;
    if (base.dimensioned() && (!plain || exponent.depends_on_time)) {
      fail("dimension-mismatch", exponent.begin, exponent.end,
           "the exponent of a value with a unit must consist of numbers");
    }
    Operand result = join(base, exponent);
    result.kind = plain ? base.kind : DimensionKind::free;
    if (exponent.depends_on_time) return emit(Operation::power, result, caret, caret + 1);
    const double n = expression_.program_.back().constant;
    if (base.dimensioned()) result.dimension = power(base.dimension, n);
    pop();
    return emit(Operation::power_constant, result, caret, caret + 1, n);
  }

  void push(double constant, std::size_t begin, std::size_t end) {
    append({Operation::push_constant, constant, characters(0, begin), characters(begin, end)});
  }

  void pop() {
    expression_.program_.pop_back();
    --depth_;
  }

  /// Appends an operation on the values at the top of the stack, or its result when they are constant.
  Operand emit(Operation operation, const Operand& result, std::size_t begin, std::size_t end, double constant = 0.0) {
    const Expression::Instruction instruction{operation, constant, characters(0, begin), characters(begin, end)};
    if (result.depends_on_time) {
      append(instruction);
      return result;
    }
    // A constant operand is always a single push, so the operands are the last instructions.
    const int count = Expression::operand_count(operation);
    std::array<Jet, 4> operands{};
    for (int i = count; i-- > 0; pop()) {
      operands[static_cast<std::size_t>(i)] = Jet::constant(expression_.program_.back().constant);
    }
    EvaluationFailure failure;
    if (!expression_.apply(instruction, operands.data(), failure)) {
      throw ExpressionError(failure.id, failure.reason, failure.offset, failure.length);
    }
    append({Operation::push_constant, operands[0].value, instruction.offset, instruction.length});
    return result;
  }

  void append(const Expression::Instruction& instruction) {
    expression_.program_.push_back(instruction);
    depth_ += 1 - Expression::operand_count(instruction.operation);
    expression_.stack_depth_ = std::max(expression_.stack_depth_, depth_);
  }

  int depth_ = 0;  ///< of the stack
  Expression expression_;
};

}  // namespace freeplay
