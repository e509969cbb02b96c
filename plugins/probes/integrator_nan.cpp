// Probe: puts a number that is none into the state after a while.
#include <limits>

#include "probe_integrator.h"

namespace {
struct Probe : freeplay::probe::Mean {
  using Mean::Mean;
  freeplay::Attempt attempt(double dt, freeplay::StateView& to, freeplay::Span<double> scratch,
                            freeplay::StageSolver& solver) const override {
    const freeplay::Attempt done = Mean::attempt(dt, to, scratch, solver);
    if (*to.t > 0.05) to.v[0] = std::numeric_limits<double>::quiet_NaN();
    return done;
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {integrator<Probe>({.name = "probe", .summary = "Turns into NaN."})};
  return publish(*host, *manifest, "probe", "1", components);
}
