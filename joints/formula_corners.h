// Where a formula of one variable changes its form.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "freeplay/plugin.h"

namespace freeplay {

/// The places x, `least` <= |x| <= `most`, where one of the functions that decide which form a formula has passes zero:
/// of straight ones all; of others those between neighbouring places of a grid of 32 in each doubling of |x| and the
/// places that are known, as the sides of a tent beside its top.
class FormulaCorners {
 public:
  [[gnu::cold]] static std::vector<double> of(const Formula& formula, double least, double most) {
    FormulaCorners own(formula);
    if (own.count_ == 0 || own.straight_ones()) return own.found_;
    for (double to = least; to < most; to *= 2.0) {
      for (int i = 0; i < of_doubling; ++i) {
        const double x = to * (1.0 + static_cast<double>(i) / of_doubling);
        own.places_.insert(own.places_.end(), {x, -x});
      }
    }
    own.places_.push_back(0.0);
    own.places_.insert(own.places_.end(), own.found_.begin(), own.found_.end());
    for (int pass = 0; pass < most_passes && own.seek(); ++pass) {
    }
    return own.found_;
  }

 private:
  static constexpr int of_doubling = 32, most_passes = 4, most_halvings = 100;
  static constexpr double beside = 1e-12;  // of a place, relative: it is found again

  explicit FormulaCorners(const Formula& formula)
      : formula_(formula), count_(static_cast<std::size_t>(formula.switches())) {}

  std::vector<double> decide(double x) const {
    std::vector<double> out(count_);
    formula_.decide({&x, 1}, {out.data(), count_});
    return out;
  }

  /// Notes where straight ones pass zero, as x - 0.1 in abs(x - 0.1) and at points of a table. Whether all are.
  [[gnu::cold]] bool straight_ones() {
    const std::vector<double> at_zero = decide(0.0), at_one = decide(1.0), below = decide(-0.7), above = decide(3.1);
    bool all = true;
    for (std::size_t i = 0; i < count_; ++i) {
      const double a = at_zero[i], slope = at_one[i] - a, size = 1e-9 * (std::abs(a) + std::abs(slope));
      if (std::abs(below[i] - (a - 0.7 * slope)) <= size && std::abs(above[i] - (a + 3.1 * slope)) <= size) {
        if (std::isfinite(a / slope)) found_.push_back(-a / slope);
      } else {
        all = false;
      }
    }
    return all;
  }

  /// One more look between all neighbours. False where nothing is new.
  [[gnu::cold]] bool seek() {
    std::sort(places_.begin(), places_.end());
    std::vector<double> fresh;
    std::vector<double> before = decide(places_.front());
    for (std::size_t k = 1; k < places_.size(); ++k) {
      const std::vector<double> here = decide(places_[k]);
      for (std::size_t i = 0; i < count_; ++i) {
        if ((before[i] >= 0.0) == (here[i] >= 0.0)) continue;
        const double x = zero(i, places_[k - 1], places_[k], before[i] >= 0.0);
        if (std::abs(x - places_[k - 1]) > beside * std::abs(x) && std::abs(x - places_[k]) > beside * std::abs(x))
          fresh.push_back(x);
      }
      before = here;
    }
    found_.insert(found_.end(), fresh.begin(), fresh.end());
    places_.insert(places_.end(), fresh.begin(), fresh.end());
    return !fresh.empty();
  }

  double zero(std::size_t i, double from, double to, bool side) const {
    for (int halving = 0; halving < most_halvings; ++halving) {
      const double middle = 0.5 * (from + to);
      if (!(middle > from && middle < to)) break;
      ((decide(middle)[i] >= 0.0) == side ? from : to) = middle;
    }
    return 0.5 * (from + to);
  }

  const Formula& formula_;
  std::size_t count_;
  std::vector<double> places_, found_;
};

}  // namespace freeplay
