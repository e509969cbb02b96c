// MjcfGeom: what a geom weighs. Geoms do nothing else here.
#pragma once

#include <optional>

#include "mjcf/pose.h"
#include "urdf/mass.h"

namespace freeplay::mjcf {

using urdf::MassProperties;

/// Mass and inertia of a geom, whose classes are in it already, in the frame of what carries it. Empty for one that has
/// none: a plane, one of a group that does not count, or after a message. `counts` is false where they are not asked
/// for: then mistakes alone are reported.
std::optional<MassProperties> read_geom(XmlElement& xml, const std::string& carrier, bool counts,
                                        const Settings& settings, Messages& messages);

/// Can it touch another?
bool can_touch(const XmlElement& geom);

}  // namespace freeplay::mjcf
