// Probe: throws at the first deep contact.
#include <cmath>
#include <stdexcept>

#include "probe.h"

namespace {
/// F = K delta^1.5 without damping, before it is broken.
struct Probe : freeplay::ContactLaw {
  Probe(const freeplay::Parameters&, const freeplay::ContactPair&) {}
  freeplay::ContactForce evaluate(const freeplay::ContactState& s) const override {
    constexpr double stiffness = 1e9;
    const double root = std::sqrt(s.penetration), x = s.penetration;
    freeplay::ContactForce f{stiffness * x * root, 1.5 * stiffness * root, 0.0, 0.4 * stiffness * x * x * root};
    if (x > 1e-7) throw std::runtime_error("too deep");
    return f;
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {contact_law<Probe>({.name = "probe", .summary = "Throws."})};
  return publish(*host, *manifest, "probe", "1", components);
}
