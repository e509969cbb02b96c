#include "freeplay/kit/planar_marker.h"
#include "freeplay/plugin.h"
#include "spatial_marker.h"

namespace freeplay {
namespace {

/// Ball and socket: P_b - P_a = 0, three rows in world axes; all turns are free. The coordinate, if there is one, is
/// the angle of x_b about z_a.
class Spherical final : public Joint {
 public:
  explicit Spherical(const Parameters& p) : has_angle_(p.word("coordinate") == 1) {}

  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;
    layout.constraint_rows = 3;
    layout.rows_without_coordinate = 1;
    if (has_angle_) layout.coordinate = Coordinate::angle;
  }
  void coordinate(const JointInput& in, CoordinateRow& row) const override {
    if (has_angle_) space::AngleAboutZ(in).write(row);
  }
  void constrain(const JointInput& in, ConstraintRows& rows) const override { space::join_origins(in, 0, rows); }
  bool place(double angle, Pose& b_in_a) const override {
    b_in_a = planar::pose(0.0, has_angle_ ? angle : 0.0);
    return true;
  }

 private:
  bool has_angle_;
};

constexpr Parameter spherical_parameters[] = {
    {.name = "coordinate",
     .kind = ParameterKind::choice,
     .default_value = 0,
     .choices = "none|angle",
     .summary = "The angle that drivers, gears and start values mean: of the second frame about z of the first."}};

}  // namespace

Component spherical() {
  return joint<Spherical>(
      {.name = "spherical",
       .space = Space::spatial,
       .summary = "Ball and socket: the origins of both frames coincide, all turns are free.",
       .formula = "P_b - P_a = 0; angle = atan2(y_a.x_b, x_a.x_b).",
       .references =
           "Nikravesh 1988, Computer-Aided Analysis of Mechanical Systems; Haug 1989, Computer Aided Kinematics "
           "and Dynamics of Mechanical Systems",
       .parameters = spherical_parameters,
       .first_end = "socket",
       .second_end = "ball"});
}

}  // namespace freeplay
