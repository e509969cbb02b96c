#include "run/event_finder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace freeplay {
namespace {
constexpr double farthest_lift = 0.15;  // 4/27, and no less by rounding
}  // namespace

std::optional<double> first_rise(const Hermite& curve, double from) {
  // Its slopes lift the cubic by at most 4/27 of each above the larger of its ends.
  const double lift = farthest_lift * (std::abs(curve.slope0) + std::abs(curve.slope1));
  if (std::max(curve.value0, curve.value1) < -lift) return std::nullopt;
  // Between the zeros of the derivative 3 a s^2 + 2 b s + c the cubic is monotone.
  const double a = 2.0 * (curve.value0 - curve.value1) + curve.slope0 + curve.slope1;
  const double b = 3.0 * (curve.value1 - curve.value0) - 2.0 * curve.slope0 - curve.slope1;
  const double c = curve.slope0;
  std::array<double, 4> ends{from, 1.0, 1.0, 1.0};
  int count = 1;
  const auto add = [&](double s) {
    if (s > from && s < 1.0) ends[static_cast<std::size_t>(count++)] = s;
  };
  const double root = b * b - 3.0 * a * c;
  if (root > 0.0) {
    const double q = -(b + std::copysign(std::sqrt(root), b));
    if (a != 0.0) add(q / (3.0 * a));
    if (q != 0.0) add(c / q);
  }
  if (count == 3 && ends[2] < ends[1]) std::swap(ends[1], ends[2]);
  ends[static_cast<std::size_t>(count)] = 1.0;
  for (int i = 0; i < count; ++i) {
    double low = ends[static_cast<std::size_t>(i)], high = ends[static_cast<std::size_t>(i) + 1];
    if (!(curve.at(low) <= 0.0 && curve.at(high) > 0.0)) continue;
    for (int halving = 0; halving < 60; ++halving) {
      const double middle = 0.5 * (low + high);
      (curve.at(middle) > 0.0 ? high : low) = middle;
    }
    return high;
  }
  return std::nullopt;
}

}  // namespace freeplay
