// Probe: fills one number more than it was given.
#include "probe.h"

namespace {
struct Probe : freeplay::probe::Idle {
  using Idle::Idle;
  void declare(freeplay::JointLayout& layout) const override {
    layout.forces = 1;
    layout.internal_variables = 1;
  }
  void apply(const freeplay::JointInput& in, freeplay::JointForces& out) const override {
    out.internal_rate[0] = -in.internal[0];
    out.internal_rate.data[out.internal_rate.size] = 0.0;
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {joint<Probe>({.name = "probe", .summary = "Writes beside its numbers."})};
  return publish(*host, *manifest, "probe", "1", components);
}
