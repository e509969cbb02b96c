#include "freeplay/kit/planar_marker.h"
#include "freeplay/plugin.h"
#include "spatial_marker.h"

namespace freeplay {
namespace {

/// Cardan joint: P_b - P_a = 0 and x_a.y_b = 0: the cross has one arm along x_a and one along y_b. Regular but where
/// these are parallel.
class Universal final : public Joint {
 public:
  explicit Universal(const Parameters&) {}

  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;
    layout.constraint_rows = 4;
  }
  void constrain(const JointInput& in, ConstraintRows& rows) const override {
    space::join_origins(in, 0, rows);
    space::keep_perpendicular(in, space::axis(*in.a, 0), space::axis(*in.b, 1), 3, rows);
  }
  bool place(double, Pose& b_in_a) const override {
    b_in_a = planar::pose(0.0, 0.0);
    return true;
  }
};

}  // namespace

Component universal() {
  return joint<Universal>(
      {.name = "universal",
       .space = Space::spatial,
       .summary = "Cardan joint: the origins coincide, the y axis of the second frame stays perpendicular to the x "
                  "axis of the first.",
       .formula = "P_b - P_a = 0, x_a.y_b = 0.",
       .references =
           "Nikravesh 1988, Computer-Aided Analysis of Mechanical Systems; Haug 1989, Computer Aided Kinematics "
           "and Dynamics of Mechanical Systems"});
}

}  // namespace freeplay
