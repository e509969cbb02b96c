#include "freeplay/plugin.h"
#include "hertz_stiffness.h"

namespace freeplay {
namespace {

/// Hertz contact with hysteresis damping:
///   F_N = max(0, K delta^n (1 + chi delta'/v_0)),  chi = 3(1 - e^2)/4
/// with penetration delta [m] and its rate delta' [m/s], approach speed v_0 [m/s], restitution e, K [N/m^n]. The
/// rebound is close to e only for e above about 0.9. Lankarani and Nikravesh 1990.
class LankaraniNikravesh final : public ContactLaw {
 public:
  LankaraniNikravesh(const Parameters& p, const ContactPair& pair)
      : spring_(p, pair), restitution_(p.number("restitution")), chi_(0.75 * (1.0 - restitution_ * restitution_)) {}

  ContactForce evaluate(const ContactState& state) const override { return spring_.force(state, chi_); }
  const char* outside_range(const ContactState& state) const override {
    if (restitution_ < 0.9)
      return "The law of Lankarani and Nikravesh rebounds faster than asked for a restitution below 0.9.";
    return spring_.outside_range(state);
  }

 private:
  HertzSpring spring_;
  double restitution_, chi_;
};

constexpr Parameter parameters[] = {stiffness_parameter, exponent_parameter, restitution_parameter};

}  // namespace

Component lankarani_nikravesh() {
  return contact_law<LankaraniNikravesh>(
      {.name = "lankarani-nikravesh",
       .summary = "Hertz contact with hysteresis damping from a coefficient of restitution.",
       .formula =
           "F_N = max(0, K delta^n (1 + 3(1 - e^2)/4 delta'/v_0)); v_0: approach speed, e: restitution; K as in hertz.",
       .validity =
           "Restitution above about 0.9 and low impact speed; penetration below a tenth of the radial clearance.",
       .references = "Lankarani and Nikravesh 1990, J Mech Des 112, 369-376",
       .parameters = parameters});
}

}  // namespace freeplay
