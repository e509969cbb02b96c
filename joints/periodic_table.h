// A function that comes again after one turn, as polynomials: what is asked in every step costs no formula then.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace freeplay::curves {

inline constexpr double whole_turn = 2.0 * std::numbers::pi;

/// Polynomials of the fifth degree that have value and slope of a function at both ends of a piece and in its middle.
/// Pieces are halved until they keep to the function: it is met to 1e-13 of its size, with its slopes, and polynomials
/// up to the fifth degree between places that are named are met exactly.
class PeriodicTable {
 public:
  struct Sample {
    double value, slope;
  };
  struct At {
    double value, slope, bend;
  };
  enum class Flaw { none, jump, corner, rough };
  struct Outcome {
    Flaw flaw = Flaw::none;
    double place = 0.0;  ///< where [rad]
  };

  /// `f(x)` is a Sample for x from 0 to one turn; `places`, between both, where its second derivative may jump; `size`
  /// of its values. What f throws passes.
  template <class Function>
  Outcome make(const Function& f, std::vector<double> places, double size) {
    constexpr int parts = 64;
    pieces_.clear();
    Outcome outcome;
    for (int i = 0; i <= parts; ++i) places.push_back(whole_turn * i / parts);
    std::sort(places.begin(), places.end());
    const Sample first = f(0.0), last = f(whole_turn);
    compare(first, last, size, 0.0, outcome);
    Sample from = first;
    for (std::size_t i = 1; i < places.size() && outcome.flaw == Flaw::none; ++i) {
      if (!(places[i] - places[i - 1] > least_width)) continue;
      const Sample to = f(places[i]);
      add(f, places[i - 1], from, places[i], to, size, outcome);
      from = to;
    }
    index();
    return outcome;
  }

  At at(double x) const {
    x -= whole_turn * std::floor(x / whole_turn);
    const auto bin = std::min(static_cast<std::size_t>(x * (bins / whole_turn)), bins - 1);
    std::size_t i = first_[bin];
    while (i < first_[bin + 1] && pieces_[i + 1].from <= x) ++i;
    return at(i, (x - pieces_[i].from) * pieces_[i].per_width);
  }

  std::size_t pieces() const { return pieces_.size(); }
  /// Where in the turn a part of a piece is, from 0 to 1.
  double place(std::size_t piece, double part) const { return pieces_[piece].from + part / pieces_[piece].per_width; }
  At at(std::size_t piece, double part) const {
    const Piece& p = pieces_[piece];
    double value = p.shares[5], slope = 0.0, half_bend = 0.0;
    for (std::size_t k = 5; k-- > 0;) {
      const double x = part - nodes[k];
      half_bend = half_bend * x + slope;
      slope = slope * x + value;
      value = value * x + p.shares[k];
    }
    return {value, slope * p.per_width, 2.0 * half_bend * p.per_width * p.per_width};
  }

 private:
  static constexpr std::size_t bins = 1024, most_pieces = 200000;
  static constexpr double least_width = 1e-12, width_of_corner = 1e-7;  // [rad]
  static constexpr double tolerance = 1e-13;                            // of the size
  static constexpr std::array<double, 6> nodes{0.0, 0.0, 0.5, 0.5, 1.0, 1.0};

  struct Piece {
    double from, per_width;
    std::array<double, 6> shares;  ///< divided differences of Hermite's interpolation at `nodes`
  };

  static Piece fit(double from, const Sample& low, const Sample& middle, double to, const Sample& high) {
    const double width = to - from;
    std::array<double, 6> d{low.value, low.value, middle.value, middle.value, high.value, high.value};
    const std::array<double, 3> slopes{width * low.slope, width * middle.slope, width * high.slope};
    for (std::size_t order = 1; order < d.size(); ++order) {
      for (std::size_t k = d.size() - 1; k >= order; --k) {
        const bool double_node = order == 1 && k % 2 == 1;
        d[k] = double_node ? slopes[k / 2] : (d[k] - d[k - 1]) / (nodes[k] - nodes[k - order]);
      }
    }
    return {from, 1.0 / width, d};
  }

  /// What f is on both sides of a place, or of one that is hardly wide.
  static void compare(const Sample& low, const Sample& high, double size, double place, Outcome& outcome) {
    constexpr double jump = 1e-6, corner = 1e-3;
    if (!(std::abs(high.value - low.value) <= jump * size)) {
      outcome = {Flaw::jump, place};
    } else if (!(std::abs(high.slope - low.slope) <= corner * size)) {
      outcome = {Flaw::corner, place};
    }
  }

  template <class Function>
  void add(const Function& f, double from, const Sample& low, double to, const Sample& high, double size,
           Outcome& outcome) {
    if (outcome.flaw != Flaw::none) return;
    const double middle = 0.5 * (from + to);
    const Sample between = f(middle);
    pieces_.push_back(fit(from, low, between, to, high));
    const auto keeps = [&](double part) {
      const double off = at(pieces_.size() - 1, part).value - f(from + part * (to - from)).value;
      return std::abs(off) <= tolerance * size;
    };
    if (keeps(0.25) && keeps(0.75)) return;
    if (to - from < width_of_corner) return compare(low, high, size, middle, outcome);
    pieces_.pop_back();
    if (pieces_.size() > most_pieces) {
      outcome = {Flaw::rough, middle};
      return;
    }
    add(f, from, low, middle, between, size, outcome);
    add(f, middle, between, to, high, size, outcome);
  }

  /// For each bin the piece in which it begins.
  void index() {
    std::size_t i = 0;
    for (std::size_t bin = 0; bin <= bins; ++bin) {
      const double begin = whole_turn * static_cast<double>(bin) / bins;
      while (i + 1 < pieces_.size() && pieces_[i + 1].from <= begin) ++i;
      first_[bin] = i;
    }
  }

  std::vector<Piece> pieces_;
  std::array<std::size_t, bins + 1> first_{};
};

}  // namespace freeplay::curves
