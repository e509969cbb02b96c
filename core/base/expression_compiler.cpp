// Reads the grammar of the model format, section 1.4, and checks dimensions by section 1.5. Each rule of the grammar is
// one function; it leaves one value on the program's stack and returns what is known of it.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/expression.h"
#include "base/expression_names.h"
#include "base/speed_law.h"
#include "base/suggestion.h"
#include "base/text.h"
#include "base/token.h"

namespace freeplay {

class ExpressionCompiler : ExpressionNames {
 public:
  ExpressionCompiler(std::string_view text, const Scope& scope, bool time_allowed, const FormulaVariables* variables)
      : ExpressionNames(text, scope, variables), time_allowed_(time_allowed) {}

  Expression compile() {
    expression_.characters_ = character_count(text_);
    if (expression_.characters_ > longest) fail("bad-expression", 0, 0, "an expression has at most 10 000 characters");
    if (skip_blanks(text_, 0) == text_.size()) fail("bad-expression", 0, 0, "a number or expression is missing");
    const Operand result = sum();
    if (peek() != '\0') fail_at_rest();
    expression_.depends_on_time_ = result.depends_on_time;
    expression_.kind_ = result.kind;
    expression_.dimension_ = result.dimension;
    return std::move(expression_);
  }

 private:
  using Operation = Expression::Operation;

  static constexpr int longest = 10000;
  static constexpr std::size_t longest_of_law = 200;  ///< instructions, which stand in it some ten times

  // --- grammar

  Operand sum() {
    Operand left = product();
    while (peek() == '+' || peek() == '-') {
      const std::size_t sign = position_++;
      const Operand right = product();
      const auto operation = text_[sign] == '+' ? Operation::add : Operation::subtract;
      left = emit(operation, agree(left, right), sign, sign + 1);
    }
    return left;
  }

  Operand product() {
    Operand left = signed_power();
    while (peek() == '*' || peek() == '/') {
      const std::size_t sign = position_++;
      const Operand right = signed_power();
      const bool times = text_[sign] == '*';
      Operand result = join(left, right);
      if (left.kind == DimensionKind::free || right.kind == DimensionKind::free) {
        result.kind = DimensionKind::free;
      } else if (left.dimensioned() || right.dimensioned()) {
        result.kind = DimensionKind::dimensioned;
        result.dimension = times ? left.dimension * right.dimension : left.dimension / right.dimension;
      }
      left = emit(times ? Operation::multiply : Operation::divide, result, sign, sign + 1);
    }
    return left;
  }

  /// unary and power of the grammar. A chain such as -a^-b^c is collected first and applied from the right, so that
  /// thousands of signs or powers need no recursion.
  Operand signed_power() {
    struct Link {
      Operand operand;
      bool negative;
      std::size_t sign, caret;
    };
    std::vector<Link> chain;
    for (bool more = true; more;) {
      Link link{{}, false, 0, 0};
      while (peek() == '+' || peek() == '-') {
        link.sign = position_;
        link.negative ^= text_[position_++] == '-';
      }
      link.operand = postfix();
      more = peek() == '^';
      if (more) link.caret = position_++;
      chain.push_back(link);
    }
    Operand result = chain.back().operand;
    for (std::size_t i = chain.size(); i-- > 0;) {
      const Link& link = chain[i];
      if (i + 1 < chain.size()) result = raise(link.operand, result, link.caret);
      if (link.negative) {
        result.begin = link.sign;
        result = emit(Operation::negate, result, link.sign, link.sign + 1);
      }
    }
    return result;
  }

  Operand postfix() {
    peek();
    const std::size_t begin = position_;
    if (const std::size_t end = number_end(text_, begin); end > begin) return number(begin, end);
    const char c = peek();
    if (c == '(') return group();
    if (c == '$') return without_unit(parameter());
    if (c == '[' && variables_ != nullptr) return without_unit(bracket());
    if (word_end(text_, begin) > begin) return without_unit(word());
    if (c == '.') fail_if_not_finite_word(begin + 1, begin);
    fail_at_rest();
  }

  Operand number(std::size_t begin, std::size_t end) {
    const double value = number_value(text_.substr(begin, end - begin));
    if (!std::isfinite(value)) fail("bad-number", begin, end, "the number is too large");
    refuse_other_notations(begin, end);
    position_ = end;
    Operand operand;
    operand.begin = begin;
    operand.end = end;
    push(value, begin, end);
    return with_unit(operand);
  }

  Operand group() {
    const std::size_t open = position_;
    enter(open);
    Operand operand = sum();
    if (peek() == ',') fail_at_comma();
    leave(open);
    operand.begin = open;
    operand.end = position_;
    return with_unit(operand);
  }

  Operand parameter() {
    const std::size_t begin = position_++;
    const bool braced = position_ < text_.size() && text_[position_] == '{';
    if (braced) position_ = skip_blanks(text_, position_ + 1);
    const std::size_t name_begin = position_;
    position_ = word_end(text_, position_);
    const std::string_view name = text_.substr(name_begin, position_ - name_begin);
    if (name.empty()) fail("bad-expression", begin, begin + 1, "a parameter name must follow '$'");
    if (braced) {
      if (peek() != '}') fail("bad-expression", begin, position_, "this '${' has no '}'");
      ++position_;
    }
    const Quantity* const found = scope_.find(name);
    if (!found) {
      const bool builtin = name == "t" || name == "pi";
      fail("unknown-name", begin, position_, fmt::format("unknown parameter '{}'", name),
           builtin ? "" : suggestion(name, scope_.names()).value_or(""),
           builtin ? fmt::format("write '{}' without '$'", name) : "");
    }
    Operand operand;
    operand.kind = found->kind == DimensionKind::dimensioned ? DimensionKind::dimensioned : DimensionKind::free;
    if (operand.dimensioned()) operand.dimension = found->dimension;
    operand.begin = begin;
    operand.end = position_;
    push(found->value, begin, position_);
    return operand;
  }

  /// [name], or [number]: a number that fits any unit, as a parameter without one does.
  Operand bracket() {
    const std::size_t begin = position_, first = skip_blanks(text_, begin + 1), end = number_end(text_, first);
    if (end == first || skip_blanks(text_, end) == text_.size() || text_[skip_blanks(text_, end)] != ']') {
      return variable();
    }
    position_ = skip_blanks(text_, end) + 1;
    Operand operand;
    operand.kind = DimensionKind::free;
    operand.begin = begin;
    operand.end = position_;
    push(number_value(text_.substr(first, end - first)), begin, position_);
    return operand;
  }

  Operand variable() {
    const std::size_t begin = position_, close = text_.find(']', begin);
    if (close == std::string_view::npos) fail("bad-expression", begin, begin + 1, "this '[' has no ']'");
    const std::string_view name = text_.substr(begin + 1, close - begin - 1);
    position_ = close + 1;
    const std::optional<FormulaVariable> found = variables_->find(name);
    if (!found) fail_at_variable(name, begin + 1, close);
    return push_variable(*found, begin);
  }
  /// The variable whose name ends at position_.
  Operand push_variable(const FormulaVariable& variable, std::size_t begin) {
    expression_.depends_on_variables_ = true;
    const Operand operand{variable.kind, variable.dimension, true, begin, position_};
    return emit(Operation::push_variable, operand, begin, position_, variable.index);
  }

  /// A name with dots, such as body.ram.vx.
  bool begins_channel(std::size_t begin, std::size_t end) const {
    if (end + 1 >= text_.size() || text_[end] != '.' || word_end(text_, end + 1) == end + 1) return false;
    return variables_ != nullptr || is_channel_kind(text_.substr(begin, end - begin));
  }
  static bool is_channel_kind(std::string_view word) {
    constexpr std::array kinds{"body", "joint", "frame", "driver", "force", "energy", "output"};
    return std::ranges::find(kinds, word) != kinds.end();
  }

  /// Names of things may hold '-' and '/': the longest name that is known counts.
  Operand channel(std::size_t begin) {
    std::size_t end = begin, plain = 0;
    for (int dots = 0; end < text_.size();) {
      const char c = text_[end];
      // KIND.NAME.QUANTITY may end there.
      if ((c == '-' || c == '/') && plain == 0 && dots >= 2) plain = end;
      dots += c == '.' ? 1 : 0;
      const bool sign = c == '-' || c == '/' || c == '.' || (c >= '0' && c <= '9');
      const std::size_t next = sign ? end + 1 : word_end(text_, end);
      if (next == end) break;
      end = next;
    }
    if (plain == 0) plain = end;
    if (variables_ == nullptr) {
      position_ = plain;
      fail("state-not-allowed", begin, plain,
           fmt::format("'{}' is a value of the motion, which is not allowed here", text_.substr(begin, plain - begin)));
    }
    std::optional<FormulaVariable> found;
    std::size_t last = end;
    while (!(found = variables_->find(text_.substr(begin, last - begin))) && last > plain) {
      do {
        --last;
      } while (last > plain && text_[last] != '-' && text_[last] != '/');
    }
    if (!found) fail_at_variable(text_.substr(begin, plain - begin), begin, plain);
    position_ = last;
    return push_variable(*found, begin);
  }

  /// if(l > r, a, b)
  Operand choice(std::size_t begin) {
    const std::size_t open = position_;
    enter(open);
    const Operand left = sum();
    const char sign = peek();
    if (sign != '<' && sign != '>') {
      fail("bad-expression", left.begin, std::max(position_, left.begin + 1),
           "'if' begins with a comparison by <, <=, > or >=");
    }
    const bool greater = sign == '>';
    ++position_;
    const bool equal = position_ < text_.size() && text_[position_] == '=';
    if (equal) ++position_;
    const auto comparison = greater ? (equal ? Expression::Comparison::at_least : Expression::Comparison::greater)
                                    : (equal ? Expression::Comparison::at_most : Expression::Comparison::less);
    const Operand right = sum();
    const Operand compared = agree(left, right);
    std::array<Operand, 2> ways;
    for (Operand& way : ways) {
      if (peek() != ',') fail("bad-expression", begin, position_, "'if' needs a comparison and two values");
      ++position_;
      way = sum();
    }
    if (peek() == ',') fail_at_comma();
    leave(open);
    Operand result = agree(ways[0], ways[1]);
    result.depends_on_time = result.depends_on_time || compared.depends_on_time;
    result.begin = begin;
    result.end = position_;
    expression_.chooses_ = true;
    return emit(Operation::choose, result, begin, begin + 2, static_cast<double>(comparison));
  }

  Operand word() {
    const std::size_t begin = position_, end = word_end(text_, begin);
    const std::string_view name = text_.substr(begin, end - begin);
    position_ = end;
    if (begins_channel(begin, end)) return channel(begin);
    if (const Function* function = find_function(name); function && peek() == '(') {
      return function->operation == Operation::choose ? choice(begin) : call(*function, begin);
    }
    if (is_speed_law(name) && peek() == '(') return travel(name, begin);
    Operand operand;
    operand.begin = begin;
    operand.end = end;
    if (name == "pi") {
      push(3.14159265358979323846, begin, end);
      return operand;
    }
    if (const auto known = plain_variable(name)) return push_variable(*known, begin);
    if (name != "t") fail_at_word(name, begin, end);
    if (!time_allowed_) {
      fail("time-not-allowed", begin, end,
           variables_ == nullptr ? "'t' is not allowed here: the value must be constant" : "'t' is not allowed here",
           {}, variables_ == nullptr ? "" : variables_->known());
    }
    operand.kind = DimensionKind::free;
    operand.depends_on_time = true;
    return emit(Operation::push_time, operand, begin, end);
  }

  Operand call(const Function& function, std::size_t begin) {
    const std::size_t open = position_, name_end = begin + function.name.size();
    enter(open);
    const bool folds = function.most == any_number;  // min and max take any number of arguments, two at a time
    std::vector<Operand> arguments;
    for (bool more = true; more;) {
      const Operand argument = sum();
      if (folds && !arguments.empty()) {
        arguments.front() = emit(function.operation, agree(arguments.front(), argument), begin, name_end);
      }
      arguments.push_back(argument);
      more = peek() == ',';
      if (more && static_cast<int>(arguments.size()) == function.most) fail_at_comma();
      if (more) ++position_;
    }
    leave(open);
    if (static_cast<int>(arguments.size()) < function.least) {
      fail("bad-expression", begin, position_,
           fmt::format("'{}' needs {}{} arguments", function.name, folds ? "at least " : "", function.least));
    }
    Operand result = folds ? arguments.front() : call_result(function, arguments);
    result.begin = begin;
    result.end = position_;
    return folds ? result : emit(function.operation, result, begin, name_end);
  }

  /// trapezoid(x, start, end, ramp) and s_curve(x, start, end, ramp, rise): x is copied to wherever the law needs it.
  Operand travel(std::string_view name, std::size_t begin) {
    const auto first = static_cast<std::ptrdiff_t>(expression_.program_.size());
    const std::vector<Operand> arguments = law_arguments(name, begin);
    const SpeedLaw law = speed_law(name, arguments);
    const std::vector<Expression::Instruction> x(expression_.program_.begin() + first, expression_.program_.end());
    expression_.program_.erase(expression_.program_.begin() + first, expression_.program_.end());
    --depth_;
    if (x.size() > longest_of_law) fail("bad-expression", begin, position_, "what this function is of is too long");
    const std::size_t end = begin + name.size();
    constexpr std::array operation_of{Operation::minimum, Operation::maximum, Operation::subtract, Operation::multiply,
                                      Operation::add};
    for (const auto& [step, constant] : law.program()) {
      if (step == SpeedLaw::Step::argument) {
        for (const Expression::Instruction& instruction : x) append(instruction);
      } else if (step == SpeedLaw::Step::constant) {
        push(constant, begin, end);
      } else {
        emit(operation_of[static_cast<std::size_t>(step)], arguments.front(), begin, end);
      }
    }
    Operand result;
    result.depends_on_time = arguments.front().depends_on_time;
    result.begin = begin;
    result.end = position_;
    return result;
  }

  /// The first may depend on time, the others are constant: each is one push.
  std::vector<Operand> law_arguments(std::string_view name, std::size_t begin) {
    const std::size_t open = position_, most = name == s_curve_name ? 5 : 4;
    enter(open);
    std::vector<Operand> arguments;
    Operand all;
    for (bool more = true; more;) {
      arguments.push_back(sum());
      const Operand& argument = arguments.back();
      all = arguments.size() > 1 ? agree(all, argument) : argument;
      if (arguments.size() > 1 && argument.depends_on_time) {
        fail("bad-expression", argument.begin, argument.end,
             fmt::format("what follows the first argument of '{}' must be constant", name));
      }
      more = peek() == ',';
      if (more && arguments.size() == most) fail_at_comma();
      if (more) ++position_;
    }
    leave(open);
    if (arguments.size() >= 4) return arguments;
    fail("bad-expression", begin, position_, fmt::format("'{}' needs 4{} arguments", name, most == 5 ? " or 5" : ""));
  }

  /// By the constants at the end of the program, which are taken off.
  SpeedLaw speed_law(std::string_view name, const std::vector<Operand>& arguments) {
    std::array<double, 4> numbers{};
    for (std::size_t i = arguments.size() - 1; i-- > 0; pop()) numbers[i] = expression_.program_.back().constant;
    const bool curved = name == s_curve_name;
    if (curved && arguments.size() < 5) numbers[3] = 0.5 * numbers[2];
    const SpeedLaw law{numbers[0], numbers[1], numbers[2], numbers[3]};
    if (const std::optional<SpeedLaw::Flaw> flaw = law.flaw(curved)) {
      const Operand& wrong = arguments[std::min(flaw->which + 1, arguments.size() - 1)];
      fail("bad-expression", wrong.begin, wrong.end, fmt::format("{}: {}", name, flaw->reason));
    }
    return law;
  }

  // --- units

  /// The operand with the unit that may follow it.
  Operand with_unit(const Operand& operand) {
    peek();
    const std::size_t begin = position_, end = word_end(text_, begin);
    if (end == begin) return operand;
    const std::string_view name = text_.substr(begin, end - begin);
    if (name == "t" || name == "pi" || is_function(name)) fail_at_rest();
    if (operand.dimensioned()) fail("bad-unit", begin, end, "what is in the parentheses has a unit already");
    const Unit unit = parse_unit_at(text_, position_);
    Operand result = operand;
    result.end = position_;
    if (operand.kind == DimensionKind::plain) {
      result.kind = DimensionKind::dimensioned;
      result.dimension = unit.dimension;
    }
    push(unit.factor, begin, position_);
    return emit(Operation::multiply, result, operand.begin, position_);
  }

  Operand without_unit(const Operand& operand) {
    peek();
    const std::size_t end = word_end(text_, position_);
    const std::string_view name = text_.substr(position_, end - position_);
    if (is_unit_name(name)) {
      fail("bad-expression", position_, end, "a unit may follow only a number or a group in parentheses", {},
           fmt::format("write '* 1 {}'", name));
    }
    return operand;
  }

  bool time_allowed_;
};

bool is_formula_word(std::string_view word) { return ExpressionNames::is_word(word); }

Expression Expression::compile(std::string_view text, const Scope& scope, bool time_allowed) {
  return ExpressionCompiler(text, scope, time_allowed, nullptr).compile();
}

Expression Expression::compile(std::string_view text, const Scope& scope, bool time_allowed,
                               const FormulaVariables& variables) {
  Expression expression = ExpressionCompiler(text, scope, time_allowed, &variables).compile();
  expression.need(0);
  return expression;
}

}  // namespace freeplay
