// Types of spatial bodies, without what is done with them: see spatial_kinematics.h.
#pragma once

#include <Eigen/Core>

#include "model/model.h"

namespace freeplay::spatial {

using Vector = Eigen::Vector3d;
using Matrix = Eigen::Matrix3d;

inline constexpr int coordinates = 7, velocities = 6;
/// Entries of a twist or wrench that a spatial model has: all.
inline constexpr int components[6] = {0, 1, 2, 3, 4, 5};

/// What a marker's place on its body comes to, found once.
struct Mount {
  BodyId body = ground;
  Vector position = Vector::Zero();      ///< offset from the centre of mass, principal axes [m]
  Matrix rotation = Matrix::Identity();  ///< principal axes from the marker's
};

/// Orientation of a body (world from principal axes) and its angular velocity in world axes.
struct Turn {
  Matrix rotation = Matrix::Identity();
  Vector w = Vector::Zero();
};

/// Offset of a marker from its body's centre of mass in world axes [m], and the body's Turn.
struct Arm {
  Vector s = Vector::Zero();
  Turn turn;
};

/// The types above, for code that serves both spaces.
struct Bodies {
  using Mount = spatial::Mount;
  using Turn = spatial::Turn;
  using Arm = spatial::Arm;
  static constexpr int coordinates = spatial::coordinates, velocities = spatial::velocities;
};

}  // namespace freeplay::spatial
