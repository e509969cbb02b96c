#include <cmath>
#include <numbers>

#include "freeplay/kit/planar_marker.h"
#include "freeplay/plugin.h"
#include "spatial_marker.h"

namespace freeplay {
namespace {

/// The marker with its axes named anew, in turn, so that axis `x` is its x axis.
MarkerKinematics renamed(const MarkerKinematics& marker, std::size_t x) {
  MarkerKinematics out = marker;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t k = 0; k < 3; ++k) out.rotation[3 * row + k] = marker.rotation[3 * row + (x + k) % 3];
  }
  return out;
}

enum class ForkAngle { neither, first, second };

/// Cardan joint: P_b - P_a = 0 and x_a.y_b = 0: the cross has one arm along x_a and one along y_b. Regular but where
/// these are parallel. The cross turns by phi_1 about x_a, b by phi_2 about the y axis of the cross, which is y_b:
///
///   phi_1 = atan2(z_a.y_b, y_a.y_b)      phi_2 = atan2(x_a.z_b, x_a.x_b)
///
/// The second is a quarter turn less the angle of x_a about y_b, from z_b on.
class Universal final : public Joint {
 public:
  explicit Universal(const Parameters& p) : angle_(static_cast<ForkAngle>(p.word("coordinate"))) {}

  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;
    layout.constraint_rows = 4;
    layout.rows_without_coordinate = 1;
    if (angle_ != ForkAngle::neither) layout.coordinate = Coordinate::angle;
  }
  void coordinate(const JointInput& in, CoordinateRow& row) const override {
    if (angle_ == ForkAngle::neither) return;
    const bool is_first = angle_ == ForkAngle::first;
    const MarkerKinematics from = is_first ? renamed(*in.a, 1) : renamed(*in.b, 2),
                           to = is_first ? renamed(*in.b, 1) : *in.a;
    JointInput seen = in;
    seen.a = &from;
    seen.b = &to;
    const space::AngleAboutZ angle(seen);
    if (is_first) return angle.write(row);
    row.value = std::remainder(0.5 * std::numbers::pi - angle.value, 2.0 * std::numbers::pi);
    row.bias = -angle.bias;
    space::write_turn(row.jacobian, angle.row);
  }
  void constrain(const JointInput& in, ConstraintRows& rows) const override {
    space::join_origins(in, 0, rows);
    space::keep_perpendicular(in, space::axis(*in.a, 0), space::axis(*in.b, 1), 3, rows);
  }
  /// The other angle is 0.
  bool place(double coordinate, Pose& b_in_a) const override {
    b_in_a = planar::pose(0.0, 0.0);
    if (angle_ == ForkAngle::neither) return true;
    const std::size_t about = angle_ == ForkAngle::first ? 0 : 1, from = (about + 1) % 3, to = (about + 2) % 3;
    b_in_a.rotation[4 * from] = b_in_a.rotation[4 * to] = std::cos(coordinate);
    b_in_a.rotation[3 * to + from] = std::sin(coordinate);
    b_in_a.rotation[3 * from + to] = -std::sin(coordinate);
    return true;
  }

 private:
  ForkAngle angle_;
};

constexpr Parameter universal_parameters[] = {
    {.name = "coordinate",
     .kind = ParameterKind::choice,
     .default_value = 0,
     .choices = "none|first|second",
     .summary = "The angle that drivers, gears and start values mean: of the cross about x of the first frame, or of "
                "the second frame about its y against the cross."}};

}  // namespace

Component universal() {
  return joint<Universal>(
      {.name = "universal",
       .space = Space::spatial,
       .summary = "Cardan joint: the origins coincide, the y axis of the second frame stays perpendicular to the x "
                  "axis of the first.",
       .formula = "P_b - P_a = 0, x_a.y_b = 0; first = atan2(z_a.y_b, y_a.y_b), second = atan2(x_a.z_b, x_a.x_b).",
       .references =
           "Nikravesh 1988, Computer-Aided Analysis of Mechanical Systems; Haug 1989, Computer Aided Kinematics "
           "and Dynamics of Mechanical Systems",
       .parameters = universal_parameters});
}

}  // namespace freeplay
