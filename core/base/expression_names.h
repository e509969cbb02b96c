// ExpressionNames: the words that a formula may hold, and what to say about others.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "base/expression_operands.h"
#include "base/suggestion.h"
#include "base/token.h"

namespace freeplay {

class ExpressionNames : protected ExpressionOperands {
 public:
  static bool is_word(std::string_view word) { return word == "t" || word == "pi" || is_function(word); }

 protected:
  ExpressionNames(std::string_view text, const Scope& scope, const FormulaVariables* variables)
      : ExpressionOperands(text), scope_(scope), variables_(variables) {}

  std::optional<FormulaVariable> plain_variable(std::string_view name) const {
    return variables_ != nullptr && variables_->plain() ? variables_->find(name) : std::nullopt;
  }

  /// A name of no variable, or of one that cannot stand here.
  [[noreturn]] void fail_at_variable(std::string_view name, std::size_t begin, std::size_t end) {
    if (const auto refused = variables_->refusal(name)) {
      fail(refused->id.c_str(), begin, end, refused->message, {}, refused->remedy);
    }
    const std::string meant = variables_->nearest(name);
    fail("unknown-name", begin, end, fmt::format("unknown {} '{}'", variables_->word(), name), meant,
         meant.empty() || variables_->plain() ? variables_->known() : std::string());
  }

  /// A word that is no value: says what is missing around it.
  [[noreturn]] void fail_at_word(std::string_view name, std::size_t begin, std::size_t end) {
    fail_if_not_finite_word(begin, begin);
    const bool called = peek() == '(';
    if (is_function(name)) {
      fail("bad-expression", begin, end, fmt::format("'{}' needs its arguments in parentheses", name), {},
           name == "min" && !called ? "of revolutions per minute write 'rpm', of a minute '60 s'" : "");
    }
    if (is_unit_name(name) && !called) {
      const bool holds = variables_ != nullptr && variables_->plain();
      fail("bad-expression", begin, end, fmt::format("the unit '{}' needs a number before it", name), {},
           fmt::format("write '1 {}'{}", name, holds ? "; as variables " + variables_->known() : ""));
    }
    if (scope_.find(name) && !called) {
      fail("bad-expression", begin, end, fmt::format("'{}' is not a number", name), {},
           fmt::format("write '${}' for the parameter", name));
    }
    if (!called && variables_ != nullptr && variables_->plain()) fail_at_variable(name, begin, end);
    std::vector<std::string> known;
    for (const Function& function : functions) known.emplace_back(function.name);
    known.insert(known.end(), {std::string(trapezoid_name), std::string(s_curve_name)});
    if (!called) known.emplace_back("pi");
    fail("bad-expression", begin, end,
         called ? fmt::format("unknown function '{}'", name) : fmt::format("'{}' is not a number", name),
         suggestion(name, known).value_or(""), called || variables_ == nullptr ? "" : variables_->known());
  }

  const Scope& scope_;
  const FormulaVariables* variables_;  ///< null: there are none
};

}  // namespace freeplay
