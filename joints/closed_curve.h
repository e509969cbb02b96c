// Closed curves about the origin of a marker, smooth and without a crossing: by polar angle, and by direction of their
// normal where they are round everywhere.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "freeplay/kit/planar_pair.h"
#include "freeplay/plugin.h"
#include "periodic_table.h"

namespace freeplay::curves {

using play::Vec2;
using Point = Vec2<double>;

inline std::string degrees(double angle) {
  return std::to_string(static_cast<int>(std::lround(angle * 360.0 / whole_turn))) + " deg";
}

/// The distance from the origin over the angle, counter-clockwise: so it crosses itself nowhere.
class ClosedCurve {
 public:
  struct At {
    Point place;          ///< [m]
    Point normal;         ///< unit, outwards; the tangent is the normal turned by +90 degrees
    double speed;         ///< way along the curve by the angle [m/rad]
    double curvature;     ///< positive where it is round [1/m]
    double normal_angle;  ///< of the normal, continuous along the curve [rad]
  };
  struct Extreme {
    double curvature, angle;
  };

  /// `key`: the parameter that is the formula, for messages. Throws BadParameter where the curve is none.
  ClosedCurve(const Formula& formula, const char* key) : formula_(formula), switches_(formula.switches()) {
    const auto sample = [&](double x) {
      const double variables[] = {x};
      double slopes[1] = {};
      const double value = formula.at(variables, slopes);
      return PeriodicTable::Sample{value, slopes[0]};
    };
    require_distance(sample, key);
    breaks_ = find_breaks();
    refuse(distance_.make(sample, breaks_, size_), key);
    find_extremes();
  }

  At at(double angle) const { return at(distance_.at(angle), angle); }
  /// Mean distance from the origin [m].
  double size() const { return size_; }
  Extreme flattest() const { return flattest_; }
  Extreme sharpest() const { return sharpest_; }
  /// Round enough for a support function: no straight or hollow part.
  bool is_round() const { return flattest_.curvature > least_curvature / size_; }
  /// Angles at which the curvature may jump.
  const std::vector<double>& breaks() const { return breaks_; }

  /// Angles, in their order, between which neither the way along the curve nor the turn of the normal is more than a
  /// part of a whole round.
  std::vector<double> stations(std::size_t parts) const {
    constexpr int grid = 4096;
    constexpr double step = whole_turn / grid;
    const auto middle = [&](int i) { return at(step * (i + 0.5)); };
    double length = 0.0, gone = 0.0;
    for (int i = 0; i < grid; ++i) length += step * middle(i).speed;
    std::vector<double> found{0.0};
    for (int i = 0; i + 1 < grid; ++i) {
      const At here = middle(i);
      gone += step * here.speed * (1.0 / length + std::abs(here.curvature) / whole_turn);
      if (gone * static_cast<double>(parts) < 1.0) continue;
      found.push_back(step * (i + 1));
      gone = 0.0;
    }
    return found;
  }

  std::int32_t switches() const { return switches_; }
  void decide(const Point& place, Span<double> g) const {
    const double angle = std::atan2(place.y, place.x);
    const double variables[] = {angle < 0.0 ? angle + whole_turn : angle};
    formula_.decide(variables, g);
  }

 private:
  static constexpr double least_curvature = 1e-3;  // of one over the size

  static At at(const PeriodicTable::At& r, double angle) {
    const double c = std::cos(angle), s = std::sin(angle), square = r.value * r.value + r.slope * r.slope;
    const double speed = std::sqrt(square);
    return {{r.value * c, r.value * s},
            {(r.value * c + r.slope * s) / speed, (r.value * s - r.slope * c) / speed},
            speed,
            (square + r.slope * r.slope - r.value * r.bend) / (square * speed),
            angle - std::atan2(r.slope, r.value)};
  }

  template <class Sample>
  void require_distance(const Sample& sample, const char* key) {
    constexpr int points = 360;
    for (int i = 0; i < points; ++i) {
      const double angle = whole_turn * i / points, r = sample(angle).value;
      if (!(r > 0.0))
        throw BadParameter(key, "bad-curve",
                           "a curve goes around the origin of its frame and crosses itself nowhere: its distance must "
                           "be above zero, which it is not at " +
                               degrees(angle));
      size_ += r / points;
    }
  }
  void refuse(const PeriodicTable::Outcome& outcome, const char* key) const {
    using Flaw = PeriodicTable::Flaw;
    const std::string where = degrees(outcome.place);
    if (outcome.flaw == Flaw::jump && outcome.place == 0.0)
      throw BadParameter(key, "bad-curve",
                         "the curve is not closed: its distance at 0 and after one turn must be the same");
    if (outcome.flaw == Flaw::jump) throw BadParameter(key, "bad-curve", "the curve has a gap at " + where);
    if (outcome.flaw == Flaw::corner)
      throw BadParameter(
          key, "bad-curve",
          "the curve has a corner at " + where + "; round it, as by an arc, or close points by 'ends: periodic'");
    if (outcome.flaw == Flaw::rough)
      throw BadParameter(key, "bad-curve", "the curve is rough about " + where + ": no smooth pieces were found");
  }

  /// Where a switch of the formula passes zero.
  std::vector<double> find_breaks() const {
    constexpr int points = 1440;
    std::vector<double> found;
    if (switches_ <= 0) return found;
    const auto count = static_cast<std::size_t>(switches_);
    std::vector<double> low(count), high(count), between(count);
    const auto look = [&](double x, std::vector<double>& g) {
      const double variables[] = {x};
      formula_.decide(variables, {g.data(), count});
    };
    look(0.0, low);
    for (int i = 0; i < points; ++i) {
      const double from = whole_turn * i / points, to = whole_turn * (i + 1) / points;
      look(to, high);
      for (std::size_t k = 0; k < count; ++k) {
        if ((low[k] >= 0.0) == (high[k] >= 0.0)) continue;
        double a = from, b = to;
        for (int n = 0; n < 60; ++n) {
          const double middle = 0.5 * (a + b);
          look(middle, between);
          ((between[k] >= 0.0) == (low[k] >= 0.0) ? a : b) = middle;
        }
        found.push_back(b);
      }
      low.swap(high);
    }
    return found;
  }

  void find_extremes() {
    flattest_ = {unbounded, 0.0};
    sharpest_ = {-unbounded, 0.0};
    for (std::size_t i = 0; i < distance_.pieces(); ++i) {
      for (const double part : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        const double angle = distance_.place(i, part), curvature = at(distance_.at(i, part), angle).curvature;
        if (curvature < flattest_.curvature) flattest_ = {curvature, angle};
        if (curvature > sharpest_.curvature) sharpest_ = {curvature, angle};
      }
    }
  }

  Formula formula_;
  std::int32_t switches_;
  std::vector<double> breaks_;
  double size_ = 0.0;
  PeriodicTable distance_;
  Extreme flattest_{}, sharpest_{};
};

/// A curve that is round everywhere, by the direction u of its normal: how far it reaches along u, h = max u.C, with h'
/// = C along u turned by +90 degrees and h + h'' the radius of curvature.
class RoundCurve {
 public:
  /// `curve` is round. Throws BadParameter.
  RoundCurve(const ClosedCurve& curve, const char* key) : first_(curve.at(0.0).normal_angle) {
    const auto sample = [&](double direction) {
      const Point c = curve.at(angle_of(curve, direction)).place;
      const double x = std::cos(direction), y = std::sin(direction);
      return PeriodicTable::Sample{c.x * x + c.y * y, c.y * x - c.x * y};
    };
    std::vector<double> breaks;
    for (const double angle : curve.breaks()) {
      const double direction = curve.at(angle).normal_angle;
      breaks.push_back(direction - whole_turn * std::floor(direction / whole_turn));
    }
    const PeriodicTable::Outcome made = support_.make(sample, std::move(breaks), curve.size());
    if (made.flaw != PeriodicTable::Flaw::none)
      throw BadParameter(key, "bad-curve", "the curve is too sharp where its normal stands at " + degrees(made.place));
  }
  struct At {
    double reach, along, radius;  ///< h, h', h + h'' [m]
  };
  At at(double direction) const {
    const PeriodicTable::At h = support_.at(direction);
    return {h.value, h.slope, h.value + h.bend};
  }

 private:
  /// Where on the curve the normal has that direction: Newton's method between bounds.
  double angle_of(const ClosedCurve& curve, double direction) const {
    const double wanted = first_ + (direction - first_) - whole_turn * std::floor((direction - first_) / whole_turn);
    double low = 0.0, high = whole_turn, angle = wanted - first_;
    for (int i = 0; i < 100; ++i) {
      const ClosedCurve::At c = curve.at(angle);
      // At the very end of the turn the table begins anew.
      const double off = wanted - c.normal_angle;
      (off > 0.0 ? low : high) = angle;
      double next = angle + off / (c.curvature * c.speed);
      if (!(next > low && next < high)) next = 0.5 * (low + high);
      if (std::abs(next - angle) <= 1e-16 * whole_turn) break;
      angle = next;
    }
    return angle;
  }

  double first_;
  PeriodicTable support_;
};

}  // namespace freeplay::curves
