// Divergence: how fast neighbouring parts of a motion go apart; an estimate of its largest Lyapunov exponent.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "results/row_grid.h"

namespace freeplay {

struct Divergence {
  std::vector<double> time;       ///< k D, k = 0 .. K [s]
  std::vector<double> logarithm;  ///< mean of the logarithm of distances; NaN where all are zero
  double exponent = 0.0;          ///< slope of the line of least squares [1/s]
  /// Of the exponent: by the scatter among eighths of the motion, and by how far the logarithms are from a straight
  /// line, as where the period is so long that distances reach the size of the motion. NaN with fewer than two eighths,
  /// and where the period is one step: nothing says then whether the line is straight.
  double uncertainty = 0.0;
  std::size_t points = 0;  ///< that have a neighbour
};

/// Rosenstein, Collins, De Luca 1993. Points are the columns divided by their standard deviations, at every m-th row of
/// the grid, m = ceil(n/5000), at a distance of D; K = round(period/D). Each point i < n - K goes with the nearest
/// j < n - K with |i - j| D > period; equally near ones: the first. Columns that do not change are left out, as are
/// those with NaN. Throws Error{numerical} "too-few-rows" where no line can be drawn.
Divergence divergence(const RowGrid& grid, std::span<const std::span<const double>> columns, double period);

}  // namespace freeplay
