// PoincareSection: channels of a result once a period.
#pragma once

#include <span>
#include <vector>

namespace freeplay {

struct PoincareSection {
  std::vector<double> time;                 ///< phase + k period
  std::vector<std::vector<double>> values;  ///< by column, by instant; straight between rows
  /// By column: the most that a parabola through rows around an instant differs from the straight line, NaN with fewer
  /// than three rows. An estimate of the error by interpolation.
  std::vector<double> uncertainty;
};

/// At the instants phase + k period, k = 0, 1 .., that rows reach. Instants rise; `period` > 0.
PoincareSection poincare_section(std::span<const double> time, std::span<const std::span<const double>> columns,
                                 double phase, double period);

}  // namespace freeplay
