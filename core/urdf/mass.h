// UrdfMass: what a body weighs that is made of links.
#pragma once

#include <vector>

#include "urdf/robot.h"

namespace freeplay::urdf {

struct MassProperties {
  double mass = 0.0;                                  ///< [kg]
  Eigen::Vector3d com = Eigen::Vector3d::Zero();      ///< in the body frame [m]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< about the centre of mass, axes of the body frame [kg m^2]
};

/// All parts as one, about its own centre of mass; zero where there are none.
MassProperties together(const std::vector<MassProperties>& parts);

/// Of each link that is a body, together with what is part of it by `mounts`; zero for the others.
std::vector<MassProperties> body_masses(const Robot& robot, const std::vector<Mount>& mounts);

}  // namespace freeplay::urdf
