#include "freeplay/kit/planar_slide.h"
#include "freeplay/plugin.h"
#include "rotation_vector.h"

namespace freeplay {
namespace {

using namespace planar;

/// Slider in the plane; `planar_slide.h` has the first row and the coordinate, the second row keeps the angles theta of
/// the markers together:
///
///   Phi_1 = n.d = 0        Phi_2 = theta_b - theta_a = 0, up to whole turns
class Prismatic final : public Joint {
 public:
  explicit Prismatic(const Parameters&) {}

  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;
    layout.coordinate = Coordinate::position;
    layout.rows_without_coordinate = 1;
    layout.constraint_rows = 2;
    layout.planar_rows = planar_rows;
    layout.planar_coordinate = 1;
  }
  void coordinate(const JointInput& in, CoordinateRow& row) const override { Slide(in).write_along(row); }
  void constrain(const JointInput& in, ConstraintRows& rows) const override {
    const Slide slide(in);
    rows.phi[0] = slide.across();
    rows.gamma[0] = slide.across_gamma();
    slide.write_across(rows.jacobian.data);
    rows.phi[1] = relative_angle(*in.a, *in.b);
    write_turn(rows.jacobian.data + 12);
  }
  bool place(double position, Pose& b_in_a) const override {
    b_in_a = pose(position, 0.0);
    return true;
  }

 private:
  static constexpr PlanarRow planar_rows[] = {PlanarRow::across, PlanarRow::turn};
};

/// Slider in space: the second origin stays on the x axis of marker a, y_a.d = 0 and z_a.d = 0 with d = P_b - P_a, and
/// the markers stay parallel: the rotation vector of b in a is zero (`rotation_vector.h`). Coordinate: x_a.d.
class SpatialPrismatic final : public Joint {
 public:
  explicit SpatialPrismatic(const Parameters&) {}

  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;
    layout.coordinate = Coordinate::position;
    layout.rows_without_coordinate = 1;
    layout.constraint_rows = 5;
  }
  void coordinate(const JointInput& in, CoordinateRow& row) const override {
    space::Separation(in).write_coordinate(space::axis(*in.a, 0), row);
  }
  void constrain(const JointInput& in, ConstraintRows& rows) const override {
    const space::Separation separation(in);
    separation.close(space::axis(*in.a, 1), 0, rows);
    separation.close(space::axis(*in.a, 2), 1, rows);
    space::RotationVector(in).close(in, 2, rows);
  }
  bool place(double position, Pose& b_in_a) const override {
    b_in_a = pose(position, 0.0);
    return true;
  }
};

}  // namespace

Component prismatic() {
  return joint<Prismatic>(
      {.name = "prismatic",
       .space = Space::both,
       .summary = "Slider: the second origin stays on the x axis of the first frame, the frames stay parallel.",
       .formula =
           "n.(P_b - P_a) = 0 with n normal to the x axis h of the first frame, theta_b - theta_a = 0 up to whole "
           "turns; in space for both normals of h, and the rotation vector of the second frame in the first is zero; "
           "coordinate: h.(P_b - P_a).",
       .references = "Nikravesh 1988, Computer-Aided Analysis of Mechanical Systems; Haug 1989, Computer "
                     "Aided Kinematics and Dynamics of Mechanical Systems",
       .axis = MarkerAxis::x,
       .in_space = joint_face<SpatialPrismatic>()});
}

}  // namespace freeplay
