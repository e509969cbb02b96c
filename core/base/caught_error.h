// CaughtError: whatever was thrown, as an Error.
#pragma once

#include <exception>

#include "base/error.h"

namespace freeplay {

/// An Error as it is; memory or threads that the system does not give (exit code 6); else a mistake of this program.
Error error_of(const std::exception& exception);

}  // namespace freeplay
