// Probe: fills one row more than it has.
#include "probe.h"

namespace {
struct Probe : freeplay::probe::Slot {
  using Slot::Slot;
  void constrain(const freeplay::JointInput& in, freeplay::ConstraintRows& rows) const override {
    Slot::constrain(in, rows);
    double* volatile next = rows.jacobian.data + 12;
    for (int i = 0; i < 12; ++i) next[i] = 0.0;
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {
      joint<Probe>({.name = "probe", .space = Space::planar, .summary = "Writes a second row."})};
  return publish(*host, *manifest, "probe", "1", components);
}
