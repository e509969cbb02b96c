// Failure: how a command reports that something is wrong.
#pragma once

#include "base/diagnostics.h"
#include "base/error.h"
#include "base/json_text.h"
#include "cli/options.h"

namespace freeplay {

/// Prints messages on stderr and, with --json, the error object on stdout. Returns `exit_code`.
int report_failure(const Diagnostics& diagnostics, int exit_code, const CommonOptions& options);
int report_failure(const Error& error, const CommonOptions& options);

}  // namespace freeplay
