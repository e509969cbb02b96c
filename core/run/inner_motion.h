// InnerMotion: what the equations of motion say inside a step, beyond what its ends do.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace freeplay {

/// Corrections of the interpolation by the ends of a step (DenseStep), from accelerations and rates at three places
/// inside. With x = s - 1/2 and u = s (1 - s) at the fraction s:
///   u^3 (b_0 + b_1 x + b_2 x^2) for an increment, u^2 (r_0 + r_1 x + r_3 x^3) for an internal variable.
/// The increment is then of degree 8, with errors of order 9 in q and 8 in v. Enright, Jackson, Norsett and Thomsen
/// 1986, ACM Trans Math Softw 12, 193-218: the places are where the interpolation by the ends and the middle, whose
/// error is u^3 x, errs least in velocity.
class InnerMotion {
 public:
  static constexpr double offset = 0.18898223650461362;  // 1/sqrt(28)
  static constexpr std::array<double, 3> places = {0.5 - offset, 0.5, 0.5 + offset};
  static constexpr std::size_t middle = 1;

  /// Room for `increments` numbers of a motion and `rates` internal variables.
  InnerMotion(std::size_t increments, std::size_t rates);

  /// Another step is made: nothing is known of it.
  void forget() { known_ = false; }
  bool known() const { return known_; }

  /// What the interpolation by the ends misses at a place: dt^2 times the second derivative of the increment, and dt
  /// times the rate of the internal variables. To be filled before the next two.
  std::span<double> missing(std::size_t place) { return missing_[place]; }
  std::span<double> missing_rate(std::size_t place) { return missing_rate_[place]; }
  /// Corrections from what is missing in the middle alone, or at all places.
  void fit_middle();
  void fit();

  /// The polynomials of the corrections and the derivatives of the first by s.
  struct Weights {
    explicit Weights(double s);
    std::array<double, 3> position, velocity, acceleration, internal;
  };
  double increment(const std::array<double, 3>& weights, std::size_t i) const { return sum(weights, bends_, i); }
  double internal(const Weights& weights, std::size_t i) const { return sum(weights.internal, rates_, i); }

 private:
  using Numbers = std::array<std::vector<double>, 3>;
  static double sum(const std::array<double, 3>& weights, const Numbers& of, std::size_t i) {
    return weights[0] * of[0][i] + weights[1] * of[1][i] + weights[2] * of[2][i];
  }

  Numbers missing_, missing_rate_;  // by place
  Numbers bends_, rates_;           // b_0, b_1, b_2 and r_0, r_1, r_3
  bool known_ = false;
};

}  // namespace freeplay
