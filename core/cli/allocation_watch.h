// AllocationWatch: counts the heap allocations of this program and of the libraries that it has loaded.
#pragma once

namespace freeplay {

/// From here on allocations are counted. Until then, and without it, counting costs a test of one flag.
void watch_allocations();

/// Allocations since watch_allocations(): malloc and its relatives, operator new, whoever called them.
long allocations();

}  // namespace freeplay
