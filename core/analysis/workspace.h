// Workspace: the shape of what a platform reaches on a grid of positions.
#pragma once

#include "analysis/station.h"

namespace freeplay {

/// Of a grid of x and y, one angle; neighbours share an edge of the grid.
struct WorkspaceShape {
  double area = 0.0;  ///< reachable points times the area between points [m^2]
  int regions = 0;    ///< reachable points that hang together
  int holes = 0;      ///< unreachable points that hang together and do not touch the border of the grid
  std::vector<std::array<double, 2>> boundary;  ///< on grid lines between a point in reach and one out of it [m]
};

/// `stations` as on_grid() gives them for `axes`, both of them evenly spaced. Boundary points are found by halving to
/// 1e-9 of the distance between points.
WorkspaceShape workspace_shape(IdealMechanism& mechanism, const std::vector<Station>& stations,
                               const std::array<GridValues, 3>& axes, const Tick& tick = {});

/// How far the frame gets from `pose`, which is in reach, in the direction `angle` [rad] before the first leg ends, at
/// most `longest` [m]; gaps narrower than a thousandth of it may be missed.
double reach_in_direction(IdealMechanism& mechanism, const FramePose& pose, double angle, double longest);

}  // namespace freeplay
