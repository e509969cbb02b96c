// UrdfLoops: the dialects in which URDF files write joints that close loops.
//
//   <constraint name type>  <parent link/> <parent_origin/> <parent_axis/> <child link/> <child_origin/> <child_axis/>
//                           as proposed for urdfdom (ros/urdfdom pull request 264)
//   <loop name type>        <predecessor link> <origin/> </predecessor> <successor ...> <axis/>
//   <loop_joint name type>  <link1 link xyz rpy/> <link2 .../> <axis/>
//   <gazebo> <joint name type>  <parent>NAME</parent> <child>NAME</child> <pose> <axis> <xyz>   an SDF joint: it joins
//                           the links where they stand when all coordinates are zero
//
// One reader takes the first three, in each of which an end may be written in each of the ways.
#pragma once

#include "urdf/element.h"

namespace freeplay::urdf {

/// Appends the loop joints of the file to `robot.joints`.
void read_loops(XmlElement& root, Robot& robot, Messages& messages);

/// Is it a <gazebo> element with joints, which read_loops() reads?
bool is_loop_carrier(const XmlElement& element);

}  // namespace freeplay::urdf
