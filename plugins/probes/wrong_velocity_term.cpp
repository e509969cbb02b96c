// Probe: a length that follows time has a rate of the wrong sign.
#include <cmath>

#include "probe.h"

namespace {
struct Probe : freeplay::probe::Slot {
  using Slot::Slot;
  void constrain(const freeplay::JointInput& in, freeplay::ConstraintRows& rows) const override {
    Slot::constrain(in, rows);
    rows.phi[0] -= 0.1 * std::sin(in.t);
    rows.nu[0] = -0.1 * std::cos(in.t);
    rows.gamma[0] -= 0.1 * std::sin(in.t);
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {
      joint<Probe>({.name = "probe", .space = Space::planar, .summary = "A wrong velocity term."})};
  return publish(*host, *manifest, "probe", "1", components);
}
