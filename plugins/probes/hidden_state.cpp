// Probe: answers differ from call to call.
#include "probe.h"

namespace {
double calls = 0.0;

struct Probe : freeplay::probe::Idle {
  using Idle::Idle;
  void apply(const freeplay::JointInput&, freeplay::JointForces& out) const override {
    out.potential = calls += 1e-9;  // a stored energy that only this library knows of
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {joint<Probe>({.name = "probe", .summary = "Counts its calls."})};
  return publish(*host, *manifest, "probe", "1", components);
}
