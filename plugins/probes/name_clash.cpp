// Probe: takes the name of a built-in joint.
#include "probe.h"

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {joint<probe::Idle>({.name = "revolute", .summary = "Not a pin."})};
  return publish(*host, *manifest, "probe", "1", components);
}
