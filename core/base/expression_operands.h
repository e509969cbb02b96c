// ExpressionOperands: the functions of formulas and what is known of values while a formula is read: their kinds and
// dimensions, by section 1.5 of the model format.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "base/expression.h"
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
               fmt::format("'{}' needs an angle or a number, but this is {}", function.name,
                           dimension_name(result.dimension)));
        }
    }
    result.kind = DimensionKind::plain;
    result.dimension = {};
    return result;
  }
};

}  // namespace freeplay
