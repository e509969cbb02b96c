// RowGrid: which rows of a result stand at equal distances.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace freeplay {

/// The rows of a result on its output grid, from the time that counts on.
struct RowGrid {
  double interval = 0.0;          ///< between neighbours [s]
  std::vector<std::size_t> rows;  ///< the last ones without a gap

  /// Instants rise. Grid: `origin` + k `interval`, from `from` on, to 1e-9 of the interval; of rows with gaps those
  /// after the last gap. An interval of 0: it is not known, and is the one met most between rows.
  static RowGrid of(std::span<const double> time, double origin, double from, double interval);
};

}  // namespace freeplay
