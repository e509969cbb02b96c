// What the rows and the coordinate that a planar joint declares (JointLayout::planar_rows) come to between two markers.
#pragma once

#include <array>
#include <vector>

#include "freeplay/joint.h"

namespace freeplay {

/// One row: value, entries by [twist a, twist b], and gamma (of a coordinate: minus its bias).
struct DeclaredRow {
  double value = 0.0;
  std::array<double, 12> jacobian{};
  double gamma = 0.0;
  bool is_angle = false;  ///< known up to whole turns
};

std::vector<DeclaredRow> declared_rows(Span<const PlanarRow> rows, const MarkerKinematics& a,
                                       const MarkerKinematics& b);
DeclaredRow declared_coordinate(Coordinate kind, const MarkerKinematics& a, const MarkerKinematics& b);

}  // namespace freeplay
