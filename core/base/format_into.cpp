#include "base/format_into.h"

#include <cstddef>

#include <fmt/format.h>

namespace freeplay {

char* put_into(char* to, const char* end, fmt::string_view text, fmt::format_args values) noexcept {
  return fmt::vformat_to_n(to, static_cast<std::size_t>(end - to), text, values).out;
}

}  // namespace freeplay
