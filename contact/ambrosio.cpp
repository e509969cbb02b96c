#include <cmath>

#include "freeplay/plugin.h"

namespace freeplay {
namespace {

/// Coulomb friction with a ramp at low slip:
///   F_T = -mu c_d sign(v) F_N,  c_d = 0 for |v| <= v0, (|v| - v0)/(v1 - v0) between, 1 for |v| >= v1
/// with slip speed v [m/s], normal force F_N [N], coefficient mu, limits v0 < v1 [m/s]. The kinks lie at v0 and v1.
/// Ambrosio 2003, Impact of rigid and flexible multibody systems.
class Ambrosio final : public FrictionLaw {
 public:
  explicit Ambrosio(const Parameters& p) : mu_(p.number("mu")), kinks_{p.number("v0"), p.number("v1")} {
    if (!(kinks_[0] < kinks_[1])) throw BadParameter("v1", "out-of-range", "'v1' must be above 'v0'");
  }

  FrictionForce evaluate(const FrictionState& state, Span<double>) const override {
    const auto [v0, v1] = kinks_;
    const double speed = std::abs(state.slip_speed);
    if (speed <= v0) return {};
    const bool ramp = speed < v1;
    const double share = ramp ? (speed - v0) / (v1 - v0) : 1.0;
    const double coefficient = -std::copysign(mu_ * share, state.slip_speed);
    return {coefficient * state.normal_force, coefficient, ramp ? -mu_ * state.normal_force / (v1 - v0) : 0.0};
  }
  Span<const double> kinks() const override { return kinks_; }

 private:
  double mu_, kinks_[2];
};

constexpr Parameter ambrosio_parameters[] = {
    {.name = "mu", .minimum = 0.0, .summary = "Coefficient of friction."},
    {.name = "v0",
     .unit = "m/s",
     .default_value = 1e-4,
     .minimum = 0.0,
     .summary = "Slip speed up to which there is none."},
    {.name = "v1",
     .unit = "m/s",
     .default_value = 1e-3,
     .minimum = 0.0,
     .open = Open::minimum,
     .summary = "Slip speed from which it is full."},
};

}  // namespace

Component ambrosio() {
  return friction_law<Ambrosio>(
      {.name = "ambrosio",
       .summary = "Coulomb friction with a linear ramp between two slip speeds.",
       .formula = "F_T = -mu c_d sign(v) F_N; c_d = 0 for |v| <= v0, (|v| - v0)/(v1 - v0) between, 1 for |v| >= v1.",
       .validity = "Sliding; below v0 there is no force, so that nothing sticks.",
       .references = "Ambrosio 2003, in: Virtual Nonlinear Multibody Systems, Kluwer",
       .parameters = ambrosio_parameters});
}

}  // namespace freeplay
