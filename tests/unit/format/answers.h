// What models with a mistake are answered, word for word: its place, its id, the message and the remedy.
#pragma once

#include <span>
#include <string>

#include <gtest/gtest.h>

#include "validation/run_model.h"

namespace freeplay {

struct Answer {
  const char* written;  ///< in the place of `@` in a model
  const char* said;     ///< "line:column id: message | remedy", one a line
};

/// All that is said of a text when it is read and checked.
inline std::string said_of(const std::string& text, const BuildOptions& options = {},
                           const std::string& file = "m.yaml") {
  const LoadedModel loaded = load_text(text, file, options, test::builtin_types());
  std::string said;
  for (const Diagnostic& d : loaded.diagnostics.sorted()) {
    if (!said.empty()) said += '\n';
    said += std::to_string(d.location.line) + ":" + std::to_string(d.location.column) + " " + d.id + ": " + d.message;
    if (const std::string& remedy = d.suggestion.empty() ? d.hint : d.suggestion; !remedy.empty())
      said += " | " + remedy;
  }
  return said;
}

inline void expect_answers(const std::string& model, std::span<const Answer> answers) {
  for (const Answer& answer : answers) {
    EXPECT_EQ(said_of(test::replaced(model, "@", answer.written)), answer.said) << answer.written;
  }
}

}  // namespace freeplay
