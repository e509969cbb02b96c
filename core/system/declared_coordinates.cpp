#include "system/declared_coordinates.h"

#include <cmath>

#include "base/angle.h"
#include "base/index.h"
#include "system/joints.h"
#include "system/slide_line.h"

namespace freeplay::planar {

void DeclaredCoordinates::add(Coordinate kind, const JointEnds& ends, int joint, unsigned terms, int turn) {
  (kind == Coordinate::angle ? angles_ : positions_).push_back({ends, joint, turn, terms});
  terms_ |= terms;
}

void DeclaredCoordinates::write_constants(JointValues& joints) const {
  for (const JointCoordinate& angle : angles_) {
    joints.coordinate_rows[at(angle.joint)].jacobian[5] = -1.0;
    joints.coordinate_rows[at(angle.joint)].jacobian[11] = 1.0;
  }
}

void DeclaredCoordinates::fill_wanted(const Point& point, std::span<const Mount> mounts, unsigned terms,
                                      const MarkerValues& bodies, JointValues& joints) const {
  for (const JointCoordinate& angle : angles_) {
    if ((angle.terms & terms) == 0) continue;
    const Arm &a = bodies.arms[at(angle.ends.marker_a)], &b = bodies.arms[at(angle.ends.marker_b)];
    double value = angle_between(angle.ends, mounts, bodies);
    // The turn nearest to the last accepted angle: a step never turns a joint by more than half a revolution.
    const double off = (angle.turn < 0 ? 0.0 : point.h[at(angle.turn)]) - value;
    if (std::abs(off) > M_PI) value += whole_turn * std::round(off / whole_turn);
    joints.coordinate[at(angle.joint)] = joints.coordinate_rows[at(angle.joint)].value = value;
    joints.coordinate_rate[at(angle.joint)] = b.w - a.w;
  }
  for (const JointCoordinate& position : positions_) {
    if ((position.terms & terms) == 0) continue;
    const SlideLine s(position.ends, mounts, bodies);
    CoordinateRow& row = joints.coordinate_rows[at(position.joint)];
    joints.coordinate[at(position.joint)] = row.value = s.along();
    joints.coordinate_rate[at(position.joint)] = s.rate_along() + s.a.w * s.across();
    row.bias = 2.0 * s.a.w * s.rate_across() - s.a.w * s.a.w * s.along();
    row.jacobian[0] = -s.h_x;
    row.jacobian[1] = -s.h_y;
    row.jacobian[5] = s.across();
    row.jacobian[6] = s.h_x;
    row.jacobian[7] = s.h_y;
  }
}

}  // namespace freeplay::planar
