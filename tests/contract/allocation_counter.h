// Counts the heap allocations of the test program.
#pragma once

namespace freeplay::test {

long allocations();

}  // namespace freeplay::test
