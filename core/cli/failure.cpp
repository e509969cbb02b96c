#include "cli/failure.h"

#include <fmt/format.h>

#include "base/message_json.h"
#include "cli/terminal.h"

namespace freeplay {
namespace {

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
