// The schema of results: of which a file says that it is.
#pragma once

#include <string>

#include "base/json_text.h"

namespace freeplay {

/// Throws Error{file} "unreadable-result" for a file of another schema; `version`: of the program that wrote it, or
/// null.
void require_known_schema(const std::string& file, const Json& schema, const Json& version);

}  // namespace freeplay
