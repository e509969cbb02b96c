// DeclaredCoordinates: coordinates that planar joints declare (JointLayout::planar_coordinate), made for all joints at
// once.
#pragma once

#include <span>
#include <vector>

#include "freeplay/joint.h"
#include "system/joint_ends.h"
#include "system/markers.h"

namespace freeplay {
struct JointValues;
}  // namespace freeplay

namespace freeplay::planar {

class DeclaredCoordinates {
 public:
  /// `terms`: evaluations in which it is wanted. `turn`: into h, the angle whose nearest turn it takes; -1 for that of
  /// zero.
  void add(Coordinate kind, const JointEnds& ends, int joint, unsigned terms, int turn);

  /// Numbers that no motion changes.
  void write_constants(JointValues& joints) const;
  /// Those that are wanted for these terms, where bodies and markers are.
  void fill(const Point& point, std::span<const Mount> mounts, unsigned terms, const MarkerValues& bodies,
            JointValues& joints) const {
    if ((terms_ & terms) != 0) fill_wanted(point, mounts, terms, bodies, joints);
  }

 private:
  void fill_wanted(const Point& point, std::span<const Mount> mounts, unsigned terms, const MarkerValues& bodies,
                   JointValues& joints) const;
  struct JointCoordinate {
    JointEnds ends;
    int joint, turn;
    unsigned terms;
  };
  std::vector<JointCoordinate> angles_, positions_;
  unsigned terms_ = 0;  // evaluations in which any of them is wanted
};

}  // namespace freeplay::planar
