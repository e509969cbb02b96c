// MechanismDrawing: a mechanism at one instant as a picture.
#pragma once

#include <span>
#include <string>

#include "model/model.h"

namespace freeplay {

/// SVG of the model with its bodies where `q` (x, y [m], angle [rad] of each centre of mass) puts them: bodies as
/// shaded outlines through their points, ground hatched, joints as symbols of what they leave free (circle: a turn,
/// ring: a turn with clearance, box: a slide, square: nothing, line: what ties two points apart, zigzag: a force),
/// centres of mass as quartered discs, frames that no joint stands on as small axes; all with their names,
/// which keep out of each other's way as long as there are no more than 400. Same input, same bytes.
std::string mechanism_svg(const Model& model, std::span<const double> q);

}  // namespace freeplay
