// Probe: claims another version of the plugin ABI.
#include "probe.h"

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {joint<probe::Idle>({.name = "probe", .summary = "Idle."})};
  publish(*host, *manifest, "probe", "1", components);
  manifest->abi_version = 99;
  return Status::ok;
}
