// Index: counts and indices of the mechanics are int, those of containers std::size_t.
#pragma once

#include <cstddef>

namespace freeplay {

/// `i`, which is not negative, as an index of a container.
constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace freeplay
