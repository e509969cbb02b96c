// Probe: ends its steps at another time than it was asked for.
#include "probe_integrator.h"

namespace {
struct Probe : freeplay::probe::Mean {
  using Mean::Mean;
  freeplay::Attempt attempt(double dt, freeplay::StateView& to, freeplay::Span<double> scratch,
                            freeplay::StageSolver& solver) const override {
    const freeplay::Attempt done = Mean::attempt(dt, to, scratch, solver);
    *to.t += 1e-3 * dt;
    return done;
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {integrator<Probe>({.name = "probe", .summary = "Comes late."})};
  return publish(*host, *manifest, "probe", "1", components);
}
