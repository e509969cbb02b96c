// Friction coefficient: what the friction laws without memory have in common.
#pragma once

#include "freeplay/friction_law.h"

namespace freeplay {

/// mu_eff at a slip speed, odd in it, and its derivative.
struct FrictionCoefficient {
  double value;  ///< [1]
  double slope;  ///< [s/m]
};

/// F_T = -mu_eff F_N.
inline FrictionForce friction_force(const FrictionCoefficient& mu, const FrictionState& state) {
  return {-mu.value * state.normal_force, -mu.value, -mu.slope * state.normal_force};
}

inline constexpr Parameter coefficient_parameter{.name = "mu", .minimum = 0.0, .summary = "Coefficient of friction."};
inline constexpr Parameter static_parameter{
    .name = "mu_s", .minimum = 0.0, .summary = "Static coefficient of friction; not below mu_k."};
inline constexpr Parameter kinetic_parameter{
    .name = "mu_k", .minimum = 0.0, .summary = "Kinetic coefficient of friction."};
inline constexpr Parameter smoothing_parameter{.name = "vs",
                                               .unit = "m/s",
                                               .default_value = 1e-3,
                                               .minimum = 0.0,
                                               .open = Open::minimum,
                                               .summary = "Slip speed that smooths the change of sign."};
inline constexpr Parameter stribeck_speed_parameter{
    .name = "v_stribeck",
    .unit = "m/s",
    .minimum = 0.0,
    .open = Open::minimum,
    .summary = "Slip speed at which static turns into kinetic friction."};

/// Throws BadParameter when the static coefficient is below the kinetic one.
inline void require_order(double mu_s, double mu_k) {
  if (mu_s < mu_k) throw BadParameter("mu_s", "out-of-range", "'mu_s' must not be below 'mu_k'");
}

}  // namespace freeplay
