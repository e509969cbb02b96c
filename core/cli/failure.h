// Failure: how a command tells that something is wrong.
#pragma once

#include <string>

#include "base/diagnostics.h"
#include "base/error.h"
#include "cli/options.h"
#include "io/json_text.h"

namespace freeplay {

/// The error as a message of its file; one that has no file belongs to the program.
Diagnostic as_diagnostic(const Error& error);

/// Fields of each message: file, line, column, severity, id, message, suggestion. At most `max_errors` errors (0: all).
Json messages_json(const Diagnostics& diagnostics, int max_errors);

/// Prints messages on stderr and, with --json, the error object on stdout. Returns `exit_code`.
int report_failure(const Diagnostics& diagnostics, int exit_code, const CommonOptions& options);
int report_failure(const Error& error, const CommonOptions& options);

}  // namespace freeplay
