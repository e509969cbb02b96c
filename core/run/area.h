// Area: the integral of a function that is known at instants, as of a force over a contact.
#pragma once

#include <algorithm>

namespace freeplay {

/// Through every three neighbouring points goes a parabola; a step takes the mean of those through its start and its
/// end, the first and the last step the only one there is. Errs with the fourth power of the steps of a smooth
/// function; of two points the trapezoid.
class Area {
 public:
  /// `open`: the value at this first instant is not known but for what lies after it: the straight line through the
  /// next two, and no other sign than theirs.
  void begin(double t, double value, bool open) {
    *this = {};
    points_[2] = {t, value};
    known_ = 1;
    open_ = open;
  }
  /// A later instant.
  void add(double t, double value) {
    points_[0] = points_[1], points_[1] = points_[2], points_[2] = {t, value};
    ++known_;
    if (known_ < 3) return;
    if (open_) close();
    const double curvature = bend(), first = under_parabola(points_[0], points_[1], curvature);
    before_ = known_ == 3 ? first : before_ + 0.5 * (last_ + first);
    last_ = under_parabola(points_[1], points_[2], curvature);
  }
  double value() const {
    return known_ < 2 ? 0.0 : before_ + (known_ == 2 ? trapezoid(points_[1], points_[2]) : last_);
  }
  bool any() const { return known_ > 0; }
  double last_time() const { return points_[2].t; }

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    for (auto& point : self.points_) archive(point.t, point.value);
    archive(self.before_, self.last_, self.known_, self.open_);
  }

 private:
  struct Point {
    double t = 0.0, value = 0.0;
  };
  static double trapezoid(const Point& a, const Point& b) { return 0.5 * (b.t - a.t) * (a.value + b.value); }
  /// Half the second derivative of the parabola through the points; 0 where two are at one instant.
  double bend() const {
    const double first = points_[1].t - points_[0].t, second = points_[2].t - points_[1].t;
    if (!(first > 0.0) || !(second > 0.0)) return 0.0;
    return ((points_[2].value - points_[1].value) / second - (points_[1].value - points_[0].value) / first) /
           (first + second);
  }
  static double under_parabola(const Point& a, const Point& b, double curvature) {
    const double length = b.t - a.t;
    return trapezoid(a, b) - curvature * length * length * length / 6.0;
  }
  void close() {
    open_ = false;
    const double slope = (points_[2].value - points_[1].value) / (points_[2].t - points_[1].t);
    const double value = points_[1].value - slope * (points_[1].t - points_[0].t);
    if (value * points_[1].value > 0.0) points_[0].value = value;
  }

  Point points_[3];
  double before_ = 0.0;  ///< the last step
  double last_ = 0.0;    ///< by the parabola through its start
  int known_ = 0;
  bool open_ = false;
};

}  // namespace freeplay
