// PeakSearch: where inside a step of an accuracy run a value may exceed its largest so far.
#pragma once

#include <span>
#include <vector>

namespace freeplay {

/// Steps that an accuracy chooses may be long against the bend of forces: the largest value then lies inside one and at
/// neither end. The parabola through the last three ends, and after a look that through both ends and the look, says
/// where and how much. Looks cost about as much as a stage of an integrator: a step gets three at most, and all
/// together one in twenty-four steps and eight more, beyond which only gains of more than a hundredth are pursued.
class PeakSearch {
 public:
  explicit PeakSearch(std::size_t values);

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
    archive(self.before_, self.start_, self.end_, self.inner_, self.ends_, self.looks_, self.credit_);
  }

 private:
  struct Point {
    double x = 0.0;  ///< time [s], of `inner_` the fraction of the step
    std::vector<double> values;
    template <class Self, class Archive>
    static void exchange(Self& self, Archive& archive) {
      archive(self.x, self.values);
    }
  };
  struct Candidate {
    double s = 0.0, gain = 0.0;  ///< gain: as a part of the largest value
  };
  Candidate by_ends(std::size_t value, double largest) const;
  Candidate by_look(std::size_t value, double largest) const;

  Point before_, start_, end_, inner_;
  int ends_ = 0;   ///< known in a row, at most 3
  int looks_ = 0;  ///< at the present step
  double credit_;
};

}  // namespace freeplay
