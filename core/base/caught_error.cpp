#include "base/caught_error.h"

#include <new>
#include <stdexcept>
#include <system_error>

#include <fmt/format.h>

namespace freeplay {

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

}  // namespace freeplay
