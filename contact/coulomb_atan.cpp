#include <cmath>

#include "freeplay/plugin.h"
#include "friction_coefficient.h"

namespace freeplay {
namespace {

/// Coulomb friction, smooth everywhere; mu is reached slowly, with a rest of 2 vs/(pi |v|):
///   F_T = -mu (2/pi) atan(v/vs) F_N
/// with slip speed v [m/s], normal force F_N [N], coefficient mu, smoothing speed vs [m/s].
class CoulombAtan final : public FrictionLaw {
 public:
  explicit CoulombAtan(const Parameters& p) : mu_(p.number("mu")), vs_(p.number("vs")) {}

  FrictionForce evaluate(const FrictionState& state, Span<double>) const override {
    constexpr double two_over_pi = 0.636619772367581343;
    const double ratio = state.slip_speed / vs_, top = mu_ * two_over_pi;
    return friction_force({top * std::atan(ratio), top / (vs_ * (1.0 + ratio * ratio))}, state);
  }

 private:
  double mu_, vs_;
};

constexpr Parameter coulomb_atan_parameters[] = {coefficient_parameter, smoothing_parameter};

}  // namespace

Component coulomb_atan() {
  return friction_law<CoulombAtan>(
      {.name = "coulomb-atan",
       .summary = "Coulomb friction with an arc tangent at low slip.",
       .formula = "F_T = -mu (2/pi) atan(v/vs) F_N.",
       .validity = "Sliding at many times vs; under load the surfaces creep, as the force of rest takes a slip speed.",
       .references = "Mostaghel and Davis 1997, Earthquake Eng Struct Dyn 26, 541-548; Marques, Flores, Claro and "
                     "Lankarani 2016, Nonlinear Dyn 86, 1407-1443 (survey)",
       .parameters = coulomb_atan_parameters});
}

}  // namespace freeplay
