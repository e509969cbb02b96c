#include "cli/failure.h"

#include <new>
#include <stdexcept>
#include <system_error>

#include <fmt/format.h>

#include "cli/terminal.h"

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

/// One sentence for all messages.
std::string in_short(const Diagnostics& diagnostics) {
  std::string first;
  int errors = 0;
  for (const Diagnostic& diagnostic : diagnostics.sorted()) {
    if (diagnostic.severity != Severity::error) continue;
    if (errors++ == 0) first = diagnostic.message;
  }
  return errors > 1 ? fmt::format("{} (and {} more)", first, errors - 1) : first;
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

Error error_of(const std::exception& exception) {
  if (const auto* known = dynamic_cast<const Error*>(&exception)) return *known;
  const auto* system = dynamic_cast<const std::system_error*>(&exception);
  const bool no_thread = system != nullptr && system->code() == std::errc::resource_unavailable_try_again;
  const bool no_memory = (system != nullptr && system->code() == std::errc::not_enough_memory) ||
                         dynamic_cast<const std::bad_alloc*>(&exception) != nullptr ||
                         dynamic_cast<const std::length_error*>(&exception) != nullptr;
  if (no_thread) {
    return {Error::Category::file,
            "no-threads",
            fmt::format("the system gives no more threads: {}", exception.what()),
            {},
            "`ulimit -u` prints how many a user may have, `ulimit -v` how much memory there is for them"};
  }
  if (no_memory) {
    return {Error::Category::file,
            "no-memory",
            "the system gives no more memory",
            {},
            "`ulimit -v` prints a limit in kB; a smaller model or fewer --channels take less"};
  }
  return {Error::Category::internal,
          "internal",
          fmt::format("internal error: {}", exception.what()),
          {},
          "please report this"};
}

int report_failure(const Diagnostics& diagnostics, int exit_code, const CommonOptions& options) {
  print_messages(diagnostics.format(options.max_errors), options.no_color);
  if (options.json) {
    print_json(Json{{"error",
                     {{"exit_code", exit_code},
                      {"message", in_short(diagnostics)},
                      {"messages", messages_json(diagnostics, options.max_errors)}}}});
  }
  return exit_code;
}

int report_failure(const Error& error, const CommonOptions& options) {
  Diagnostics diagnostics;
  diagnostics.add(as_diagnostic(error));
  return report_failure(diagnostics, error.exit_code(), options);
}

}  // namespace freeplay
