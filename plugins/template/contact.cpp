// my-type: a contact law of your own. As it stands, a power of the penetration with a damper that grows with it.
#include <cmath>

#include "freeplay/plugin.h"

namespace {

using namespace freeplay;

// What a model file may say under `contact:`. The unit of K follows the exponent.
constexpr Parameter parameters[] = {
    {.name = "K", .unit = "N/m^exponent", .minimum = 0.0, .open = Open::minimum, .summary = "Contact stiffness."},
    {.name = "exponent", .default_value = 1.5, .minimum = 1.0, .maximum = 3.0, .summary = "Power of the penetration."},
    {.name = "loss", .unit = "s/m", .default_value = 0.5, .minimum = 0.0, .summary = "Damping per elastic force."},
};

/// F = max(0, K delta^n (1 + loss delta')), delta: penetration [m], delta': its rate [m/s].
class MyType final : public ContactLaw {
 public:
  // The pair says radii, length and materials of journal and bearing, as far as the model gives them.
  MyType(const Parameters& p, const ContactPair&)
      : stiffness_(p.number("K")), exponent_(p.number("exponent")), loss_(p.number("loss")) {}

  ContactForce evaluate(const ContactState& s) const override {
    const double elastic = stiffness_ * std::pow(s.penetration, exponent_);
    const double potential = elastic * s.penetration / (exponent_ + 1.0);
    // Without an approach speed the host asks for the elastic part alone.
    const double loss = s.approach_speed > 0.0 ? loss_ : 0.0;
    const double factor = 1.0 + loss * s.rate;
    if (factor <= 0.0) return {.normal = 0.0, .d_penetration = 0.0, .d_rate = 0.0, .potential = potential};
    return {.normal = elastic * factor,
            .d_penetration = exponent_ * elastic / s.penetration * factor,
            .d_rate = elastic * loss,
            .potential = potential};
  }

 private:
  double stiffness_, exponent_, loss_;
};

}  // namespace

FREEPLAY_PLUGIN(my_type) {
  static const Component components[] = {
      contact_law<MyType>({.name = "my-type",
                           .summary = "Power law with a damper that grows with the penetration.",
                           .formula = "F = max(0, K delta^exponent (1 + loss delta'))",
                           .validity = "Penetration far below the radial clearance.",
                           .parameters = parameters}),
  };
  return publish(*host, *manifest, "my_type", "0.1.0", components);
}
