// Conditions: what the suites are run with.
#pragma once

#include <cstdint>

#include "contract/call_note.h"
#include "contract/finding.h"

namespace freeplay {

/// Heap allocations made so far by this program. The host of a suite may supply it.
using AllocationCount = long (*)();

struct Conditions {
  std::uint64_t seed = 1;                 ///< of the random states; equal seeds give equal findings
  AllocationCount allocations = nullptr;  ///< null: allocations are not watched
  CallNote* note = nullptr;               ///< where each call is noted; null: nowhere
  FindingSink found = {};                 ///< receives findings as they are made; may be empty
  bool other_laws = true;                 ///< joints with each law of the registry, not with the first alone
};

/// A call of a component's function, from construction to end(): noted, and its allocations counted.
class WatchedCall {
 public:
  WatchedCall(const Conditions& conditions, const char* function) : conditions_(conditions) {
    if (conditions_.note != nullptr) conditions_.note->enter(function);
    if (conditions_.allocations != nullptr) before_ = conditions_.allocations();
  }
  /// Allocations that the call made; 0 if they are not watched.
  long end() {
    const long made = conditions_.allocations != nullptr ? conditions_.allocations() - before_ : 0;
    if (conditions_.note != nullptr) conditions_.note->leave();
    return made;
  }

 private:
  const Conditions& conditions_;
  long before_ = 0;
};

}  // namespace freeplay
