// MjcfJoints: the joints of one body of an MJCF file, which together are one joint here.
#pragma once

#include <string>
#include <vector>

#include "mjcf/defaults.h"
#include "mjcf/settings.h"
#include "urdf/name_pool.h"

namespace freeplay::mjcf {

using urdf::NamePool;

/// One of the joints of a body, as it is written: in the frame of the body.
struct OwnJoint {
  enum class Kind { free, ball, slide, hinge };
  Kind kind = Kind::hinge;
  urdf::Joint joint;  ///< all but its frames; `axis` in the body's frame
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
};

/// Reads a `joint` or `freejoint`, whose classes are in it already; `frame` is that in which it is written.
OwnJoint read_joint(XmlElement& xml, const Eigen::Isometry3d& frame, const Settings& settings, Messages& messages);

/// Where a body hangs.
struct Hanging {
  int link, parent;
  Eigen::Isometry3d pose;  ///< of the link in its parent
  std::string name;
  Spot spot;
};

/// The joint that the joints of a body make together; a fixed one where there are none. Reports those that make none
/// that is known here.
urdf::Joint joint_of_body(std::vector<OwnJoint> own, const Hanging& body, NamePool& names, Messages& messages);

}  // namespace freeplay::mjcf
