// Probe: three types, of which one is sound, one crashes and one is unbalanced.
#include "probe.h"

namespace {
using namespace freeplay;

struct Crashes : probe::Idle {
  using Idle::Idle;
  void apply(const JointInput&, JointForces&) const override { probe::crash(); }
};
struct Unbalanced : probe::Idle {
  using Idle::Idle;
  void apply(const JointInput& in, JointForces& out) const override {
    out.wrench_b[0] = -20.0 * (in.b->velocity[0] - in.a->velocity[0]);
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  static const Component components[] = {joint<Crashes>({.name = "crashes", .summary = "Crashes."}),
                                         joint<probe::Idle>({.name = "idle", .summary = "Idle."}),
                                         joint<Unbalanced>({.name = "unbalanced", .summary = "No reaction."})};
  return publish(*host, *manifest, "mixed", "1", components);
}
