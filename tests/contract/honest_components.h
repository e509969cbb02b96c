// Components that keep their contracts under conditions that a suite might take for a fault: stiff, tiny, huge, stiff
// inside, driven in time, of low order. The suites must find nothing in them.
#pragma once

#include "component/registry.h"

namespace freeplay::test {

/// The built-in types and the honest ones, whose library is called "honest".
Registry honest_registry();

}  // namespace freeplay::test
