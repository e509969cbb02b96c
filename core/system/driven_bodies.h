// Driven bodies: planar bodies whose place is a function of time alone, by drivers and welds.
#pragma once

#include <vector>

#include "model/model.h"

namespace freeplay::planar {

/// A body that one joint holds at ground or at another such body, a driver giving the joint's coordinate. Its place and
/// motion at any time follow in closed form, and no equation is left for it.
struct DrivenBody {
  BodyId body = ground;
  int joint = -1;      ///< that holds it, into Model::joints
  int driver = -1;     ///< of the joint's coordinate, into Model::drivers; -1: a weld has none
  bool second = true;  ///< it is the joint's second body
};

/// Those of a planar model with its clearances open, each after the one that it is held at. A body is listed where
/// rows that are declared (JointLayout::planar_rows) and at most one driver leave it no freedom, and nothing else
/// holds it there as well: contradictions and redundancy are left to the equations.
std::vector<DrivenBody> driven_bodies(const Model& model);

}  // namespace freeplay::planar
