// Probe: a joint with play whose ideal type no library has.
#include "probe.h"

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {
      joint<probe::Idle>({.name = "probe", .summary = "Loose.", .ideal = "no-such-pin", .block = "play"})};
  return publish(*host, *manifest, "probe", "1", components);
}
