// Probe: throws at the first loaded slip.
#include <cmath>
#include <stdexcept>

#include "probe.h"

namespace {
/// -F_N atan(v / v_s) / 4, before it is broken.
struct Probe : freeplay::FrictionLaw {
  explicit Probe(const freeplay::Parameters&) {}
  freeplay::FrictionForce evaluate(const freeplay::FrictionState& s, freeplay::Span<double>) const override {
    const double u = s.slip_speed / 0.01;
    freeplay::FrictionForce f{-0.25 * std::atan(u) * s.normal_force, -0.25 * std::atan(u),
                              -25.0 / (1.0 + u * u) * s.normal_force};
    if (s.normal_force > 0.0) throw std::runtime_error("stuck");
    return f;
  }
};
}  // namespace

FREEPLAY_PLUGIN(probe) {
  using namespace freeplay;
  static const Component components[] = {friction_law<Probe>({.name = "probe", .summary = "Throws."})};
  return publish(*host, *manifest, "probe", "1", components);
}
