// Workspace: the shape of what a platform reaches on a grid of positions.
#pragma once

#include "analysis/station.h"

namespace freeplay {

/// Of a grid over some lengths of the pose, two or all three, with one value of all else; neighbours share an edge of
/// the grid.
struct WorkspaceShape {
  double size = 0.0;  ///< reachable points times the area or the volume between points [m^2 or m^3]
  int regions = 0;    ///< reachable points that hang together
  int holes = 0;      ///< unreachable points that hang together and do not touch the border of the grid
  /// Of two lengths: places of the frame on grid lines, between a point in reach and one out of it [m].
  std::vector<std::vector<double>> boundary;
  std::vector<std::array<double, 2>> bounds;  ///< of the points in reach, by length of the pose [m]; empty for none
};

/// The lengths that the grid runs over: in the plane x and y; in space those with more than one value. Empty where
/// these are fewer than two, where other numbers run as well, or where in the plane one of them is not given.
std::vector<std::size_t> lengths_of_grid(const PoseForm& form, std::span<const GridValues> axes,
                                         const Components& given);

/// `stations` as on_grid() gives them for `axes`, those of `lengths` (lengths_of_grid()) evenly spaced. Boundary points
/// are found by halving to 1e-9 of the distance between points, in space with fewer than six numbers to 2e-6 of it.
WorkspaceShape workspace_shape(IdealMechanism& mechanism, const std::vector<Station>& stations,
                               std::span<const GridValues> axes, const std::vector<std::size_t>& lengths,
                               const Tick& tick = {});

/// How far the frame gets from `pose`, which is in reach, in the direction `angle` [rad] before the first leg ends, at
/// most `longest` [m]; gaps narrower than a thousandth of it may be missed.
double reach_in_direction(IdealMechanism& mechanism, const FramePose& pose, double angle, double longest);

}  // namespace freeplay
