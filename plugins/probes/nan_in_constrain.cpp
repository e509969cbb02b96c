// Probe: a row that is not a number after a while.
#include <limits>

#include "probe.h"

namespace {
struct Probe : freeplay::probe::Slot {
  using Slot::Slot;
  void constrain(const freeplay::JointInput& in, freeplay::ConstraintRows& rows) const override {
    Slot::constrain(in, rows);
    if (in.t > 0.05) rows.phi[0] = std::numeric_limits<double>::quiet_NaN();
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {
      joint<Probe>({.name = "probe", .space = Space::planar, .summary = "Turns into NaN."})};
  return publish(*host, *manifest, "probe", "1", components);
}
