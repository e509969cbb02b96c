// PeakSearch: where inside a step of an accuracy run a value may exceed its largest so far.
#pragma once

#include <array>
#include <span>
#include <vector>

namespace freeplay {

/// Steps that an accuracy chooses may be long against the bend of forces: the largest value then lies inside one and at
/// neither end. The parabola through the last three ends, and after a look that about the highest place, says
/// where and how much. Looks cost about as much as a stage of an integrator: a step gets three at most, and all
/// together one in twenty-four steps and eight more, beyond which only gains of more than a hundredth are pursued;
/// where the parabola expects nothing, there must be room for a thousandth. As many again are kept for what is then
/// left of a thousandth or more, of values that are largest at another place or that rise steeply. Where all motion is
/// prescribed no error of an integrator keeps steps short: there looks are not counted, and the middle of every step
/// is one.
class PeakSearch {
 public:
  explicit PeakSearch(std::size_t values, bool all_is_prescribed = false);

  /// After an event or a kink values may go on otherwise.
  void restart(double t, std::span<const double> values);
  /// A smooth step ends at t.
  void end_step(double t, std::span<const double> values);
  /// Where in that step to look next, as a fraction of it, or 0: nowhere. `largest`: by value, so far.
  double next(std::span<const double> largest);
  /// What stands there.
  void seen(double s, std::span<const double> values);

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.before_, self.start_, self.end_, self.ends_, self.looks_, self.credit_, self.extras_,
            self.fair_credit_);
  }

 private:
  static constexpr int most_looks = 3, most_extras = 3;  // at one step, besides its middle
  struct Point {
    double x = 0.0;  ///< time [s], of looks the fraction of the step
    std::vector<double> values;
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.x, self.values);
    }
  };
  struct Candidate {
    double s = 0.0, gain = 0.0;  ///< gain: at most, as a part of the largest value
    double likely = 0.0;         ///< the same by the parabola alone
  };
  /// What is known of the present step, in order: its start, looks and its end.
  struct Places {
    int count = 0;
    std::array<double, most_looks + most_extras + 3> x;
    std::array<const double*, most_looks + most_extras + 3> values;
  };
  Places places() const;
  bool could_exceed(std::size_t value, double largest) const;
  Candidate by_ends(std::size_t value, double largest) const;
  static Candidate by_looks(const Places& places, std::size_t value, double largest);
  Candidate by_steepness(std::size_t value, double largest) const;
  double next_extra(Candidate best, std::span<const double> largest);

  Point before_, start_, end_;
  std::array<Point, most_looks + most_extras + 1> inner_;  ///< looks at the present step
  int ends_ = 0;                                           ///< known in a row, at most 3
  int looks_ = 0, extras_ = 0;                             ///< at the present step
  double credit_, fair_credit_;
  bool all_is_prescribed_;
};

}  // namespace freeplay
