// IntegralFromZero: the energy that a force stores of which no integral is known, as that of a formula.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <exception>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

namespace freeplay {

/// F(x) = integral of f from 0 to x, to 1e-10 of the area below |f|. Made once, as polynomials on cells of which each
/// ends twice as far from 0 as the one before and is cut where f is not smooth, so that a small x keeps its digits; a
/// value costs no call of f. What is smooth and lasts less than a 256th of such a cell may be missed, and so are
/// periods below a 2000th of it. Immutable once it is made.
class IntegralFromZero {
 public:
  IntegralFromZero() = default;
  /// From 0 to `end`, which may be negative. The first cell ends at |x| = `first` and is never cut: what it adds need
  /// not be known as well. `f` may throw where it has no value. Cells end at `corners`, where f has kinks or jumps:
  /// between these nothing is too short.
  IntegralFromZero(std::function<double(double)> f, double first, double end, std::vector<double> corners = {})
      : f_(std::move(f)), sign_(end < 0.0 ? -1.0 : 1.0) {
    for (double& corner : corners) corner *= sign_;
    std::sort(corners.begin(), corners.end());
    double from = 0.0;
    for (double to = first; from < sign_ * end && whole_; to *= 2.0) {
      fine_cells_ = 0;
      nothing_ = rounded * largest(from, to);
      const auto corner = std::upper_bound(corners.begin(), corners.end(), from);
      const auto last = std::lower_bound(corner, corners.end(), to);
      const int cuts =
          from > 0.0 ? static_cast<int>(std::bit_width(static_cast<std::size_t>(last - corner))) : most_cuts;
      for (auto i = corner; i < last; from = *i++) add(from, *i, cuts);
      add(from, to, cuts);
      from = to;
    }
  }

  /// Of 0 and all that lies between it and `end`. Beyond, and where a part of f has no value, by quadrature from there;
  /// throws where that part counts.
  double at(double x) const {
    const double u = sign_ * x;
    if (!(u > 0.0)) return 0.0;
    if (!(u <= end_)) return total_ + beyond(end_, u);
    const auto after = std::upper_bound(starts_.begin(), starts_.end(), u);
    const auto index = static_cast<std::size_t>(after - starts_.begin()) - 1;
    const double from = starts_[index], to = index + 1 < starts_.size() ? starts_[index + 1] : end_;
    return cells_[index].value((2.0 * u - from - to) / (to - from));
  }

 private:
  static constexpr std::size_t nodes = 14;
  // A period of f may be a 2000th of a doubling. Finer cells are for its kinks: where it is mere rounding none is
  // smooth.
  static constexpr int coarse_cuts = 13, most_fine_cells = 128;
  static constexpr int most_cuts = 40, most_cuts_at_end = 10;
  static constexpr int checks = 256;  // of an uncut cell, for what its nodes may have missed
  static constexpr double seen = 1e-6, end_of_cell = 1.0 - 1e-9;
  static constexpr double rounded = 1e-15;  // of the largest f in a doubling: less is nothing, as where exp underflows

  /// F over a cell, by powers of t from -1 to 1.
  struct Cell {
    std::array<double, nodes + 1> c;
    double value(double t) const {
      double sum = c[nodes];
      for (std::size_t k = nodes; k > 0; --k) sum = c[k - 1] + t * sum;
      return sum;
    }
    double slope(double t) const {
      double sum = static_cast<double>(nodes) * c[nodes];
      for (std::size_t k = nodes - 1; k > 0; --k) sum = static_cast<double>(k) * c[k] + t * sum;
      return sum;
    }
  };

  double force(double u) const { return sign_ * f_(sign_ * u); }

  /// The largest |f| that is seen.
  [[gnu::cold]] double largest(double from, double to) const {
    double out = 0.0;
    try {
      for (int i = 0; i < checks; ++i) out = std::max(out, std::abs(force(from + (i + 0.5) / checks * (to - from))));
    } catch (const std::exception&) {
      // what is seen before it has no value has to do
    }
    return out;
  }

  /// T_k at the zeros of T_nodes.
  using Polynomials = std::array<std::array<double, nodes>, nodes>;
  static const Polynomials& polynomials() {
    static const Polynomials all = [] {
      constexpr double pi = 3.14159265358979323846;
      Polynomials p{};
      for (std::size_t k = 0; k < nodes; ++k) {
        for (std::size_t j = 0; j < nodes; ++j) {
          p[k][j] = std::cos(static_cast<double>(k) * (static_cast<double>(j) + 0.5) * pi / static_cast<double>(nodes));
        }
      }
      return p;
    }();
    return all;
  }

  /// Cuts [from, to] until f is a polynomial in each part, or has no value in what is left.
  [[gnu::cold]] void add(double from, double to, int cuts) {
    if (!whole_) return;
    std::array<double, nodes> f;
    bool good = true;
    try {
      for (std::size_t j = 0; j < nodes; ++j) f[j] = force(0.5 * (from + to) + 0.5 * (to - from) * polynomials()[1][j]);
    } catch (const std::exception&) {
      good = false;
    }
    Cell cell;
    const bool smooth = good && expand(f, from, to, cell) && shows(cell, from, to, cuts < 8 ? checks >> cuts : 0);
    const bool last = cuts >= (good ? most_cuts : most_cuts_at_end) || fine_cells_ >= most_fine_cells;
    if (!smooth && !last) {
      const double middle = 0.5 * (from + to);
      add(from, middle, cuts + 1);
      add(middle, to, cuts + 1);
      return;
    }
    whole_ = good;
    if (!good) return;
    cell.c[0] = 0.0;
    cell.c[0] = total_ - cell.value(-1.0);
    starts_.push_back(from);
    cells_.push_back(cell);
    if (cuts > coarse_cuts) ++fine_cells_;
    end_ = to;
    total_ = cell.value(1.0);
  }

  /// The integral's series, but for its constant, from values of f at the zeros of the Chebyshev polynomial. Whether f
  /// has as many digits as it should.
  [[gnu::cold]] bool expand(const std::array<double, nodes>& f, double from, double to, Cell& cell) const {
    std::array<double, nodes + 2> a{};
    const double half = 0.5 * (to - from);
    const auto [low, high] = std::minmax_element(f.begin(), f.end());
    const double largest = std::max(std::abs(*low), std::abs(*high));
    // What f is off by where its argument is rounded.
    const double rounding = 4.0 * std::numeric_limits<double>::epsilon() * to * (*high - *low) / half;
    for (std::size_t k = 0; k < nodes; ++k) {
      for (std::size_t j = 0; j < nodes; ++j) a[k] += f[j] * polynomials()[k][j];
      a[k] *= 2.0 / static_cast<double>(nodes);
    }
    // Of T_k by its powers: T_k = 2 t T_(k-1) - T_(k-2).
    std::array<double, nodes + 1> before{1.0}, now{0.0, 1.0};
    cell.c = {};
    for (std::size_t k = 1; k <= nodes; ++k) {
      const double of_k = half * (a[k - 1] - a[k + 1]) / (2.0 * static_cast<double>(k));
      std::array<double, nodes + 1> next{};
      for (std::size_t i = 0; i <= k; ++i) {
        cell.c[i] += of_k * now[i];
        next[i] = (i > 0 ? 2.0 * now[i - 1] : 0.0) - before[i];
      }
      if (k < nodes) next[k + 1] = 2.0 * now[k];
      before = now;
      now = next;
    }
    return std::abs(a[nodes - 1]) + std::abs(a[nodes - 2]) <= 1e-10 * largest + rounding + nothing_;
  }

  /// Whether f is between the nodes and beyond the last ones what the cell says. Where it has no value the cell has to
  /// do.
  [[gnu::cold]] bool shows(const Cell& cell, double from, double to, int count) const {
    const double half = 0.5 * (to - from);
    double largest = 0.0, off = 0.0;
    try {
      for (int i = -2; i < count; ++i) {
        const double t = i < 0 ? (2.0 * i + 3.0) * end_of_cell : (2.0 * i + 1.0) / count - 1.0;
        const double f = force(from + half * (1.0 + t));
        largest = std::max(largest, std::abs(f));
        off = std::max(off, std::abs(f - cell.slope(t) / half));
      }
    } catch (const std::exception&) {
      return true;
    }
    return off <= seen * largest + nothing_;
  }

  double beyond(double from, double to) const {
    constexpr double x[] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
    constexpr double w[] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
    const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
    double sum = 0.0;
    for (std::size_t i = 0; i < 4; ++i) sum += w[i] * (force(middle - half * x[i]) + force(middle + half * x[i]));
    return half * sum;
  }

  std::function<double(double)> f_;
  double sign_ = 1.0, end_ = 0.0, total_ = 0.0, nothing_ = 0.0;
  bool whole_ = true;
  int fine_cells_ = 0;  // of the doubling
  std::vector<double> starts_;
  std::vector<Cell> cells_;
};

}  // namespace freeplay
