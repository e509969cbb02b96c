#include <cmath>

#include "freeplay/plugin.h"
#include "friction_coefficient.h"

namespace freeplay {
namespace {

/// Static, kinetic and viscous friction, smooth everywhere:
///   F_T = -{[mu_k + (mu_s - mu_k) exp(-(|v|/v_st)^p)] tanh(v/vs) + sigma v} F_N
/// with slip speed v [m/s], normal force F_N [N], coefficients mu_s >= mu_k, Stribeck speed v_st [m/s], exponent p,
/// smoothing speed vs [m/s], viscous coefficient sigma [s/m]. Pennestri et al. 2016.
class Stribeck final : public FrictionLaw {
 public:
  explicit Stribeck(const Parameters& p)
      : mu_s_(p.number("mu_s")),
        mu_k_(p.number("mu_k")),
        v_stribeck_(p.number("v_stribeck")),
        exponent_(p.number("exponent")),
        vs_(p.number("vs")),
        viscous_(p.number("viscous")) {
    require_order(mu_s_, mu_k_);
  }

  FrictionForce evaluate(const FrictionState& state, Span<double>) const override {
    const double speed = std::abs(state.slip_speed);
    const double power = std::pow(speed / v_stribeck_, exponent_), fall = (mu_s_ - mu_k_) * std::exp(-power);
    const double t = std::tanh(speed / vs_), level = mu_k_ + fall;
    // The slope of the fall may be infinite at rest, but there it is multiplied by t = 0.
    const double fall_slope = speed > 0.0 ? -fall * exponent_ * power / speed : 0.0;
    return friction_force({std::copysign(level * t + viscous_ * speed, state.slip_speed),
                           fall_slope * t + level * (1.0 - t * t) / vs_ + viscous_},
                          state);
  }

 private:
  double mu_s_, mu_k_, v_stribeck_, exponent_, vs_, viscous_;
};

constexpr Parameter stribeck_parameters[] = {
    static_parameter,
    kinetic_parameter,
    stribeck_speed_parameter,
    {.name = "exponent",
     .default_value = 2.0,
     .minimum = 0.0,
     .maximum = 10.0,
     .open = Open::minimum,
     .summary = "Exponent p of the fall from static to kinetic friction."},
    smoothing_parameter,
    {.name = "viscous",
     .unit = "s/m",
     .default_value = 0.0,
     .minimum = 0.0,
     .summary = "Viscous coefficient: force over normal force and slip speed."},
};

}  // namespace

Component stribeck() {
  return friction_law<Stribeck>(
      {.name = "stribeck",
       .summary = "Static, kinetic and viscous friction, smooth at low slip.",
       .formula = "F_T = -{[mu_k + (mu_s - mu_k) exp(-(|v|/v_stribeck)^exponent)] tanh(v/vs) + viscous v} F_N.",
       .validity = "Sliding, with vs well below v_stribeck; under load the surfaces creep, as the force of rest takes "
                   "a slip speed.",
       .references = "Pennestri et al. 2016, Nonlinear Dyn 83, 1785-1801",
       .parameters = stribeck_parameters});
}

}  // namespace freeplay
