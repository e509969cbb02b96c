// Probe: the term of the second derivative without accelerations is missing.
#include "probe.h"

namespace {
struct Probe : freeplay::probe::Slot {
  using Slot::Slot;
  void constrain(const freeplay::JointInput& in, freeplay::ConstraintRows& rows) const override {
    Slot::constrain(in, rows);
    rows.gamma[0] = 0.0;
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {
      joint<Probe>({.name = "probe", .space = Space::planar, .summary = "No centripetal term."})};
  return publish(*host, *manifest, "probe", "1", components);
}
