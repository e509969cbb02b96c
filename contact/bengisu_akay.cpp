#include <cmath>

#include "freeplay/plugin.h"
#include "friction_coefficient.h"

namespace freeplay {
namespace {

/// Static and kinetic friction: a parabola up to the static coefficient, then an exponential fall:
///   F_T = -sign(v) mu_s [1 - (|v|/v0 - 1)^2] F_N for |v| < v0
///   F_T = -sign(v) [mu_k + (mu_s - mu_k) exp(-xi (|v| - v0))] F_N above
/// with slip speed v [m/s], normal force F_N [N], coefficients mu_s >= mu_k, peak at v0 [m/s], fall xi [s/m]. The
/// slope jumps at v0. Bengisu and Akay 1994.
class BengisuAkay final : public FrictionLaw {
 public:
  explicit BengisuAkay(const Parameters& p)
      : mu_s_(p.number("mu_s")), mu_k_(p.number("mu_k")), v0_(p.number("v0")), xi_(p.number("xi")) {
    require_order(mu_s_, mu_k_);
  }

  FrictionForce evaluate(const FrictionState& state, Span<double>) const override {
    const double speed = std::abs(state.slip_speed);
    if (speed < v0_) {
      const double x = speed / v0_;
      return friction_force({std::copysign(mu_s_ * x * (2.0 - x), state.slip_speed), 2.0 * mu_s_ * (1.0 - x) / v0_},
                            state);
    }
    const double fall = (mu_s_ - mu_k_) * std::exp(-xi_ * (speed - v0_));
    return friction_force({std::copysign(mu_k_ + fall, state.slip_speed), -xi_ * fall}, state);
  }
  Span<const double> kinks() const override { return {&v0_, 1}; }

 private:
  double mu_s_, mu_k_, v0_, xi_;
};

constexpr Parameter bengisu_akay_parameters[] = {
    static_parameter,
    kinetic_parameter,
    {.name = "v0",
     .unit = "m/s",
     .default_value = 1e-3,
     .minimum = 0.0,
     .open = Open::minimum,
     .summary = "Slip speed of the static coefficient."},
    {.name = "xi", .unit = "s/m", .minimum = 0.0, .summary = "Fall from the static to the kinetic coefficient."},
};

}  // namespace

Component bengisu_akay() {
  return friction_law<BengisuAkay>(
      {.name = "bengisu-akay",
       .summary = "Static and kinetic friction with an exponential fall.",
       .formula = "F_T = -sign(v) mu_s [1 - (|v|/v0 - 1)^2] F_N for |v| < v0; -sign(v) [mu_k + (mu_s - mu_k) exp(-xi "
                  "(|v| - v0))] F_N above.",
       .validity = "Sliding; under load the surfaces creep, as the force of rest takes a slip speed below v0.",
       .references = "Bengisu and Akay 1994, J Sound Vib 171, 557-570",
       .parameters = bengisu_akay_parameters});
}

}  // namespace freeplay
