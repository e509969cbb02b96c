// MjcfEquality: the constraints of an MJCF file that hold bodies together beyond their tree.
//
//   <connect body1 body2 anchor/>  or <connect site1 site2/>    two points stay together
//   <weld body1 body2 relpose/>    or <weld site1 site2/>       two frames stay together
//   <joint joint1 joint2 polycoef/>                             joint1 follows joint2 in proportion
#pragma once

#include "mjcf/world.h"

namespace freeplay::mjcf {

/// Appends the loops of the file to the robot; names what is not read.
void read_equalities(XmlElement& root, World& world, const Settings& settings, const Defaults& defaults,
                     Messages& messages);

}  // namespace freeplay::mjcf
