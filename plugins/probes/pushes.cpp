// Probe: a damper that drives.
#include "probe.h"

namespace {
struct Probe : freeplay::probe::Idle {
  using Idle::Idle;
  void apply(const freeplay::JointInput& in, freeplay::JointForces& out) const override {
    const double torque = 0.1 * (in.b->angular_velocity[2] - in.a->angular_velocity[2]);
    out.wrench_b[5] = torque;
    out.wrench_a[5] = -torque;
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {joint<Probe>({.name = "probe", .summary = "Negative damping."})};
  return publish(*host, *manifest, "probe", "1", components);
}
