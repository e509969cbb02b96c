// Probe: throws in the middle of a run.
#include <stdexcept>

#include "probe_integrator.h"

namespace {
struct Probe : freeplay::probe::Mean {
  using Mean::Mean;
  freeplay::Attempt attempt(double dt, freeplay::StateView& to, freeplay::Span<double> scratch,
                            freeplay::StageSolver& solver) const override {
    if (*to.t > 0.05) throw std::runtime_error("no further");
    return Mean::attempt(dt, to, scratch, solver);
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {integrator<Probe>({.name = "probe", .summary = "Throws after a while."})};
  return publish(*host, *manifest, "probe", "1", components);
}
