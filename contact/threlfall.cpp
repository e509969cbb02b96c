#include <cmath>

#include "freeplay/plugin.h"
#include "friction_coefficient.h"

namespace freeplay {
namespace {

/// Coulomb friction with an exponential rise at low slip:
///   F_T = -mu sign(v) (1 - exp(-3|v|/v_r))/(1 - exp(-3)) F_N for |v| <= v_r,  -mu sign(v) F_N above
/// with slip speed v [m/s], normal force F_N [N], coefficient mu, limit v_r [m/s]. Often printed without the
/// denominator, which leaves a jump of 5 % at v_r. The slope jumps at v_r. Threlfall 1978.
class Threlfall final : public FrictionLaw {
 public:
  explicit Threlfall(const Parameters& p) : mu_(p.number("mu")), v_r_(p.number("v_r")) {}

  FrictionForce evaluate(const FrictionState& state, Span<double>) const override {
    const double speed = std::abs(state.slip_speed);
    if (speed > v_r_) return friction_force({std::copysign(mu_, state.slip_speed), 0.0}, state);
    const double top = -mu_ / std::expm1(-3.0), decay = -3.0 * speed / v_r_;
    return friction_force(
        {std::copysign(top * std::expm1(decay), state.slip_speed), 3.0 * top / v_r_ * std::exp(decay)}, state);
  }
  Span<const double> kinks() const override { return {&v_r_, 1}; }

 private:
  double mu_, v_r_;
};

constexpr Parameter threlfall_parameters[] = {
    coefficient_parameter,
    {.name = "v_r",
     .unit = "m/s",
     .default_value = 1e-3,
     .minimum = 0.0,
     .open = Open::minimum,
     .summary = "Slip speed from which it is full."},
};

}  // namespace

Component threlfall() {
  return friction_law<Threlfall>(
      {.name = "threlfall",
       .summary = "Coulomb friction with an exponential rise at low slip.",
       .formula = "F_T = -mu sign(v) (1 - exp(-3|v|/v_r))/(1 - exp(-3)) F_N for |v| <= v_r, -mu sign(v) F_N above.",
       .validity = "Sliding; under load the surfaces creep, as the force of rest takes a slip speed.",
       .references = "Threlfall 1978, Mech Mach Theory 13, 475-483",
       .parameters = threlfall_parameters});
}

}  // namespace freeplay
