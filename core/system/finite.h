// Whether what a joint returned is made of finite numbers.
#pragma once

#include <cmath>

#include "freeplay/joint.h"

namespace freeplay {

// A sum is finite only if every term is; differences of infinities are not finite either.
inline bool is_finite(const JointForces& f) {
  double sum = f.potential + (std::isnan(f.potential_rate) ? 0.0 : f.potential_rate);
  for (int i = 0; i < 6; ++i) sum += f.wrench_a[i] + f.wrench_b[i];
  return std::isfinite(sum);
}
inline bool is_finite(Span<double> numbers) {
  double sum = 0.0;
  for (const double x : numbers) sum += x;
  return std::isfinite(sum);
}
inline bool is_finite(const ConstraintRows& rows) {
  return is_finite(rows.phi) && is_finite(rows.jacobian) && is_finite(rows.nu) && is_finite(rows.gamma);
}
inline bool is_finite(const MarkerKinematics& k) {
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) sum += k.position[i] + k.velocity[i] + k.angular_velocity[i];
  return std::isfinite(sum);
}

}  // namespace freeplay
