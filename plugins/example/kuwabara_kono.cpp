// Example of a contact law plugin: viscoelastic spheres. One file, one class, one table.
#include <cmath>

#include "freeplay/plugin.h"

namespace {

using namespace freeplay;

constexpr Parameter parameters[] = {
    {.name = "K",
     .unit = "N/m^1.5",
     .default_value = optional,
     .minimum = 0.0,
     .open = Open::minimum,
     .summary = "Contact stiffness; without it from radii and materials, as Hertz says."},
    {.name = "relaxation",
     .unit = "s",
     .minimum = 0.0,
     .summary = "Ratio of the material's viscosities to its stiffness, a time."},
};

/// Hertz contact of viscoelastic material: where strain follows its rate slowly,
///   F = max(0, K (delta^(3/2) + 3/2 A delta^(1/2) delta'))
/// with penetration delta [m] and its rate delta' [m/s], relaxation time A [s]. Kuwabara and Kono 1987.
class KuwabaraKono final : public ContactLaw {
 public:
  KuwabaraKono(const Parameters& p, const ContactPair& pair)
      : stiffness_(p.given("K") ? p.number("K") : hertz(pair)), relaxation_(p.number("relaxation")) {}

  ContactForce evaluate(const ContactState& s) const override {
    const double root = std::sqrt(s.penetration);
    const double potential = 0.4 * stiffness_ * s.penetration * s.penetration * root;
    const double a = s.approach_speed > 0.0 ? 1.5 * relaxation_ : 0.0;  // no approach: the elastic part alone
    const double force = stiffness_ * root * (s.penetration + a * s.rate);
    if (force <= 0.0) return {.normal = 0.0, .d_penetration = 0.0, .d_rate = 0.0, .potential = potential};
    return {.normal = force,
            .d_penetration = stiffness_ * (1.5 * root + 0.5 * a * s.rate / root),
            .d_rate = stiffness_ * a * root,
            .potential = potential};
  }

 private:
  /// 4/3 E* sqrt(R), a ball in a socket; 1/E* and 1/R: sum and difference over both sides.
  static double hertz(const ContactPair& pair) {
    const auto compliance = [](const Material& m) {
      return (1.0 - m.poisson_ratio * m.poisson_ratio) / m.youngs_modulus;
    };
    const double radius = pair.bearing_radius * pair.journal_radius / pair.radial_clearance;
    const double stiffness = 4.0 / 3.0 * std::sqrt(radius) / (compliance(pair.bearing) + compliance(pair.journal));
    if (!std::isfinite(stiffness)) throw BadParameter("K", "missing-key", "K, or radii and materials, must be given");
    return stiffness;
  }
  double stiffness_, relaxation_;
};

}  // namespace

FREEPLAY_PLUGIN(kuwabara_kono) {
  static const Component components[] = {
      contact_law<KuwabaraKono>({.name = "kuwabara-kono",
                                 .summary = "Hertz contact of viscoelastic material.",
                                 .formula = "F = max(0, K (delta^1.5 + 1.5 relaxation delta^0.5 delta'))",
                                 .validity = "Impacts far slower than sound in the material; relaxation far shorter "
                                             "than the contact.",
                                 .references = "Kuwabara and Kono 1987, Jpn J Appl Phys 26, 1230-1233",
                                 .parameters = parameters}),
  };
  return publish(*host, *manifest, "kuwabara_kono", "1.0.0", components);
}
