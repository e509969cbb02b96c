// Probe: writes where no memory is, in constrain().
#include "probe.h"

namespace {
struct Probe : freeplay::probe::Slot {
  using Slot::Slot;
  void constrain(const freeplay::JointInput& in, freeplay::ConstraintRows& rows) const override {
    Slot::constrain(in, rows);
    if (in.t > 0.05) freeplay::probe::crash();
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {
      joint<Probe>({.name = "probe", .space = Space::planar, .summary = "Crashes."})};
  return publish(*host, *manifest, "probe", "1", components);
}
