// Largest eigenvalue of a small matrix, without the solvers of Eigen, which take seven seconds to compile.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace freeplay::test {

/// Largest absolute eigenvalue of a 3x3 matrix, row-major: the limit of |A^n|^(1/n) (Gelfand 1941), with n = 2^40 by
/// repeated squares. What rounding adds to the logarithm doubles with n, so that the n-th root keeps all digits.
inline double largest_eigenvalue(std::array<double, 9> a) {
  double logarithm = 0.0, share = 1.0;  // of |A^n|, and 1/n
  for (int square = 0; square < 40; ++square) {
    double size = 0.0;
    for (const double x : a) size = std::max(size, std::abs(x));
    if (size == 0.0) return 0.0;
    logarithm += share * std::log(size);
    std::array<double, 9> next{};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t j = 0; j < 3; ++j) next[3 * i + k] += a[3 * i + j] / size * (a[3 * j + k] / size);
      }
    }
    a = next;
    share *= 0.5;
  }
  return std::exp(logarithm);
}

}  // namespace freeplay::test
