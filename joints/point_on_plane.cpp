#include "freeplay/plugin.h"
#include "spatial_marker.h"

namespace freeplay {
namespace {

/// The second origin stays in the xy-plane of marker a: z_a.d = 0 with d = P_b - P_a; the turn is free.
class PointOnPlane final : public Joint {
 public:
  explicit PointOnPlane(const Parameters&) {}

  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;
    layout.constraint_rows = 1;
  }
  void constrain(const JointInput& in, ConstraintRows& rows) const override {
    space::Separation(in).close(space::axis(*in.a, 2), 0, rows);
  }
};

}  // namespace

Component point_on_plane() {
  return joint<PointOnPlane>(
      {.name = "point-on-plane",
       .space = Space::spatial,
       .summary = "Ball on a plane: the second origin stays in the xy-plane of the first frame, all turns are free.",
       .formula = "z_a.(P_b - P_a) = 0.",
       .references =
           "Nikravesh 1988, Computer-Aided Analysis of Mechanical Systems; Haug 1989, Computer Aided Kinematics "
           "and Dynamics of Mechanical Systems",
       .axis = MarkerAxis::z});
}

}  // namespace freeplay
