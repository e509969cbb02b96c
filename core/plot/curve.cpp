#include "plot/curve.h"

#include <cmath>

namespace freeplay::plot {
namespace {
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double unmoved = 0.25;    // of a pixel
constexpr double wide_place = 4.0;  // pixels
constexpr std::size_t most_ways = 30000;
constexpr std::uint64_t spread = 0x9e3779b97f4a7c15ULL;
}  // namespace

void ColumnCurve::add(const Point& point) {
  const double column = std::floor((point.x - from_) * per_unit_);
  if (column != column_) end_column();
  column_ = column;
  if (!std::isfinite(point.y)) {
    end_column();
    gap_ = true;
  } else {
    seen_.add(point.x, point.y);
  }
}

void ColumnCurve::end_column() {
  if (!seen_.any()) return;
  if (gap_ && !points_.empty()) points_.push_back({seen_.least_at, nan});
  gap_ = false;
  const Point low{seen_.least_at, seen_.least}, high{seen_.most_at, seen_.most};
  points_.push_back(low.x <= high.x ? low : high);
  if (low.x != high.x) points_.push_back(low.x <= high.x ? high : low);
  seen_ = {};
}

const std::vector<Point>& ColumnCurve::points() {
  end_column();
  return points_;
}

// 32 bits of each number of a place, so many pixels wide: pictures are smaller.
std::uint64_t Trail::place_of(const Point& point, double pixels) const {
  const auto part = [](double value) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(value)));
  };
  return (part(point.x / (pixels * pixel_x_)) << 32) ^ (part(point.y / (pixels * pixel_y_)) & 0xffffffffU);
}

bool Trail::is_new(const Point& point, std::uint64_t pixel) {
  const bool extreme = point.x < x_.least || point.x > x_.most || point.y < y_.least || point.y > y_.most;
  x_.add(0.0, point.x);
  y_.add(0.0, point.y);
  const bool new_place = places_.insert(place_of(point, wide_place)).second;
  if (drawn_.size() >= most_ways) return new_place || extreme;
  return drawn_.insert((last_pixel_ * spread) ^ pixel).second;
}

void Trail::add(const Point& point) {
  if (!std::isfinite(point.x) || !std::isfinite(point.y)) {
    pen_down_ = false;
    return;
  }
  const std::uint64_t pixel = place_of(point, 1.0);
  if (pen_down_) {
    if (std::abs(point.x - last_.x) < unmoved * pixel_x_ && std::abs(point.y - last_.y) < unmoved * pixel_y_) return;
    if (is_new(point, pixel)) {
      const bool continues = !points_.empty() && points_.back().x == last_.x && points_.back().y == last_.y;
      if (!continues) {
        if (!points_.empty()) points_.push_back({last_.x, nan});
        points_.push_back(last_);
      }
      points_.push_back(point);
    }
  } else if (last_pixel_ = pixel; is_new(point, pixel)) {
    // A point that stands alone is a line without length.
    if (!points_.empty()) points_.push_back({point.x, nan});
    points_.push_back(point);
  }
  pen_down_ = true;
  last_ = point;
  last_pixel_ = pixel;
}

}  // namespace freeplay::plot
