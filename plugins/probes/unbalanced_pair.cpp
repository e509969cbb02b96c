// Probe: a force without its reaction.
#include "probe.h"

namespace {
struct Probe : freeplay::probe::Idle {
  using Idle::Idle;
  void apply(const freeplay::JointInput& in, freeplay::JointForces& out) const override {
    out.wrench_b[0] = -20.0 * (in.b->velocity[0] - in.a->velocity[0]);
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {joint<Probe>({.name = "probe", .summary = "No reaction."})};
  return publish(*host, *manifest, "probe", "1", components);
}
