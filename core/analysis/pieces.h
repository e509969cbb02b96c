// in_pieces(): rows of an analysis by several threads.
#pragma once

#include <cstddef>
#include <functional>

#include "analysis/station.h"

namespace freeplay {

/// in_parallel() that calls tick(0) now and then while the caller waits for the other threads; what that throws comes
/// through once these have ended, too.
void in_pieces(std::size_t count, int threads, const Tick& tick,
               const std::function<void(int, std::size_t, std::size_t)>& work);

}  // namespace freeplay
