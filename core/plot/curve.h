// Curve: what a picture of many points needs of them.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_set>
#include <vector>

namespace freeplay::plot {

/// A y that is no finite number is a gap in a line.
struct Point {
  double x = 0.0, y = 0.0;
};

/// Least and largest value, and where they were first met.
struct Extremes {
  double least = std::numeric_limits<double>::infinity(), most = -std::numeric_limits<double>::infinity();
  std::int64_t missing = 0;  ///< values that are no finite numbers
  double least_at = std::numeric_limits<double>::quiet_NaN(), most_at = std::numeric_limits<double>::quiet_NaN();

  /// What is no finite number counts for nothing.
  void add(double at, double value) {
    if (!std::isfinite(value)) {
      ++missing;
      return;
    }
    if (value < least) least = value, least_at = at;
    if (value > most) most = value, most_at = at;
  }
  bool any() const { return least <= most; }
};

/// Points with rising x on a picture of so many columns: of each column the least and the largest y alone, at the x
/// where they were met, so that no extreme is lost and the number of points does not grow with the rows.
class ColumnCurve {
 public:
  ColumnCurve(double from, double until, int columns) : from_(from), per_unit_(columns / (until - from)) {}

  void add(const Point& point);
  /// All that was added; no more may be.
  const std::vector<Point>& points();

 private:
  void end_column();

  double from_, per_unit_;
  double column_ = -std::numeric_limits<double>::infinity();
  Extremes seen_;
  bool gap_ = false;  // before the next point
  std::vector<Point> points_;
};

/// Points in any order in a plane of pixels: those that a line needs to be the same to a part of a pixel. A way between
/// two pixels that was drawn before is left out, so that what comes again and again adds nothing. Of very many ways
/// those alone are kept that reach a new place of four by four pixels or an extreme of x or y.
class Trail {
 public:
  /// `pixel`: length of a side, in the units of x and of y.
  Trail(double pixel_x, double pixel_y) : pixel_x_(pixel_x), pixel_y_(pixel_y) {}

  void add(const Point& point);
  const std::vector<Point>& points() const { return points_; }

 private:
  std::uint64_t place_of(const Point& point, double pixels) const;
  bool is_new(const Point& point, std::uint64_t pixel);

  double pixel_x_, pixel_y_;
  bool pen_down_ = false;
  Point last_;
  std::uint64_t last_pixel_ = 0;
  std::unordered_set<std::uint64_t> drawn_, places_;
  Extremes x_, y_;
  std::vector<Point> points_;
};

}  // namespace freeplay::plot
