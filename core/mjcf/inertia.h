// MjcfInertia: mass and inertia of a body, from its numbers or from its geoms.
#pragma once

#include <string>
#include <vector>

#include "mjcf/geom.h"

namespace freeplay::mjcf {

/// Reads an `inertial` element into the link.
void read_inertial(XmlElement& xml, const std::string& owner, const Settings& settings, urdf::Link& link,
                   Messages& messages);

/// The link weighs what the geoms weigh together.
void take_geoms(const std::vector<MassProperties>& geoms, urdf::Link& link);

/// Raises mass and principal moments to the least that the compiler allows.
void bound_inertia(const Settings& settings, urdf::Link& link);

/// Scales all masses and inertias so that the robot weighs what the compiler says.
void scale_masses(const Settings& settings, urdf::Robot& robot);

}  // namespace freeplay::mjcf
