#include <numbers>

#include "freeplay/kit/planar_marker.h"
#include "freeplay/plugin.h"
#include "spatial_marker.h"

namespace freeplay {
namespace {

constexpr double one_turn = 2.0 * std::numbers::pi;

/// Nut on a screw: the rows of a sleeve on a shaft, x_a.d = 0, y_a.d = 0 with d = P_b - P_a and agreeing z axes, and
///
///   z_a.d - lead/(2 pi) theta - offset = 0
///
/// with theta the angle of b about z_a, counted over turns: the coordinate.
class Screw final : public Joint {
 public:
  explicit Screw(const Parameters& p) : per_angle_(p.number("lead") / one_turn), offset_(p.number("offset")) {
    if (per_angle_ == 0.0) throw BadParameter("lead", "out-of-range", "'lead' must not be 0");
  }

  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;
    layout.coordinate = Coordinate::angle;
    layout.constraint_rows = 5;
  }
  void coordinate(const JointInput& in, CoordinateRow& row) const override { space::AngleAboutZ(in).write(row); }
  void constrain(const JointInput& in, ConstraintRows& rows) const override {
    const space::Separation separation(in);
    separation.close(space::axis(*in.a, 0), 0, rows);
    separation.close(space::axis(*in.a, 1), 1, rows);
    space::align_z_axes(in, 2, rows);
    separation.close(space::axis(*in.a, 2), 4, rows);
    const space::AngleAboutZ angle(in);
    rows.phi[4] -= per_angle_ * in.coordinate + offset_;
    rows.gamma[4] += per_angle_ * angle.bias;
    double* row = space::row_of(rows, 4);
    for (int i = 0; i < 3; ++i) {
      row[space::turn_a + i] += per_angle_ * angle.row[i];
      row[space::turn_b + i] -= per_angle_ * angle.row[i];
    }
  }
  bool place(double angle, Pose& b_in_a) const override {
    b_in_a = planar::pose(0.0, angle);
    b_in_a.position[2] = per_angle_ * angle + offset_;
    return true;
  }

 private:
  double per_angle_, offset_;
};

constexpr Parameter screw_parameters[] = {
    {.name = "lead", .unit = "m", .summary = "Way along z in one turn about z; negative: a left-hand thread."},
    {.name = "offset", .unit = "m", .default_value = 0.0, .summary = "Way along z at the angle 0."}};

}  // namespace

Component screw() {
  return joint<Screw>(
      {.name = "screw",
       .space = Space::spatial,
       .summary = "Nut on a screw: the second frame turns about z of the first and moves along it in proportion.",
       .formula = "x_a.d = 0, y_a.d = 0 with d = P_b - P_a; 2 p.z_b/(1 + z_a.z_b) = 0 for p = x_a, y_a; z_a.d = lead "
                  "theta/(2 pi) + offset; coordinate: the angle theta, counted over turns.",
       .references = "Haug 1989, Computer Aided Kinematics and Dynamics of Mechanical Systems",
       .parameters = screw_parameters,
       .axis = MarkerAxis::z});
}

}  // namespace freeplay
