// Probe: was built for a machine of another kind.
#include "probe.h"

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {joint<probe::Idle>({.name = "probe", .summary = "Idle."})};
  publish(*host, *manifest, "probe", "1", components);
  manifest->fingerprint = "ilp32 big vax";
  return Status::ok;
}
