// Probe: a force that is not a number after a while.
#include <limits>

#include "probe.h"

namespace {
struct NotANumber : freeplay::probe::Idle {
  using Idle::Idle;
  void apply(const freeplay::JointInput& in, freeplay::JointForces& out) const override {
    if (in.t > 0.05) out.wrench_b[0] = std::numeric_limits<double>::quiet_NaN();
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {joint<NotANumber>({.name = "probe", .summary = "Turns into NaN."})};
  return publish(*host, *manifest, "probe", "1", components);
}
