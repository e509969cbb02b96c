// Probe: two parameters with one name.
#include "probe.h"

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static constexpr Parameter parameters[] = {{.name = "k", .default_value = 1.0}, {.name = "k", .default_value = 2.0}};
  static const Component components[] = {
      joint<probe::Idle>({.name = "probe", .summary = "Idle.", .parameters = parameters})};
  return publish(*host, *manifest, "probe", "1", components);
}
