// GridValues: the values that a grid of the model file or of the command line stands for.
#pragma once

#include <cmath>
#include <vector>

namespace freeplay {

/// Values in order, end points included, in SI.
struct GridValues {
  std::vector<double> list;  ///< where the values are written one by one
  double from = 0.0, to = 0.0;
  long count = 1;
  bool logarithmic = false;

  static GridValues one(double value) { return {{value}, value, value, 1, false}; }
  double value(long index) const {
    if (!list.empty()) return list[static_cast<std::size_t>(index)];
    if (index == count - 1 && count > 1) return to;  // free of rounding
    if (index == 0) return from;
    const double share = static_cast<double>(index) / static_cast<double>(count - 1);
    return logarithmic ? from * std::pow(to / from, share) : from + (to - from) * share;
  }
};

}  // namespace freeplay
