// Probe: an entry point that does not return.
#include "probe.h"

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {joint<probe::Idle>({.name = "probe", .summary = "Idle."})};
  volatile bool on = true;
  while (on) manifest->size = 0;
  return publish(*host, *manifest, "probe", "1", components);
}
