// DifferenceSum: how far one column of two tables is apart, row by row.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "results/comparison.h"

namespace freeplay {

/// Adds up how far one channel, or a place of two or three, is apart.
class DifferenceSum {
 public:
  /// `columns`: places in the rows, whose first number is where they are: a time, or the number of a point.
  DifferenceSum(std::string name, std::vector<std::size_t> columns) : columns_(std::move(columns)) {
    difference_.name = std::move(name);
  }

  void add(std::span<const double> a, std::span<const double> b) {
    if (std::isnan(difference_.largest)) return;
    double off[3], value[3];
    std::size_t known = 0;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const double x = a[columns_[i]], y = b[columns_[i]];
      const bool nothing = std::isnan(x) && std::isnan(y);
      off[i] = nothing || x == y ? 0.0 : x - y;
      value[i] = nothing ? 0.0 : x;
      known += nothing ? 0 : 1;
    }
    if (known == 0) return;
    size_ = std::fmax(size_, length({value, columns_.size()}));
    const double apart = length({off, columns_.size()});
    squares_ += apart * apart;
    if (!(apart <= difference_.largest)) difference_.largest = apart, difference_.at_time = a.front();
  }

  const std::string& name() const { return difference_.name; }
  double squares() const { return squares_; }
  double allowed(const ComparisonRules& rules) const { return rules.absolute + rules.relative * size_; }
  std::span<const std::size_t> columns() const { return columns_; }

  /// `agrees` as a channel does.
  Difference difference(std::size_t rows, const ComparisonRules& rules) const {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    Difference out = difference_;
    out.relative = out.largest == 0.0 ? 0.0 : out.largest / size_;
    out.rms = std::sqrt(squares_ / static_cast<double>(rows));
    if (rows == 0) out.largest = out.relative = out.at_time = nan;
    out.agrees = out.largest <= allowed(rules);
    return out;
  }

 private:
  static double length(std::span<const double> vector) {
    return vector.size() == 1   ? std::abs(vector[0])
           : vector.size() == 2 ? std::hypot(vector[0], vector[1])
                                : std::hypot(vector[0], vector[1], vector[2]);
  }

  Difference difference_;
  std::vector<std::size_t> columns_;
  double size_ = 0.0, squares_ = 0.0;
};

/// Of a difference beside what is allowed: larger is worse; what has no number is worst.
inline double weight(double amount, double allowed) {
  if (std::isnan(amount)) return std::numeric_limits<double>::infinity();
  return amount == 0.0 ? 0.0 : amount / allowed;
}

inline std::vector<Difference> worst_first(std::span<const Difference> list, std::span<const double> weights) {
  std::vector<std::size_t> order(list.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, [&](std::size_t i, std::size_t k) { return weights[i] > weights[k]; });
  std::vector<Difference> sorted;
  for (const std::size_t i : order) sorted.push_back(list[i]);
  return sorted;
}

}  // namespace freeplay
