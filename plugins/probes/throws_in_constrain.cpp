// Probe: throws in the middle of a run, in its rows.
#include <stdexcept>

#include "probe.h"

namespace {
struct Probe : freeplay::probe::Slot {
  using Slot::Slot;
  void constrain(const freeplay::JointInput& in, freeplay::ConstraintRows& rows) const override {
    if (in.t > 0.05) throw std::runtime_error("out of step");
    Slot::constrain(in, rows);
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {
      joint<Probe>({.name = "probe", .space = Space::planar, .summary = "Throws after a while."})};
  return publish(*host, *manifest, "probe", "1", components);
}
