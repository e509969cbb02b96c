// Probe: throws in the middle of a run.
#include <stdexcept>

#include "probe.h"

namespace {
struct Throws : freeplay::probe::Idle {
  using Idle::Idle;
  void apply(const freeplay::JointInput& in, freeplay::JointForces&) const override {
    if (in.t > 0.05) throw std::runtime_error("tired");
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {joint<Throws>({.name = "probe", .summary = "Throws after a while."})};
  return publish(*host, *manifest, "probe", "1", components);
}
