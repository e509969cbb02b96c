// Probe: adds a little speed in every step.
#include "probe_integrator.h"

namespace {
struct Probe : freeplay::probe::Mean {
  using Mean::Mean;
  freeplay::Attempt attempt(double dt, freeplay::StateView& to, freeplay::Span<double> scratch,
                            freeplay::StageSolver& solver) const override {
    const freeplay::Attempt done = Mean::attempt(dt, to, scratch, solver);
    for (double& speed : to.v) speed *= 1.0 + 1e-4;
    return done;
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {integrator<Probe>({.name = "probe", .summary = "Pumps."})};
  return publish(*host, *manifest, "probe", "1", components);
}
