// Where two closed curves that move against each other in the plane are nearest, or stand deepest in each other.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "closed_curve.h"

namespace freeplay::curves {

/// Both points that are nearest to each other, or that come apart first where the curves stand in each other.
struct Touch {
  double gap;                       ///< along the normal, negative where the curves stand in each other [m]
  Point normal;                     ///< unit, out of the first curve, in the axes of the first marker
  Point on_first, on_second;        ///< each from the origin of its own marker, in the axes of the first [m]
  std::array<double, 2> curvature;  ///< of each there [1/m]
};

/// One of the curves, the guide, is given by its angle, the other, the rider, by its support function h. With the
/// origin P of the rider in the axes of the guide, a point C of the guide with the normal n, its angle alpha, and the
/// tangent t, the rider turned by theta touches the line at C from outside with its normal -n, at beta = alpha + pi -
/// theta:
///
///   E = C + h n + h' t      e = n.(P - E) = n.(P - C) - h      g = t.(P - C) - h' = 0 where E is nearest to P
///   dg/ds = -(1 + kappa (rho + e))     s the way along the guide, rho = h + h''
///
/// E is the closed curve on which the rider's origin goes where both touch, and e the distance of P from it, negative
/// inside: continuous wherever P is. E has a smooth course where no hollow of the guide is narrower than the flattest
/// part of the rider, and then both touch in one place where it does not cross itself.
class CurvePair {
 public:
  /// Parameters that are the curves, for messages.
  static constexpr const char* keys[] = {"first", "second"};

  /// Throws BadParameter where both could touch in more than one place.
  CurvePair(ClosedCurve first, ClosedCurve second)
      : curves_{std::move(first), std::move(second)},
        guide_(choose_guide(curves_)),
        rider_(curves_[1 - guide_], keys[1 - guide_]) {
    make_tables();
    require_one_place();
  }

  /// `cosine`, `sine`: of the angle of the second marker against the first; `d`: from origin to origin, axes of the
  /// first.
  Touch touch(const Point& d, double cosine, double sine) const {
    if (guide_ == 0) {
      const Nearest at = nearest(d, {cosine, sine});
      return {at.gap, at.normal, at.place, at.place + at.gap * at.normal - d, {at.curvature, 1.0 / at.radius}};
    }
    const auto to_first = [&](const Point& v) { return turned_by(v, {cosine, sine}); };
    const Nearest at = nearest(turned_by(-1.0 * d, {cosine, -sine}), {cosine, -sine});
    const Point normal = to_first(-1.0 * at.normal), second = to_first(at.place);
    return {at.gap, normal, d + second - at.gap * normal, second, {1.0 / at.radius, at.curvature}};
  }
  const ClosedCurve& curve(std::size_t which) const { return curves_[which]; }
  /// The smallest radius of curvature of both [m].
  double least_radius() const {
    return 1.0 / std::max(curves_[0].sharpest().curvature, curves_[1].sharpest().curvature);
  }

 private:
  static constexpr std::size_t parts = 32, most_stations = 512, directions = 512;

  struct Nearest {
    double gap;
    Point normal, place;
    double curvature, radius;  ///< of the guide; of the rider
  };
  /// A place of the guide from which the search begins.
  struct Station {
    double angle;
    Point place;
    double entry;  ///< in `outline_`, of what a rider that is not turned has there
  };
  /// Cosine and sine.
  struct Turn {
    double c, s;
  };
  static Point turned_by(const Point& v, const Turn& by) { return {by.c * v.x - by.s * v.y, by.s * v.x + by.c * v.y}; }

  static std::size_t choose_guide(const std::array<ClosedCurve, 2>& curves) {
    if (curves[1].is_round()) return 0;
    if (curves[0].is_round()) return 1;
    throw BadParameter(keys[1], "bad-curve",
                       "both curves have straight or hollow parts, as the first at " +
                           degrees(curves[0].flattest().angle) + " and the second at " +
                           degrees(curves[1].flattest().angle) + ": one must be round everywhere");
  }
  const ClosedCurve& guide() const { return curves_[guide_]; }

  void make_tables() {
    std::vector<double> angles = guide().stations(parts);
    for (std::size_t fewer = parts / 2; angles.size() > most_stations; fewer /= 2) angles = guide().stations(fewer);
    for (const double angle : angles) {
      const ClosedCurve::At at = guide().at(angle);
      stations_.push_back({angle, at.place, entry_of(at.normal_angle + 0.5 * whole_turn)});
    }
    for (std::size_t i = 0; i <= directions; ++i) {
      const double direction = whole_turn * static_cast<double>(i) / directions;
      const RoundCurve::At h = rider_.at(direction);
      outline_.push_back(turned_by({h.reach, h.along}, {std::cos(direction), std::sin(direction)}));
    }
    // More than a step of E from one station to the next.
    for (std::size_t i = 0; i < stations_.size(); ++i) stride_ = std::max(stride_, 2.0 * step_of_way(i));
  }
  /// From 0 to the number of directions.
  static double entry_of(double direction) {
    const double turns = direction / whole_turn;
    return (turns - std::floor(turns)) * static_cast<double>(directions);
  }
  double step_of_way(std::size_t i) const {
    const std::size_t next = (i + 1) % stations_.size();
    const Point by = stations_[next].place - stations_[i].place;
    const double turn = std::abs(std::remainder(stations_[next].entry - stations_[i].entry, double{directions}));
    return std::sqrt(dot(by, by)) + turn * whole_turn / directions / curves_[1 - guide_].flattest().curvature;
  }

  /// P - E at a station, in the axes of the rider: from the tables. `entry`: how far the rider is turned back.
  Point off(const Station& station, const Point& p, const Turn& back, double entry) const {
    double at = station.entry + entry;
    if (at >= directions) at -= directions;
    const auto k = std::min(static_cast<std::size_t>(at), directions - 1);
    const double part = at - static_cast<double>(k);
    return turned_by(p - station.place, back) + outline_[k] + part * (outline_[k + 1] - outline_[k]);
  }

  /// The nearest of all places on E, whatever was before: from each station that is nearer than those beside it and not
  /// much farther than the nearest.
  Nearest nearest(const Point& p, const Turn& turn) const {
    const double theta = std::atan2(turn.s, turn.c), entry = entry_of(-theta);
    const std::size_t count = stations_.size();
    std::array<double, most_stations> square;  // NOLINT(*-member-init): filled as far as it is read
    double least = unbounded;
    for (std::size_t i = 0; i < count; ++i) {
      const Point v = off(stations_[i], p, {turn.c, -turn.s}, entry);
      square[i] = dot(v, v);
      least = std::min(least, square[i]);
    }
    const double limit = std::sqrt(least) + stride_, most = limit * limit;
    Nearest best{};
    best.gap = unbounded;
    for (std::size_t i = 0; i < count; ++i) {
      const double before = square[i == 0 ? count - 1 : i - 1], after = square[i + 1 == count ? 0 : i + 1];
      const bool candidate = (square[i] <= before && square[i] < after && square[i] <= most) || square[i] == least;
      if (!candidate) continue;
      const Nearest found = settle(i, p, theta);
      if (std::abs(found.gap) < std::abs(best.gap)) best = found;
    }
    return best;
  }

  /// Newton's method for g = 0 between the stations beside one, where g falls from positive to negative.
  Nearest settle(std::size_t station, const Point& p, double theta) const {
    constexpr double small = 1e-10;  // a step after which the next one is rounding [rad]
    constexpr int most_steps = 60;
    const std::size_t count = stations_.size();
    double s = stations_[station].angle;
    double low = station == 0 ? stations_[count - 1].angle - whole_turn : stations_[station - 1].angle,
           high = station + 1 == count ? whole_turn : stations_[station + 1].angle;
    Nearest found{};
    bool last = false;
    for (int i = 0; i < most_steps; ++i) {
      const ClosedCurve::At c = guide().at(s);
      const RoundCurve::At h = rider_.at(c.normal_angle + 0.5 * whole_turn - theta);
      const Point v = p - c.place;
      const double off = dot(turned(c.normal), v) - h.along;
      found = {dot(c.normal, v) - h.reach, c.normal, c.place, c.curvature, std::max(h.radius, least_part_ * h.reach)};
      if (last || off == 0.0) break;
      (off > 0.0 ? low : high) = s;
      const double by = c.speed * (1.0 + c.curvature * (h.radius + found.gap)), newton = s + off / by;
      const double next = by > 0.0 && newton > low && newton < high ? newton : 0.5 * (low + high);
      last = std::abs(next - s) <= small;
      s = next;
    }
    return found;
  }

  /// Where the guide is hollow: no hollow is narrower than the rider, and E crosses itself at no angle of the rider.
  void require_one_place() const {
    constexpr double spare = 0.02;  // of the curvature of the rider
    const ClosedCurve::Extreme hollow = guide().flattest(), flat = curves_[1 - guide_].flattest();
    if (hollow.curvature >= 0.0) return;
    if (!(hollow.curvature + flat.curvature > spare * flat.curvature))
      throw BadParameter(keys[guide_], "bad-curve",
                         "the curve has a hollow at " + degrees(hollow.angle) + " with the radius " +
                             in_metres(-1.0 / hollow.curvature) + ", in which the other one, whose flattest part has " +
                             in_metres(1.0 / flat.curvature) + ", would touch in two places");
    constexpr int turns = 96;
    std::vector<Point> way(stations_.size());
    for (int k = 0; k < turns; ++k) {
      const double theta = whole_turn * k / turns;
      const Turn turn{std::cos(theta), std::sin(theta)};
      for (std::size_t i = 0; i < way.size(); ++i)
        way[i] = turned_by(off(stations_[i], {0.0, 0.0}, {turn.c, -turn.s}, entry_of(-theta)), turn);
      if (crosses_itself(way))
        throw BadParameter(keys[guide_], "bad-curve",
                           "the other curve, turned by " + degrees(theta) +
                               ", would touch this one in two places at once, as in a slot");
    }
  }
  static std::string in_metres(double length) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.4g m", length);
    return text.data();
  }
  static bool crosses_itself(const std::vector<Point>& way) {
    const std::size_t n = way.size();
    const auto sides = [](const Point& a, const Point& b, const Point& p, const Point& q) {
      return (cross(b - a, p - a) > 0.0) != (cross(b - a, q - a) > 0.0);
    };
    for (std::size_t i = 0; i + 2 < n; ++i) {
      for (std::size_t k = i + 2; k < n && !(i == 0 && k + 1 == n); ++k) {
        const Point &a = way[i], &b = way[i + 1], &p = way[k], &q = way[(k + 1) % n];
        if (sides(a, b, p, q) && sides(p, q, a, b)) return true;
      }
    }
    return false;
  }

  static constexpr double least_part_ = 1e-9;  // radius of a sharp place of the rider, by its reach

  std::array<ClosedCurve, 2> curves_;
  std::size_t guide_;
  RoundCurve rider_;
  std::vector<Station> stations_;
  std::vector<Point> outline_;
  double stride_ = 0.0;  // [m]
};

}  // namespace freeplay::curves
