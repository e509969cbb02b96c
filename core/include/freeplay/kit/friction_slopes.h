// Derivatives that laws of friction do not give: those of z' and those by z.
#pragma once

#include <algorithm>
#include <cmath>

#include "freeplay/plugin.h"

namespace freeplay::play {

/// Internal variables that a friction law may have in a joint: derivatives are made on the stack.
inline constexpr std::size_t most_internal_variables = 8;

/// Central differences of one law at one state.
class FrictionSlopes {
 public:
  FrictionSlopes(const FrictionLawRef& law, double normal_force, double slip, Span<const double> z)
      : law_(law), state_{normal_force, slip, {z_, z.size}} {
    std::copy(z.begin(), z.end(), z_);
  }
  FrictionSlopes(const FrictionSlopes&) = delete;
  FrictionSlopes& operator=(const FrictionSlopes&) = delete;

  /// dF_T by what the name says; rates() then are dz' by the same.
  double by_normal_force() { return by(state_.normal_force, 1.0); }
  double by_slip() { return by(state_.slip_speed, 1e-3); }
  double by_variable(std::size_t k) { return by(z_[k], 1e-6); }
  const double* rates() const { return high_; }

 private:
  double by(double& x, double scale) {
    const std::size_t n = state_.internal.size;
    const double middle = x, step = 1e-5 * std::max(std::abs(x), scale);
    x = middle + step;
    const double above = law_.evaluate(state_, {high_, n}).tangential;
    x = middle - step;
    const double below = law_.evaluate(state_, {low_, n}).tangential;
    x = middle;
    for (std::size_t i = 0; i < n; ++i) high_[i] = (high_[i] - low_[i]) / (2.0 * step);
    return (above - below) / (2.0 * step);
  }

  const FrictionLawRef& law_;
  double z_[most_internal_variables], high_[most_internal_variables], low_[most_internal_variables];
  FrictionState state_;
};

}  // namespace freeplay::play
