// What a joint leaves free where it stands, from its constraint rows alone.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "component/joint_ref.h"
#include "model/model.h"

namespace freeplay {

struct JointFreedom {
  int slides = 3;                                    ///< free directions of the second origin while nothing turns
  int turns = 3;                                     ///< free turns
  Eigen::Vector3d slide = Eigen::Vector3d::UnitX();  ///< one slide: along it; two: the normal of their plane
  Eigen::Vector3d turn = Eigen::Vector3d::UnitZ();   ///< one turn: its axis; two: the axis about which there is none
};

/// Freedom of a joint of a spatial model whose markers are where `a` and `b` say; vectors are of length 1, world axes.
/// A joint that fails there counts as one that leaves nothing free.
JointFreedom joint_freedom(const JointRef& joint, const JointLayout& layout, const MarkerKinematics& a,
                           const MarkerKinematics& b);

/// In how many directions the second origin may move against the first, whether the joint turns with it, as a nut on
/// its thread does, or not; of a planar joint with the one across the plane. Nothing where the joint fails.
std::optional<int> ways_of_origin(const JointRef& joint, const JointLayout& layout, const MarkerKinematics& a,
                                  const MarkerKinematics& b);

/// Whether the ideal joint leaves its second origin no way to move against the first, as a pin or a ball.
bool holds_origins(const JointElement& element, Space space);

}  // namespace freeplay
