// Probe: writes into the state that it may only read.
#include "probe.h"

namespace {
struct Probe : freeplay::probe::Idle {
  using Idle::Idle;
  void declare(freeplay::JointLayout& layout) const override {
    layout.forces = 1;
    layout.history = 1;
  }
  void apply(const freeplay::JointInput& in, freeplay::JointForces&) const override {
    const_cast<double*>(in.history.data)[0] = in.t;
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {joint<Probe>({.name = "probe", .summary = "Writes into its input."})};
  return publish(*host, *manifest, "probe", "1", components);
}
