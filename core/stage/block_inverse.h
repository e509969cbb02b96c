// The inverse of the small block that prescribes a body, and how regular the block is.
#pragma once

#include <cmath>

#include <Eigen/LU>

namespace freeplay {

/// The entries of `inverse` by columns. Returns 1 over the product of the largest entries of both, 0 for a singular
/// one.
template <int width>
double invert_block(const Eigen::Matrix<double, width, width>& block, double* inverse) {
  // In pairs, so that no comparison waits for all those before.
  const auto largest_entry = [](const auto& m) {
    double by_column[width];
    for (int c = 0; c < width; ++c) {
      by_column[c] = std::abs(m(0, c));
      for (int r = 1; r < width; ++r) {
        by_column[c] = by_column[c] > std::abs(m(r, c)) ? by_column[c] : std::abs(m(r, c));
      }
    }
    for (int c = 1; c < width; ++c) by_column[0] = by_column[0] > by_column[c] ? by_column[0] : by_column[c];
    return by_column[0];
  };
  Eigen::Map<Eigen::Matrix<double, width, width>> out(inverse);
  out = block.inverse();
  const double size = largest_entry(block) * largest_entry(out);
  return size > 0.0 && std::isfinite(size) ? 1.0 / size : 0.0;
}

}  // namespace freeplay
