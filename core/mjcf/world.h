// MjcfWorld: the bodies of an MJCF file as the links and joints of a robot.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "mjcf/defaults.h"
#include "mjcf/joints.h"
#include "mjcf/settings.h"

namespace freeplay::mjcf {

/// A place on a link.
struct Site {
  int link = 0;
  Eigen::Isometry3d pose;
};

/// The robot's first link is the world. What closes loops is missing yet.
struct World {
  urdf::Robot robot;
  std::vector<Eigen::Isometry3d> poses;  ///< of each link in the world, as the file draws it
  std::map<std::string, int> bodies;     ///< by their names in the file
  std::map<std::string, Site> sites;
  NamePool names;
};

World read_world(XmlElement& root, const Settings& settings, const Defaults& defaults, Messages& messages);

/// Reports a part that no reader of one plain file takes: something that is to be included, repeated or made up.
bool refuse_unexpanded(const XmlElement& xml, Messages& messages);

}  // namespace freeplay::mjcf
