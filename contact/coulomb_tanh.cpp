#include <cmath>

#include "freeplay/plugin.h"
#include "friction_coefficient.h"

namespace freeplay {
namespace {

/// Coulomb friction, smooth everywhere:
///   F_T = -mu tanh(v/vs) F_N
/// with slip speed v [m/s], normal force F_N [N], coefficient mu, smoothing speed vs [m/s].
class CoulombTanh final : public FrictionLaw {
 public:
  explicit CoulombTanh(const Parameters& p) : mu_(p.number("mu")), vs_(p.number("vs")) {}

  FrictionForce evaluate(const FrictionState& state, Span<double>) const override {
    const double t = std::tanh(state.slip_speed / vs_);
    return friction_force({mu_ * t, mu_ * (1.0 - t * t) / vs_}, state);
  }

 private:
  double mu_, vs_;
};

constexpr Parameter coulomb_tanh_parameters[] = {coefficient_parameter, smoothing_parameter};

}  // namespace

Component coulomb_tanh() {
  return friction_law<CoulombTanh>(
      {.name = "coulomb-tanh",
       .summary = "Coulomb friction with a hyperbolic tangent at low slip.",
       .formula = "F_T = -mu tanh(v/vs) F_N.",
       .validity = "Sliding; under load the surfaces creep, as the force of rest takes a slip speed.",
       .references = "Andersson, Soderberg and Bjorklund 2007, Tribol Int 40, 580-587; Mostaghel and Davis 1997, "
                     "Earthquake Eng Struct Dyn 26, 541-548",
       .parameters = coulomb_tanh_parameters});
}

}  // namespace freeplay
