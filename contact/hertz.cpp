#include "freeplay/plugin.h"
#include "hertz_stiffness.h"

namespace freeplay {
namespace {

/// Elastic contact without loss: F_N = K delta^n for a penetration delta > 0 [m], with K [N/m^n] given or, for n = 1.5,
/// the stiffness of a sphere in a spherical cavity (hertz_stiffness.h). Hertz 1881.
class Hertz final : public ContactLaw {
 public:
  Hertz(const Parameters& p, const ContactPair& pair) : spring_(p, pair) {}

  ContactForce evaluate(const ContactState& state) const override { return spring_.force(state, 0.0); }
  const char* outside_range(const ContactState& state) const override { return spring_.outside_range(state); }

 private:
  HertzSpring spring_;
};

constexpr Parameter hertz_parameters[] = {stiffness_parameter, exponent_parameter};

}  // namespace

Component hertz() {
  return contact_law<Hertz>({.name = "hertz",
                             .summary = "Elastic contact without loss.",
                             .formula =
                                 "F_N = K delta^n; default K = 4/(3(h_b + h_j)) sqrt(R_b R_j/(R_b - R_j)), h = (1 - "
                                 "nu^2)/E.",
                             .validity = "Contact patch much smaller than the radii: penetration below a tenth of the "
                                         "radial clearance.",
                             .references = "Hertz 1881; Johnson 1985, Contact Mechanics",
                             .parameters = hertz_parameters});
}

}  // namespace freeplay
