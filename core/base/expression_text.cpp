#include "base/expression_text.h"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/expression_error.h"
#include "base/text.h"
#include "base/token.h"
#include "base/unit.h"

namespace freeplay {

char ExpressionText::peek() {
  position_ = skip_blanks(text_, position_);
  return position_ < text_.size() ? text_[position_] : '\0';
}

int ExpressionText::characters(std::size_t begin, std::size_t end) {
  if (begin > 0) return character_count(text_.substr(begin, end - begin));
  if (end < counted_bytes_) {
    counted_ -= character_count(text_.substr(end, counted_bytes_ - end));
  } else {
    counted_ += character_count(text_.substr(counted_bytes_, end - counted_bytes_));
  }
  counted_bytes_ = end;
  return counted_;
}

void ExpressionText::enter(std::size_t open) {
  position_ = open + 1;
  // No single parenthesis is to blame.
  if (++nesting_ > deepest) fail("bad-expression", 0, text_.size(), "parentheses are nested more than 256 deep");
}

void ExpressionText::leave(std::size_t open) {
  const char c = peek();
  if (c == '\0') fail("bad-expression", open, open + 1, "this '(' is never closed", {}, "add the missing ')'");
  if (c != ')') fail_at_rest();
  ++position_;
  --nesting_;
}

void ExpressionText::fail(const char* id, std::size_t begin, std::size_t end, std::string message, std::string nearest,
                          std::string hint) const {
  begin = std::min(begin, text_.size());
  const int length = end > begin ? character_count(text_.substr(begin, end - begin)) : 1;
  throw ExpressionError(id, std::move(message), character_count(text_.substr(0, begin)), std::max(1, length),
                        std::move(nearest), std::move(hint));
}

void ExpressionText::fail_at_rest() {
  const char c = peek();
  const std::size_t begin = position_;
  if (c == '\0') fail("bad-expression", begin, begin, "the expression ends too early");
  if (c == ',') fail_at_comma();
  const std::size_t end = std::max(word_end(text_, begin), number_end(text_, begin));
  const bool operand_missing = c == ')' || c == '*' || c == '/' || c == '^';
  const std::size_t after = skip_blanks(text_, end);
  const bool called = after < text_.size() && text_[after] == '(';
  if (std::string hint = hint_for_foreign_unit(text_.substr(begin, end - begin)); !hint.empty() && !called)
    fail("bad-unit", begin, end, fmt::format("'{}' is not a unit", text_.substr(begin, end - begin)), {},
         std::move(hint));
  if (text_.substr(begin).starts_with("1/min"))
    fail("bad-unit", begin, begin + 5, "'1/min' is not a unit", {}, "write 'rpm'");
  if (!operand_missing && (end > begin || c == '$' || c == '(')) {
    fail("bad-expression", begin, end, "an operator is missing here", {}, "write '*' to multiply");
  }
  const std::size_t length = std::max<std::size_t>(1, character_bytes(text_, begin));
  const std::string_view found = text_.substr(begin, length);
  if (found == "\u2212") fail("bad-expression", begin, begin + length, "unexpected '\u2212'", {}, "write '-'");
  fail("bad-expression", begin, begin + length, fmt::format("unexpected '{}'", found));
}

void ExpressionText::fail_at_comma() {
  const auto digit = [&](std::size_t i) { return i < text_.size() && text_[i] >= '0' && text_[i] <= '9'; };
  const bool decimal = position_ > 0 && digit(position_ - 1) && digit(position_ + 1);
  if (!decimal) fail("bad-expression", position_, position_ + 1, "unexpected ','");
  std::size_t begin = position_, end = position_ + 1;
  while (begin > 0 && (digit(begin - 1) || text_[begin - 1] == '.')) --begin;
  while (digit(end)) ++end;
  fail("bad-expression", begin, end, "a ',' cannot stand inside a number", {}, "write a decimal point, as in '0.5'");
}

void ExpressionText::fail_if_not_finite_word(std::size_t word_begin, std::size_t begin) const {
  const std::size_t end = word_end(text_, word_begin);
  std::string lower(text_.substr(word_begin, end - word_begin));
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  if (lower == "inf" || lower == "infinity" || lower == "nan") {
    fail("bad-number", begin, end, "a number must be finite");
  }
}

void ExpressionText::refuse_other_notations(std::size_t begin, std::size_t end) const {
  const std::size_t rest = word_end(text_, end);
  if (rest == end) return;
  if (text_[end] == '_') fail("bad-expression", begin, rest, "digits cannot be grouped with '_'");
  const bool prefix = text_.substr(begin, end - begin) == "0" && end + 1 < rest &&
                      std::string_view("xXoObB").find(text_[end]) != std::string_view::npos;
  if (prefix) fail("bad-expression", begin, rest, "a number must be decimal");
}

}  // namespace freeplay
