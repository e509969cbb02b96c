// Probe: fills more scratch than it asks for.
#include "probe_integrator.h"

namespace {
struct Probe : freeplay::probe::Mean {
  using Mean::Mean;
  freeplay::Attempt attempt(double dt, freeplay::StateView& to, freeplay::Span<double> scratch,
                            freeplay::StageSolver& solver) const override {
    const freeplay::Attempt done = Mean::attempt(dt, to, scratch, solver);
    scratch.data[scratch.size] = dt;
    return done;
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {integrator<Probe>({.name = "probe", .summary = "Writes beside its scratch."})};
  return publish(*host, *manifest, "probe", "1", components);
}
