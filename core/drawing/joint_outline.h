// JointOutline: the shape of a joint or force element that is more than a symbol, drawn to scale.
#pragma once

#include <optional>
#include <vector>

#include "model/model.h"
#include "svg/page.h"

namespace freeplay {

/// Of a force element between two pulleys, whose radii are among its parameters.
struct StrandShape {
  double first, second;  ///< radii [m]
  bool crossed;
};
std::optional<StrandShape> strands_of(const JointElement& joint);

/// The closed way of both [m]: about the first pulley, along the right strand as seen from it to the second, about the
/// second and back. Empty where the pulleys are closer than that allows.
std::vector<svg::Point> strand_line(const StrandShape& strands, const svg::Point& first, const svg::Point& second);

/// Of a joint with a curve of one variable among its parameters: a height over x of its first frame, or a distance from
/// its origin over the angle.
struct CurveShape {
  Formula curve;
  bool polar;
};
std::optional<CurveShape> curve_of(const JointElement& joint);

/// In the world [m], of a first frame at `origin` and `angle`: all around, or as far as `reach` to both sides of `at`.
/// In several pieces where the formula has no value between.
std::vector<std::vector<svg::Point>> curve_lines(const CurveShape& shape, const svg::Point& origin, double angle,
                                                 const svg::Point& at, double reach);

/// Through points of the page, as a line that names keep out of.
void draw_outline(svg::Page& page, const std::vector<svg::Point>& points, const char* kind);

}  // namespace freeplay
