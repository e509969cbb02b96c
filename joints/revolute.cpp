#include "freeplay/kit/planar_marker.h"
#include "freeplay/plugin.h"
#include "spatial_marker.h"

namespace freeplay {
namespace {

using namespace planar;

/// Ideal pin in the plane. Two rows and their derivatives, markers a and b with origins P_a, P_b [m]:
///
///   Phi = P_b - P_a = 0        d(Phi)/dt = v_b - v_a        gamma = 0
///
/// Coordinate: the angle of marker b relative to marker a [rad]. Nikravesh 1988.
class Revolute final : public Joint {
 public:
  explicit Revolute(const Parameters&) {}

  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;
    layout.coordinate = Coordinate::angle;
    layout.rows_without_coordinate = 1;
    layout.constraint_rows = 2;
    layout.pin = 1;
    layout.planar_rows = planar_rows;
    layout.planar_coordinate = 1;
  }
  void coordinate(const JointInput& in, CoordinateRow& row) const override {
    row.value = relative_angle(*in.a, *in.b);
    write_turn(row.jacobian);
  }
  void constrain(const JointInput& in, ConstraintRows& rows) const override {
    for (int i = 0; i < 2; ++i) {
      rows.phi.data[i] = in.b->position[i] - in.a->position[i];
      rows.jacobian.data[12 * i + velocity_a + i] = -1.0;
      rows.jacobian.data[12 * i + velocity_b + i] = 1.0;
    }
  }
  bool place(double angle, Pose& b_in_a) const override {
    b_in_a = pose(0.0, angle);
    return true;
  }

 private:
  static constexpr PlanarRow planar_rows[] = {PlanarRow::origins};
};

/// Ideal hinge in space: the origins coincide (3 rows, world axes) and the z axes agree (2 rows of `align_z_axes`).
/// Coordinate: the angle of marker b about the z axis of marker a [rad]. With all z axes those of the world, forces
/// and motions in the plane are those of the joint above.
class SpatialRevolute final : public Joint {
 public:
  explicit SpatialRevolute(const Parameters&) {}

  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;
    layout.coordinate = Coordinate::angle;
    layout.rows_without_coordinate = 1;
    layout.constraint_rows = 5;
  }
  void coordinate(const JointInput& in, CoordinateRow& row) const override { space::AngleAboutZ(in).write(row); }
  void constrain(const JointInput& in, ConstraintRows& rows) const override {
    space::join_origins(in, 0, rows);
    space::align_z_axes(in, 3, rows);
  }
  bool place(double angle, Pose& b_in_a) const override {
    b_in_a = pose(0.0, angle);
    return true;
  }
};

}  // namespace

Component revolute() {
  return joint<Revolute>(
      {.name = "revolute",
       .space = Space::both,
       .summary = "Pin: the origins of both frames coincide, the turn about z is free.",
       .formula = "P_b - P_a = 0; in space the z axes agree, too: 2 p.z_b/(1 + z_a.z_b) = 0 for p = x_a, y_a; "
                  "coordinate: angle of the second frame relative to the first, about z.",
       .references = "Nikravesh 1988, Computer-Aided Analysis of Mechanical Systems",
       .first_end = "bearing",
       .second_end = "journal",
       .axis = MarkerAxis::z,
       .in_space = joint_face<SpatialRevolute>()});
}

}  // namespace freeplay
