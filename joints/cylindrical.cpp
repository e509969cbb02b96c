#include "freeplay/kit/planar_marker.h"
#include "freeplay/plugin.h"
#include "spatial_marker.h"

namespace freeplay {
namespace {

enum class SleeveCoordinate { none, angle, position };

/// Sleeve on a shaft: the second origin stays on the z axis of marker a, x_a.d = 0 and y_a.d = 0 with d = P_b - P_a,
/// and the z axes agree (2 rows of `align_z_axes`). Free to slide by z_a.d and to turn by the angle of x_b about z_a;
/// one of both may be its coordinate.
class Cylindrical final : public Joint {
 public:
  explicit Cylindrical(const Parameters& p) : coordinate_(static_cast<SleeveCoordinate>(p.word("coordinate"))) {}

  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;
    layout.constraint_rows = 4;
    layout.rows_without_coordinate = 1;
    if (coordinate_ == SleeveCoordinate::angle) layout.coordinate = Coordinate::angle;
    if (coordinate_ == SleeveCoordinate::position) layout.coordinate = Coordinate::position;
  }
  void coordinate(const JointInput& in, CoordinateRow& row) const override {
    if (coordinate_ == SleeveCoordinate::angle) space::AngleAboutZ(in).write(row);
    if (coordinate_ == SleeveCoordinate::position) space::Separation(in).write_coordinate(space::axis(*in.a, 2), row);
  }
  void constrain(const JointInput& in, ConstraintRows& rows) const override {
    const space::Separation separation(in);
    separation.close(space::axis(*in.a, 0), 0, rows);
    separation.close(space::axis(*in.a, 1), 1, rows);
    space::align_z_axes(in, 2, rows);
  }
  bool place(double coordinate, Pose& b_in_a) const override {
    b_in_a = planar::pose(0.0, coordinate_ == SleeveCoordinate::angle ? coordinate : 0.0);
    if (coordinate_ == SleeveCoordinate::position) b_in_a.position[2] = coordinate;
    return true;
  }

 private:
  SleeveCoordinate coordinate_;
};

constexpr Parameter cylindrical_parameters[] = {
    {.name = "coordinate",
     .kind = ParameterKind::choice,
     .default_value = 0,
     .choices = "none|angle|position",
     .summary =
         "What drivers, gears and start values mean: the turn about z of the first frame, or the way along it."}};

}  // namespace

Component cylindrical() {
  return joint<Cylindrical>(
      {.name = "cylindrical",
       .space = Space::spatial,
       .summary = "Sleeve on a shaft: the second origin stays on the z axis of the first frame, the z axes agree.",
       .formula = "x_a.d = 0, y_a.d = 0 with d = P_b - P_a; 2 p.z_b/(1 + z_a.z_b) = 0 for p = x_a, y_a; position = "
                  "z_a.d, angle = atan2(y_a.x_b, x_a.x_b).",
       .references =
           "Nikravesh 1988, Computer-Aided Analysis of Mechanical Systems; Haug 1989, Computer Aided Kinematics "
           "and Dynamics of Mechanical Systems",
       .parameters = cylindrical_parameters,
       .first_end = "sleeve",
       .second_end = "shaft",
       .axis = MarkerAxis::z});
}

}  // namespace freeplay
