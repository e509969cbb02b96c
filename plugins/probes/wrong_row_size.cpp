// Probe: has rows of another size.
#include "probe.h"

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {joint<probe::Idle>({.name = "probe", .summary = "Idle."})};
  publish(*host, *manifest, "probe", "1", components);
  manifest->component_size = 8;
  return Status::ok;
}
