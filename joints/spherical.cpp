#include "freeplay/kit/planar_marker.h"
#include "freeplay/plugin.h"
#include "spatial_marker.h"

namespace freeplay {
namespace {

/// Ball and socket: P_b - P_a = 0, three rows in world axes; all turns are free.
class Spherical final : public Joint {
 public:
  explicit Spherical(const Parameters&) {}

  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;
    layout.constraint_rows = 3;
  }
  void constrain(const JointInput& in, ConstraintRows& rows) const override { space::join_origins(in, 0, rows); }
  bool place(double, Pose& b_in_a) const override {
    b_in_a = planar::pose(0.0, 0.0);
    return true;
  }
};

}  // namespace

Component spherical() {
  return joint<Spherical>(
      {.name = "spherical",
       .space = Space::spatial,
       .summary = "Ball and socket: the origins of both frames coincide, all turns are free.",
       .formula = "P_b - P_a = 0.",
       .references =
           "Nikravesh 1988, Computer-Aided Analysis of Mechanical Systems; Haug 1989, Computer Aided Kinematics "
           "and Dynamics of Mechanical Systems",
       .first_end = "socket",
       .second_end = "ball"});
}

}  // namespace freeplay
