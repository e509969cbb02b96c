// Probe: its forces are numbers, one of their derivatives is not.
#include <limits>

#include "probe.h"

namespace {
struct Probe : freeplay::probe::Idle {
  using Idle::Idle;
  void declare(freeplay::JointLayout& layout) const override {
    layout.forces = 1;
    layout.analytic_derivatives = 1;
  }
  void apply(const freeplay::JointInput&, freeplay::JointForces& out) const override {
    if (!out.derivatives.empty()) out.derivatives[7] = std::numeric_limits<double>::quiet_NaN();
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {joint<Probe>({.name = "probe", .summary = "A derivative that is no number."})};
  return publish(*host, *manifest, "probe", "1", components);
}
