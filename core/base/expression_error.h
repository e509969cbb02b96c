// ExpressionError: what is wrong at which place of an expression or a unit.
#pragma once

#include <exception>
#include <string>
#include <utility>

namespace freeplay {

/// Thrown while an expression or a unit is read. The reader of the file turns it into a Diagnostic: `offset` and
/// `length` count characters (not bytes) from the start of the text that was read.
struct ExpressionError : std::exception {
  ExpressionError(std::string message_id, std::string text, int at, int characters, std::string nearest = {},
                  std::string remedy = {})
      : id(std::move(message_id)),
        message(std::move(text)),
        offset(at),
        length(characters),
        suggestion(std::move(nearest)),
        hint(std::move(remedy)) {}

  const char* what() const noexcept override { return message.c_str(); }

  /// "bad-expression", "bad-unit", "dimension-mismatch", "time-not-allowed", "unknown-name" or "bad-number".
  std::string id;
  std::string message;
  int offset = 0, length = 1;
  std::string suggestion;  ///< the word that was probably meant, or empty
  std::string hint;        ///< a remedy in words, or empty
};

}  // namespace freeplay
