// Probe: ends the program in apply().
#include <cstdlib>

#include "probe.h"

namespace {
struct Probe : freeplay::probe::Idle {
  using Idle::Idle;
  void apply(const freeplay::JointInput& in, freeplay::JointForces&) const override {
    if (in.t > 0.05) std::_Exit(0);
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {joint<Probe>({.name = "probe", .summary = "Ends the program."})};
  return publish(*host, *manifest, "probe", "1", components);
}
