// Probe: makes a vector in every call and frees it again.
#include <vector>

#include "probe.h"

namespace {
struct Probe : freeplay::probe::Idle {
  using Idle::Idle;
  void apply(const freeplay::JointInput& in, freeplay::JointForces& out) const override {
    const std::vector<double> x(3, in.t);
    const double* volatile seen = x.data();  // or the compiler would leave it out
    out.potential = 0.0 * seen[0];
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {joint<Probe>({.name = "probe", .summary = "Allocates."})};
  return publish(*host, *manifest, "probe", "1", components);
}
