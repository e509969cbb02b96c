// Probe: keeps what must roll back in a member.
#include <algorithm>

#include "probe.h"

namespace {
/// A force that has seen a distance does not forget it.
struct Probe : freeplay::probe::Idle {
  using Idle::Idle;
  void apply(const freeplay::JointInput&, freeplay::JointForces& out) const override {
    out.potential = 1e-9 * farthest_;
  }
  void commit(const freeplay::JointInput& in, freeplay::Span<const double>, freeplay::Span<double>) const override {
    farthest_ = std::max(farthest_, in.b->position[0]);
  }

 private:
  mutable double farthest_ = 0.0;
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {joint<Probe>({.name = "probe", .summary = "Remembers outside the state."})};
  return publish(*host, *manifest, "probe", "1", components);
}
