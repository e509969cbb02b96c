// Probe: a static constructor that crashes.
#include "probe.h"

namespace {
struct Crash {
  Crash() { freeplay::probe::crash(); }
} at_load;
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {joint<probe::Idle>({.name = "probe", .summary = "Idle."})};
  return publish(*host, *manifest, "probe", "1", components);
}
