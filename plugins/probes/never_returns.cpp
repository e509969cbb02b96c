// Probe: loops for ever in apply().
#include "probe.h"

namespace {
struct Probe : freeplay::probe::Idle {
  using Idle::Idle;
  void apply(const freeplay::JointInput& in, freeplay::JointForces& out) const override {
    volatile bool on = in.t > 0.05;
    while (on) out.potential = 0.0;
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {joint<Probe>({.name = "probe", .summary = "Never returns."})};
  return publish(*host, *manifest, "probe", "1", components);
}
