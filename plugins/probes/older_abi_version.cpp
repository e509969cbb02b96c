// Probe: claims an older version of the plugin ABI.
#include "probe.h"

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {joint<probe::Idle>({.name = "probe", .summary = "Idle."})};
  publish(*host, *manifest, "probe", "1", components);
  manifest->abi_version = 0;
  return Status::ok;
}
