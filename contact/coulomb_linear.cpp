#include <cmath>

#include "freeplay/plugin.h"
#include "friction_coefficient.h"

namespace freeplay {
namespace {

/// Coulomb friction with a ramp at low slip:
///   F_T = -mu sign(v) min(1, |v|/vs) F_N
/// with slip speed v [m/s], normal force F_N [N], coefficient mu, smoothing speed vs [m/s]. The kinks lie at +-vs.
class CoulombLinear final : public FrictionLaw {
 public:
  explicit CoulombLinear(const Parameters& p) : mu_(p.number("mu")), vs_(p.number("vs")) {}

  FrictionForce evaluate(const FrictionState& state, Span<double>) const override {
    const double share = state.slip_speed / vs_;
    if (std::abs(share) >= 1.0) return friction_force({std::copysign(mu_, share), 0.0}, state);
    return friction_force({mu_ * share, mu_ / vs_}, state);
  }
  Span<const double> kinks() const override { return {&vs_, 1}; }

 private:
  double mu_, vs_;
};

constexpr Parameter coulomb_linear_parameters[] = {coefficient_parameter, smoothing_parameter};

}  // namespace

Component coulomb_linear() {
  return friction_law<CoulombLinear>(
      {.name = "coulomb-linear",
       .summary = "Coulomb friction with a linear ramp at low slip.",
       .formula = "F_T = -mu sign(v) min(1, |v|/vs) F_N.",
       .validity = "Sliding; under load the surfaces creep, as the force of rest takes a slip speed.",
       .references = "Rooney and Deravi 1982, Mech Mach Theory 17, 207-211; Marques, Flores, Claro and Lankarani 2016, "
                     "Nonlinear Dyn 86, 1407-1443 (survey)",
       .parameters = coulomb_linear_parameters});
}

}  // namespace freeplay
