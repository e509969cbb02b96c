// JointStops: the ends of the way of a joint, drawn where they are.
#pragma once

#include <optional>
#include <string>

#include "model/model.h"
#include "svg/page.h"

namespace freeplay {

struct JointStops {
  double lower, upper;  ///< of the coordinate [m or rad]
  bool slides;          ///< along x of the first frame, else about its z
};

/// Of a force element that acts on a coordinate and has a lower and an upper end among its parameters.
std::optional<JointStops> stops_of(const JointElement& joint);

/// A bar across the way at each end, and the way between them; `at`: origin of the first frame, `x` and `y`: its axes
/// as they are seen, of length 1 in the plane of the page; `scale` [px/m].
void draw_stops(svg::Page& page, const JointStops& stops, const svg::Point& at, const svg::Point& x,
                const svg::Point& y, double scale);

}  // namespace freeplay
