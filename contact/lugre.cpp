#include <cmath>

#include "freeplay/plugin.h"
#include "friction_coefficient.h"

namespace freeplay {
namespace {

/// Friction by the deflection of bristles, with memory z [m] (internal variable, zero where a contact begins):
///   F_T = -(sigma0 z + sigma1 z' + sigma2 v) F_N,  z' = v - sigma0 |v| z/g(v)
///   g = mu_k + (mu_s - mu_k) exp(-(v/v_st)^2)
/// with slip speed v [m/s], normal force F_N [N], coefficients mu_s >= mu_k > 0, Stribeck speed v_st [m/s], and per
/// normal force the stiffness sigma0 [1/m], damping sigma1 [s/m] and viscous coefficient sigma2 [s/m]. Steady slip has
/// z = g sign(v)/sigma0; |z| stays below mu_s/sigma0. Canudas de Wit, Olsson, Astrom and Lischinsky 1995.
class Lugre final : public FrictionLaw {
 public:
  explicit Lugre(const Parameters& p)
      : mu_s_(p.number("mu_s")),
        mu_k_(p.number("mu_k")),
        v_stribeck_(p.number("v_stribeck")),
        sigma0_(p.number("sigma0")),
        sigma1_(p.number("sigma1")),
        sigma2_(p.number("sigma2")) {
    require_order(mu_s_, mu_k_);
  }

  int internal_variables() const override { return 1; }

  FrictionForce evaluate(const FrictionState& state, Span<double> internal_rate) const override {
    const double v = state.slip_speed, z = state.internal[0], ratio = v / v_stribeck_;
    const double fall = (mu_s_ - mu_k_) * std::exp(-ratio * ratio), g = mu_k_ + fall;
    const double g_slope = -2.0 * ratio / v_stribeck_ * fall;
    const double decay = sigma0_ * std::abs(v) / g;  // [1/s]
    const double rate = v - decay * z;
    const double sign = v > 0.0 ? 1.0 : v < 0.0 ? -1.0 : 0.0;
    const double rate_slope = 1.0 - (sigma0_ * sign - decay * g_slope) * z / g;
    internal_rate[0] = rate;
    return friction_force({sigma0_ * z + sigma1_ * rate + sigma2_ * v, sigma1_ * rate_slope + sigma2_}, state);
  }
  /// The decay of the bristles has one where slip changes its direction.
  Span<const double> kinks() const override { return at_rest; }

 private:
  static constexpr double at_rest[] = {0.0};
  double mu_s_, mu_k_, v_stribeck_, sigma0_, sigma1_, sigma2_;
};

constexpr Parameter lugre_parameters[] = {
    static_parameter,
    {.name = "mu_k", .minimum = 0.0, .open = Open::minimum, .summary = "Kinetic coefficient of friction."},
    stribeck_speed_parameter,
    {.name = "sigma0",
     .unit = "1/m",
     .minimum = 0.0,
     .open = Open::minimum,
     .summary = "Stiffness of the bristles over the normal force."},
    {.name = "sigma1",
     .unit = "s/m",
     .default_value = 0.0,
     .minimum = 0.0,
     .summary = "Damping of the bristles over the normal force."},
    {.name = "sigma2",
     .unit = "s/m",
     .default_value = 0.0,
     .minimum = 0.0,
     .summary = "Viscous coefficient over the normal force."},
};

}  // namespace

Component lugre() {
  return friction_law<Lugre>(
      {.name = "lugre",
       .summary = "Friction by the deflection of bristles: sticks, creeps and slides, with memory.",
       .formula = "F_T = -(sigma0 z + sigma1 z' + sigma2 v) F_N; z' = v - sigma0 |v| z/g, g = mu_k + (mu_s - mu_k) "
                  "exp(-(v/v_stribeck)^2); z in m.",
       .validity = "Implicit integrators or small steps: z decays with the rate sigma0 |v|/g. With a large sigma1 the "
                   "force may drive the slip for a short time.",
       .references = "Canudas de Wit, Olsson, Astrom and Lischinsky 1995, IEEE Trans Autom Control 40, 419-425",
       .parameters = lugre_parameters});
}

}  // namespace freeplay
