// Probe: needs a function that no library has.
#include "probe.h"

namespace freeplay {
int function_that_nobody_has();
}

FREEPLAY_PLUGIN(unresolved) {
  using namespace freeplay;
  static const Component components[] = {joint<probe::Idle>({.name = "probe", .summary = "Idle."})};
  return function_that_nobody_has() == 0 ? publish(*host, *manifest, "probe", "1", components) : Status::failed;
}
