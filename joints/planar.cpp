#include "freeplay/plugin.h"
#include "spatial_marker.h"

namespace freeplay {
namespace {

/// A plate on a plane: the second origin stays in the plane through the first that is normal to z_a, z_a.d = 0 with
/// d = P_b - P_a, and the z axes agree (2 rows of `align_z_axes`). Free to slide in the plane and to turn in it.
class Planar final : public Joint {
 public:
  explicit Planar(const Parameters&) {}

  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;
    layout.constraint_rows = 3;
  }
  void constrain(const JointInput& in, ConstraintRows& rows) const override {
    space::Separation(in).close(space::axis(*in.a, 2), 0, rows);
    space::align_z_axes(in, 1, rows);
  }
};

}  // namespace

Component planar_joint() {
  return joint<Planar>(
      {.name = "planar",
       .space = Space::spatial,
       .summary = "Plate on a plane: the second origin stays in the xy-plane of the first frame, the z axes agree.",
       .formula = "z_a.d = 0 with d = P_b - P_a; 2 p.z_b/(1 + z_a.z_b) = 0 for p = x_a, y_a.",
       .references =
           "Nikravesh 1988, Computer-Aided Analysis of Mechanical Systems; Haug 1989, Computer Aided Kinematics "
           "and Dynamics of Mechanical Systems",
       .axis = MarkerAxis::z});
}

}  // namespace freeplay
