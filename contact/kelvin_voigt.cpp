#include "freeplay/plugin.h"

namespace freeplay {
namespace {

/// Linear spring and damper side by side:
///   F_N = max(0, K delta + D delta')
/// with penetration delta [m] and its rate delta' [m/s], K [N/m], D [N s/m]. The force jumps to D v_0 where a contact
/// begins with the approach speed v_0 [m/s], and is cut where it would pull; with v_0 = 0 there is no damper. A mass m
/// that falls on a fixed surface rebounds with the share exp(-2 zeta acos(zeta)/sqrt(1 - zeta^2)) of its speed, zeta =
/// D/(2 sqrt(K m)) < 1. Schwager and Poschel 2007.
class KelvinVoigt final : public ContactLaw {
 public:
  KelvinVoigt(const Parameters& p, const ContactPair&) : stiffness_(p.number("K")), damping_(p.number("D")) {}

  ContactForce evaluate(const ContactState& state) const override {
    if (!(state.penetration > 0.0)) return {};
    const double elastic = stiffness_ * state.penetration, potential = 0.5 * elastic * state.penetration;
    const double damping = state.approach_speed > 0.0 ? damping_ : 0.0;
    const double force = elastic + damping * state.rate;
    if (force <= 0.0) return {0.0, 0.0, 0.0, potential, elastic};
    return {force, stiffness_, damping, potential, elastic};
  }

 private:
  double stiffness_, damping_;
};

constexpr Parameter kelvin_voigt_parameters[] = {
    {.name = "K", .unit = "N/m", .minimum = 0.0, .open = Open::minimum, .summary = "Contact stiffness."},
    {.name = "D", .unit = "N*s/m", .minimum = 0.0, .summary = "Damping; the force jumps to it times the speed."},
};

}  // namespace

Component kelvin_voigt() {
  return contact_law<KelvinVoigt>(
      {.name = "kelvin-voigt",
       .summary = "Linear spring and damper side by side.",
       .formula = "F_N = max(0, K delta + D delta'); rebound of a mass m: exp(-2 zeta acos(zeta)/sqrt(1 - zeta^2)), "
                  "zeta = D/(2 sqrt(K m)).",
       .validity = "The force jumps by D times the approach speed where a contact begins: fixed steps are of first "
                   "order, adaptive ones, which locate contacts, are not harmed.",
       .references = "Schwager and Poschel 2007, Granular Matter 9, 465-469",
       .parameters = kelvin_voigt_parameters});
}

}  // namespace freeplay
