// Refusal: messages of a file or of a call that end it, on their way to Python.
#pragma once

#include <exception>
#include <string>

#include "base/diagnostics.h"
#include "base/error.h"
#include "base/json_text.h"

namespace freeplay {

class Refusal : public std::exception {
 public:
  Refusal(const Diagnostics& diagnostics, int exit_code);
  explicit Refusal(const Error& error);

  const char* what() const noexcept override { return text_.c_str(); }
  int exit_code() const { return exit_code_; }
  /// All messages as the command prints them.
  const std::string& text() const { return text_; }
  const Json& messages() const { return messages_; }

 private:
  int exit_code_;
  std::string text_;
  Json messages_;
};

}  // namespace freeplay
