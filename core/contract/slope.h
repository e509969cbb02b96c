// Slope: the derivative of a vector of functions of one number, found by differences, with an estimate of its error.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace freeplay {

struct Slope {
  std::vector<double> value, error;
};

/// Differences to both sides, or to one where a kink is nearer than any step.
enum class Side { both, above, below };

/// Derivative at 0 of `f(x)`, which returns a vector of a fixed size or an empty one when it fails; `largest` is the
/// largest step tried. Differences for a sequence of steps, each a quarter of the last; of neighbours that
/// agree best the extrapolation is taken. So neither the scale of f nor a kink at some distance has to be known.
/// `error` counts the disagreement and the rounding of f; at a kink it is large. `made_of`: sizes of the terms that the
/// values of f are differences of, where these are known to be larger than the values.
template <class Function>
Slope slope(Function&& f, double largest, Side side = Side::both, const std::vector<double>& made_of = {}) {
  constexpr int steps = 15;
  const double up = side == Side::below ? 0.0 : 1.0, down = side == Side::above ? 0.0 : 1.0;
  const double order = side == Side::both ? 16.0 : 4.0;  // what a quarter of the step makes of the error
  const auto difference = [&](double h, std::vector<double>& size) {
    const std::vector<double> high = f(up * h), low = f(-down * h);
    std::vector<double> d(std::min(high.size(), low.size()));
    size.assign(d.size(), 0.0);
    for (std::size_t i = 0; i < d.size(); ++i) {
      d[i] = (high[i] - low[i]) / ((up + down) * h);
      size[i] = std::max(std::abs(high[i]), std::abs(low[i]));
    }
    return d;
  };
  std::vector<double> size, fine_size;
  double h = largest;
  std::vector<double> coarse = difference(h, size);
  Slope best{coarse, std::vector<double>(coarse.size(), std::numeric_limits<double>::infinity())};
  for (int k = 1; k < steps; ++k) {
    h *= 0.25;
    const std::vector<double> fine = difference(h, fine_size);
    for (std::size_t i = 0; i < std::min(fine.size(), best.value.size()); ++i) {
      const double terms = i < made_of.size() ? std::max(fine_size[i], made_of[i]) : fine_size[i];
      const double rounding = 4.0 * std::numeric_limits<double>::epsilon() * terms / h;
      const double error = std::abs(fine[i] - coarse[i]) + rounding;
      if (!(error <= best.error[i])) continue;
      best.value[i] = (order * fine[i] - coarse[i]) / (order - 1.0);
      best.error[i] = error;
    }
    coarse = fine;
  }
  return best;
}

/// Does a derivative that a component gives agree with its slope? `scale`: size of the numbers it is one of.
inline bool agrees(double given, double value, double error, double scale) {
  // 1e-6 is what differences of functions with cancellation reach; a wrong term is far above.
  return std::abs(given - value) <= 1e-6 * scale + 20.0 * error;
}

}  // namespace freeplay
