#include "freeplay/kit/planar_marker.h"
#include "freeplay/plugin.h"
#include "spatial_marker.h"

namespace freeplay {
namespace {

/// Sleeve on a shaft: the second origin stays on the z axis of marker a, x_a.d = 0 and y_a.d = 0 with d = P_b - P_a,
/// and the z axes agree (2 rows of `align_z_axes`). Free to slide and to turn; it has two coordinates, and so none that
/// a driver could mean.
class Cylindrical final : public Joint {
 public:
  explicit Cylindrical(const Parameters&) {}

  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;
    layout.constraint_rows = 4;
  }
  void constrain(const JointInput& in, ConstraintRows& rows) const override {
    const space::Separation separation(in);
    separation.close(space::axis(*in.a, 0), 0, rows);
    separation.close(space::axis(*in.a, 1), 1, rows);
    space::align_z_axes(in, 2, rows);
  }
  bool place(double, Pose& b_in_a) const override {
    b_in_a = planar::pose(0.0, 0.0);
    return true;
  }
};

}  // namespace

Component cylindrical() {
  return joint<Cylindrical>(
      {.name = "cylindrical",
       .space = Space::spatial,
       .summary = "Sleeve on a shaft: the second origin stays on the z axis of the first frame, the z axes agree.",
       .formula = "x_a.d = 0, y_a.d = 0 with d = P_b - P_a; 2 p.z_b/(1 + z_a.z_b) = 0 for p = x_a, y_a.",
       .references =
           "Nikravesh 1988, Computer-Aided Analysis of Mechanical Systems; Haug 1989, Computer Aided Kinematics "
           "and Dynamics of Mechanical Systems",
       .axis = MarkerAxis::z});
}

}  // namespace freeplay
