#include "base/message_json.h"

namespace freeplay {
namespace {

/// A place in the file, or null: the program itself has no lines.
Json place(int number) { return number > 0 ? Json(number) : Json(nullptr); }

Json message_json(const Diagnostic& diagnostic) {
  const std::string& file = diagnostic.location.file;
  const std::string& remedy = diagnostic.suggestion.empty() ? diagnostic.hint : diagnostic.suggestion;
  return {{"file", file.empty() || file == program_as_file ? Json(nullptr) : Json(file)},
          {"line", place(diagnostic.location.line)},
          {"column", place(diagnostic.location.column)},
          {"severity", diagnostic.severity == Severity::error ? "error" : "warning"},
          {"id", diagnostic.id},
          {"message", diagnostic.message},
          {"suggestion", remedy.empty() ? Json(nullptr) : Json(remedy)}};
}

}  // namespace

Json messages_json(const Diagnostics& diagnostics, int max_errors) {
  Json messages = Json::array();
  int errors = 0;
  for (const Diagnostic& diagnostic : diagnostics.sorted()) {
    if (diagnostic.severity == Severity::error && max_errors > 0 && errors++ == max_errors) break;
    messages.push_back(message_json(diagnostic));
  }
  return messages;
}

}  // namespace freeplay
