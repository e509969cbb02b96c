// Probe: a contact that holds on when it is pulled apart.
#include <cmath>

#include "probe.h"

namespace {
/// F = K delta^1.5 without damping, before it is broken.
struct Probe : freeplay::ContactLaw {
  Probe(const freeplay::Parameters&, const freeplay::ContactPair&) {}
  freeplay::ContactForce evaluate(const freeplay::ContactState& s) const override {
    constexpr double stiffness = 1e9;
    const double root = std::sqrt(s.penetration), x = s.penetration;
    freeplay::ContactForce f{stiffness * x * root, 1.5 * stiffness * root, 0.0, 0.4 * stiffness * x * x * root};
    const double damping = s.approach_speed > 0.0 ? 2.0 / s.approach_speed : 0.0, elastic = f.normal;
    f.normal = elastic * (1.0 + damping * s.rate);
    f.d_penetration *= 1.0 + damping * s.rate;
    f.d_rate = elastic * damping;
    return f;
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {contact_law<Probe>({.name = "probe", .summary = "Pulls."})};
  return publish(*host, *manifest, "probe", "1", components);
}
