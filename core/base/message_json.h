// MessageJson: messages as fields, for other programs.
#pragma once

#include "base/diagnostics.h"
#include "base/json_text.h"

namespace freeplay {

/// Fields of each message: file, line, column, severity, id, message, suggestion. At most `max_errors` errors (0: all).
Json messages_json(const Diagnostics& diagnostics, int max_errors);

}  // namespace freeplay
