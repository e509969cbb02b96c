#include "freeplay/plugin.h"
#include "planar_slide.h"

namespace freeplay {
namespace {

using namespace planar;

/// Pin in a straight slot, in the plane: the row across the slot of `planar_slide.h`; the turn is free.
class PointOnLine final : public Joint {
 public:
  explicit PointOnLine(const Parameters&) {}

  void declare(JointLayout& layout) const override {
    layout.coordinate = Coordinate::position;
    layout.rows_without_coordinate = 1;
    layout.constraint_rows = 1;
  }
  void coordinate(const JointInput& in, CoordinateRow& row) const override { Slide(in).write_along(row); }
  void constrain(const JointInput& in, ConstraintRows& rows) const override {
    const Slide slide(in);
    rows.phi[0] = slide.across();
    rows.gamma[0] = slide.across_gamma();
    slide.write_across(rows.jacobian.data);
  }
};

}  // namespace

Component point_on_line() {
  return joint<PointOnLine>(
      {.name = "point-on-line",
       .space = Space::planar,
       .summary = "Pin in a slot: the second origin stays on the x axis of the first frame, the turn is free.",
       .formula = "n.(P_b - P_a) = 0 with n normal to the x axis h of the first frame; coordinate: h.(P_b - P_a).",
       .references = "Nikravesh 1988, Computer-Aided Analysis of Mechanical Systems; Haug 1989, Computer "
                     "Aided Kinematics and Dynamics of Mechanical Systems"});
}

}  // namespace freeplay
