// Probe: an entry of the Jacobian has the wrong sign.
#include "probe.h"

namespace {
struct Probe : freeplay::probe::Slot {
  using Slot::Slot;
  void constrain(const freeplay::JointInput& in, freeplay::ConstraintRows& rows) const override {
    Slot::constrain(in, rows);
    rows.jacobian[5] *= -1.0;
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {
      joint<Probe>({.name = "probe", .space = Space::planar, .summary = "A wrong Jacobian."})};
  return publish(*host, *manifest, "probe", "1", components);
}
