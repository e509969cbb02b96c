// ExpressionText: the text of a formula while it is read, and errors at places of it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace freeplay {

/// Places are bytes of the text; errors count characters. What fails throws ExpressionError.
class ExpressionText {
 public:
  explicit ExpressionText(std::string_view text) : text_(text) {}

 protected:
  /// Next character that is not blank, which is then at position_; 0 at the end.
  char peek();

  /// Characters in the bytes [begin, end). Places are asked for in nearly rising order (an operator after its
  /// operands), so that counting from the last one, forth or back, keeps a long text linear.
  int characters(std::size_t begin, std::size_t end);

  /// Goes on after the '(' at `open`, and after its ')'.
  void enter(std::size_t open);
  void leave(std::size_t open);

  /// At the bytes [begin, end).
  [[noreturn]] void fail(const char* id, std::size_t begin, std::size_t end, std::string message,
                         std::string nearest = {}, std::string hint = {}) const;
  /// What stands at position_ does not continue the expression.
  [[noreturn]] void fail_at_rest();
  [[noreturn]] void fail_at_comma();
  /// Where the word at `word_begin` is inf or nan.
  void fail_if_not_finite_word(std::size_t word_begin, std::size_t begin) const;

  /// 1_000, 0x1F, 0o17, 0b1: numbers elsewhere.
  void refuse_other_notations(std::size_t begin, std::size_t end) const;

  std::string_view text_;
  std::size_t position_ = 0;  ///< of what is read next

 private:
  static constexpr int deepest = 256;

  int nesting_ = 0;
  std::size_t counted_bytes_ = 0;
  int counted_ = 0;
};

}  // namespace freeplay
