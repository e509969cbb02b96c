// MechanismDrawing: a mechanism at one instant as a picture.
#pragma once

#include <span>
#include <string>

#include "system/system.h"

namespace freeplay {

/// SVG of a model with its bodies where `q` (coordinates of `system`) puts them; spatial models as `spatial_svg` says.
/// In the plane: bodies as
/// shaded outlines through their points, ground hatched, joints as symbols of what they leave free (circle: a turn,
/// ring: a turn with clearance, box: a slide, square: nothing, line: what ties two points apart, zigzag: a force),
/// bodies that do not stand where the file gives their pose once more, pale and dashed, where it does;
/// centres of mass as quartered discs, frames that no joint stands on as small axes; all with their names,
/// which keep out of each other's way as long as there are no more than 400. Same input, same bytes.
std::string mechanism_svg(const System& system, std::span<const double> q);

}  // namespace freeplay
