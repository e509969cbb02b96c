// MjcfSettings: what the `compiler` and `option` of an MJCF file say about the numbers of all others.
#pragma once

#include <numbers>
#include <string>

#include "urdf/element.h"

namespace freeplay::mjcf {

using urdf::Element;
using urdf::Messages;
using urdf::name_spot;
using urdf::Spot;
using urdf::spot_of;

struct Settings {
  enum class Inertia { never, always, where_missing };  ///< taken from geoms

  double angle_unit = std::numbers::pi / 180.0;  ///< [rad]; MJCF counts in degrees unless the file says otherwise
  std::string euler_axes = "xyz";                ///< small letters turn about axes that move along, capital ones do not
  bool auto_limits = true;                       ///< a `range` alone limits a joint
  Inertia inertia_from_geoms = Inertia::where_missing;
  int lowest_group = 0, highest_group = 5;  ///< of the geoms that have mass
  double least_mass = 0.0, least_moment = 0.0;
  double total_mass = 0.0;  ///< to which all masses are scaled; 0: they stay
  Eigen::Vector3d gravity{0.0, 0.0, -9.81};
  Spot gravity_spot;
  bool has_equalities = true;
};

/// Index of the word that an attribute says, `standard` where it is absent or, after a message, no such word.
std::size_t choice(Element& element, const std::string& name, const std::vector<std::string>& words,
                   std::size_t standard, Messages& messages);

/// Reads all `compiler` and `option` elements of the file; later ones win.
Settings read_settings(XmlElement& root, Messages& messages);

}  // namespace freeplay::mjcf
