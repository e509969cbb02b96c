// Probe: null pointers where texts should be.
#include "probe.h"

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static constexpr Parameter parameters[] = {{.name = "k", .default_value = 1.0, .summary = nullptr}};
  static const Component components[] = {joint<probe::Idle>({.name = "probe",
                                                             .summary = nullptr,
                                                             .formula = nullptr,
                                                             .validity = nullptr,
                                                             .references = nullptr,
                                                             .parameters = parameters})};
  return publish(*host, *manifest, "probe", "1", components);
}
