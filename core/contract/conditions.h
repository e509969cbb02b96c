// Conditions: what the suites are run with.
#pragma once

#include <cstdint>

namespace freeplay {

/// Heap allocations made so far by this program. The host of a suite may supply it.
using AllocationCount = long (*)();

struct Conditions {
  std::uint64_t seed = 1;                 ///< of the random states; equal seeds give equal findings
  AllocationCount allocations = nullptr;  ///< null: allocations are not watched
};

}  // namespace freeplay
