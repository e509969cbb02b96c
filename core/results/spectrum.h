// Spectrum: amplitudes of the oscillations in channels of a result.
#pragma once

#include <span>
#include <vector>

#include "results/row_grid.h"

namespace freeplay {

/// An estimate: of rows of a finite time, by a Hann window.
struct Spectrum {
  std::vector<double> frequency;                ///< k/(n interval), k = 0 .. n/2 [Hz]
  std::vector<std::vector<double>> amplitudes;  ///< by channel, each in its unit, by frequency
  double resolution = 0.0;                      ///< width of a line at half its power, in which two lines are one [Hz]
};

/// Of the last n rows of the grid, n the largest 2^a 3^b 5^c, with w_i = (1 - cos(2 pi i/n))/2:
///   A_k = (2/sum w) |sum_i w_i (x_i - mean) e^(-2 pi j k i/n)|,  A_0 = 0
/// Columns are as long as the result. A channel with NaN in these rows has NaN everywhere. Throws Error{numerical}
/// "too-few-rows" below 16.
Spectrum spectrum(const RowGrid& grid, std::span<const std::span<const double>> columns);

}  // namespace freeplay
