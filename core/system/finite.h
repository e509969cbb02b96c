// Whether what a joint returned is made of finite numbers.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "freeplay/joint.h"
#include "system/joint_ends.h"
#include "system/markers.h"

namespace freeplay {

// A sum is finite only if every term is; differences of infinities are not finite either.

/// Zero only if no force acts.
inline double size_of(const JointForces& f) {
  double sums[2] = {};  // two sums do not wait for each other
  for (int i = 0; i < 6; i += 2) {
    sums[0] += std::abs(f.wrench_a[i]) + std::abs(f.wrench_b[i]);
    sums[1] += std::abs(f.wrench_a[i + 1]) + std::abs(f.wrench_b[i + 1]);
  }
  return sums[0] + sums[1];
}
/// Whether every number is zero, without a sign: cheaper than size_of(), as most joints with play do not act.
inline bool rests(const JointForces& f) {
  // One by one: what was written number by number is slow to read in pairs.
  for (const double* part : {f.wrench_a, f.wrench_b}) {
    for (int i = 0; i < 6; ++i) {
      if (std::bit_cast<std::uint64_t>(part[i]) != 0) return false;
    }
  }
  return true;
}
/// Finite only if the numbers of energy are that were given.
inline double energy_of(const JointForces& f) {
  return f.potential + (std::isnan(f.potential_rate) ? 0.0 : f.potential_rate);
}
inline bool is_finite(Span<const double> numbers) {
  double sum[4] = {};  // four sums do not wait for each other
  std::size_t i = 0;
  for (; i + 4 <= numbers.size; i += 4) {
    for (std::size_t k = 0; k < 4; ++k) sum[k] += numbers[i + k];
  }
  for (; i < numbers.size; ++i) sum[0] += numbers[i];
  return std::isfinite((sum[0] + sum[1]) + (sum[2] + sum[3]));
}
inline bool is_finite(const MarkerKinematics& k) {
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) sum += k.position[i] + k.velocity[i] + k.angular_velocity[i];
  return std::isfinite(sum);
}
/// Whether the markers of a joint are: else its answer may be anything.
inline bool are_finite(const JointEnds& ends, const MarkerValues& values) {
  return is_finite(values.markers[static_cast<std::size_t>(ends.marker_a)]) &&
         is_finite(values.markers[static_cast<std::size_t>(ends.marker_b)]);
}

}  // namespace freeplay
