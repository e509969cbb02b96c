// ArcCurve: a curve of arcs of circles and their common tangents, as a cam is drawn.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "base/interval.h"
#include "component/parameter_block.h"

namespace freeplay {

/// Of a circle, about which the curve goes counter-clockwise, or clockwise where the radius is negative [m]. With the
/// radius 0 it is a point.
struct Arc {
  std::array<double, 2> centre;
  double radius;
};

/// From each arc the curve goes straight to the next, along the tangent that both have in its sense; where circles
/// touch it passes over at once. It has no corners, and is
///   closed  a distance from the origin over the angle, periodic, or
///   open    a height over x, from the first point to the last, and straight on beyond them.
class ArcCurve {
 public:
  /// What is wrong at which arc.
  struct Flaw {
    std::size_t arc;
    std::string reason;
  };
  /// `arcs`: at least one; of an open curve at least two, the first and the last points. `aside`: the curve lies that
  /// much farther from the origin, or up [m]: the way of the centre of a roller.
  static std::variant<ArcCurve, Flaw> make(std::vector<Arc> arcs, bool closed, double aside);

  struct At {
    double value, slope;
  };
  /// At an angle [rad] or x [m].
  At at(double x) const noexcept;
  /// What value and slope can come to from one place to another, `from` being less.
  struct Range {
    Interval value, slope;
  };
  Range over(double from, double to) const noexcept;
  /// Numbers of which one passes zero where the curve goes from an arc to a line or another arc.
  std::size_t joints() const { return closed_ && pieces_.size() == 1 ? 0 : pieces_.size() - (closed_ ? 0 : 1); }
  double past(std::size_t joint, double x) const noexcept;

 private:
  struct Piece {
    double from;  ///< angle or x at which it begins
    bool straight;
    std::array<double, 2> place;  ///< centre, or a point
    double radius, heading;       ///< of an arc, of a line [rad]
  };
  ArcCurve() = default;
  At distance(const Piece& piece, double angle) const noexcept;
  static At height(const Piece& piece, double x) noexcept;
  double end_of_piece(double x) const noexcept;

  class Maker;
  bool closed_ = false;
  std::vector<Piece> pieces_;
  double last_ = 0.0;  ///< where an open one ends
};

/// Makes `value` serve the curve as a function of the formula's first variable.
void set_arc_formula(ParameterValue& value, ArcCurve curve);

}  // namespace freeplay
