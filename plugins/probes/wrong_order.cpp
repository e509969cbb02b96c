// Probe: declares a higher order than it has.
#include "probe_integrator.h"

namespace {
struct Probe : freeplay::probe::Mean {
  using Mean::Mean;
  void declare(freeplay::IntegratorLayout& layout) const override {
    Mean::declare(layout);
    layout.order = 3;
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {integrator<Probe>({.name = "probe", .summary = "Boasts."})};
  return publish(*host, *manifest, "probe", "1", components);
}
