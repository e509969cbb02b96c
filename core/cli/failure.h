// Failure: how a command reports that something is wrong.
#pragma once

#include <exception>
#include <string>

#include "base/diagnostics.h"
#include "base/error.h"
#include "base/json_text.h"
#include "cli/options.h"

namespace freeplay {

/// Fields of each message: file, line, column, severity, id, message, suggestion. At most `max_errors` errors (0: all).
Json messages_json(const Diagnostics& diagnostics, int max_errors);

/// Why a command could not go on: an Error as it is; memory or threads that the system does not give (exit code 6);
/// else a mistake of this program.
Error error_of(const std::exception& exception);

/// Prints messages on stderr and, with --json, the error object on stdout. Returns `exit_code`.
int report_failure(const Diagnostics& diagnostics, int exit_code, const CommonOptions& options);
int report_failure(const Error& error, const CommonOptions& options);

}  // namespace freeplay
