// Eigenvalues, in a file of their own because they take long to compile.
#pragma once

#include <array>

namespace freeplay::test {

/// Largest absolute eigenvalue of a 3x3 matrix, row-major.
double largest_eigenvalue(const std::array<double, 9>& matrix);

}  // namespace freeplay::test
