#include "freeplay/kit/planar_slide.h"
#include "freeplay/plugin.h"
#include "spatial_marker.h"

namespace freeplay {
namespace {

using namespace planar;

/// Pin in a straight slot, in the plane: the row across the slot of `planar_slide.h`; the turn is free.
class PointOnLine final : public Joint {
 public:
  explicit PointOnLine(const Parameters&) {}

  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;
    layout.coordinate = Coordinate::position;
    layout.rows_without_coordinate = 1;
    layout.constraint_rows = 1;
    layout.planar_rows = planar_rows;
    layout.planar_coordinate = 1;
  }
  void coordinate(const JointInput& in, CoordinateRow& row) const override { Slide(in).write_along(row); }
  void constrain(const JointInput& in, ConstraintRows& rows) const override {
    const Slide slide(in);
    rows.phi[0] = slide.across();
    rows.gamma[0] = slide.across_gamma();
    slide.write_across(rows.jacobian.data);
  }

 private:
  static constexpr PlanarRow planar_rows[] = {PlanarRow::across};
};

/// Ball in a straight slot, in space: y_a.d = 0 and z_a.d = 0 with d = P_b - P_a; all turns are free.
class SpatialPointOnLine final : public Joint {
 public:
  explicit SpatialPointOnLine(const Parameters&) {}

  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;
    layout.coordinate = Coordinate::position;
    layout.rows_without_coordinate = 1;
    layout.constraint_rows = 2;
  }
  void coordinate(const JointInput& in, CoordinateRow& row) const override {
    space::Separation(in).write_coordinate(space::axis(*in.a, 0), row);
  }
  void constrain(const JointInput& in, ConstraintRows& rows) const override {
    const space::Separation separation(in);
    separation.close(space::axis(*in.a, 1), 0, rows);
    separation.close(space::axis(*in.a, 2), 1, rows);
  }
};

}  // namespace

Component point_on_line() {
  return joint<PointOnLine>(
      {.name = "point-on-line",
       .space = Space::both,
       .summary = "Pin in a slot: the second origin stays on the x axis of the first frame, the turn is free.",
       .formula = "n.(P_b - P_a) = 0 with n normal to the x axis h of the first frame, in space for both normals; "
                  "coordinate: h.(P_b - P_a).",
       .references = "Nikravesh 1988, Computer-Aided Analysis of Mechanical Systems; Haug 1989, Computer "
                     "Aided Kinematics and Dynamics of Mechanical Systems",
       .axis = MarkerAxis::x,
       .in_space = joint_face<SpatialPointOnLine>()});
}

}  // namespace freeplay
