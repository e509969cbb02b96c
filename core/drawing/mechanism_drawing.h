// MechanismDrawing: a mechanism at one instant as a picture.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "system/system.h"

namespace freeplay {

/// The way of a point [m].
struct Trace {
  std::string name;
  std::vector<std::array<double, 3>> points;  ///< z is 0 in the plane
};

/// The journal or slider of a planar joint with play in its clearance, beside the mechanism.
struct MagnifiedJoint {
  int joint = 0;
  double factor = 1.0;  ///< against the mechanism
  /// Of the journal's centre from the bearing's, in world axes, or of the slider's from the guide's, in the guide's
  /// [m].
  std::vector<std::array<double, 2>> orbit;
};

struct MechanismPicture {
  std::span<const double> q;  ///< coordinates of the system
  bool at_start = true;       ///< then bodies that stand elsewhere than the file says are drawn there, too
  std::vector<std::vector<double>> others{};  ///< coordinates at other instants
  std::vector<Trace> traces{};
  std::vector<MagnifiedJoint> magnified{};
  std::string caption{};
};

/// SVG of a model with its bodies where `q` puts them; spatial models as `spatial_svg` says. In the plane: bodies as
/// shaded outlines through their points, ground hatched, joints as symbols of what they leave free (circle: a turn,
/// ring: a turn with clearance, box: a slide, square: nothing, line: what ties two points apart, zigzag: a force,
/// bars: stops at the ends of a way), strands about wheels, cams and grooves to scale,
/// gears as pitch circles, bodies that do not stand where the file gives their pose once more, pale and dashed, where
/// it does; at other instants as pale outlines;
/// centres of mass as quartered discs, frames that no joint stands on as small axes; all with their names,
/// which keep out of each other's way as long as there are no more than 400. Same input, same bytes.
std::string mechanism_svg(const System& system, const MechanismPicture& picture);

/// World position of a frame or marker [m].
std::array<double, 3> world_position(const System& system, const Marker& marker, std::span<const double> q);

}  // namespace freeplay
