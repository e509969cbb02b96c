// SpatialDrawing: a mechanism in space at one instant, seen from four sides.
#pragma once

#include <string>

#include "drawing/mechanism_drawing.h"

namespace freeplay {

/// SVG of a spatial model with its bodies where the picture puts them, as groups `front`, `top` above it and `side`
/// right of it to one scale (third-angle projection), and `isometric`. Up is against gravity where that lies along an
/// axis, else z. What is nearer covers what is further, which is paler. Symbols of joints show what they leave free.
/// Names are in the isometric view; few ones in all. Joints are not magnified. Same input, same bytes.
std::string spatial_svg(const System& system, const MechanismPicture& picture);

}  // namespace freeplay
