// Probe: an entry point that ends the program.
#include <cstdlib>

#include "probe.h"

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {joint<probe::Idle>({.name = "probe", .summary = "Idle."})};
  if (host->size > 0) std::_Exit(0);
  return publish(*host, *manifest, "probe", "1", components);
}
