#include "freeplay/plugin.h"
#include "planar_marker.h"

namespace freeplay {
namespace {

using namespace planar;

/// Slider in the plane. With d = P_b - P_a [m], h the x axis of marker a, n = h turned by +90 degrees, angles theta
/// and angular velocities w of the markers:
///
///   Phi_1 = n.d = 0                   Phi_2 = theta_b - theta_a = 0, up to whole turns
///   Phi_1' = n.(v_b - v_a) - w_a h.d  Phi_2' = w_b - w_a
///   gamma_1 = 2 w_a h.d' + w_a^2 n.d  gamma_2 = 0
///
/// Terms with n.d stay, so that gamma is exact off the constraint too. Coordinate [m]:
///
///   s = h.d,  s' = h.(v_b - v_a) + w_a n.d,  bias = 2 w_a n.d' - w_a^2 h.d
///
/// Nikravesh 1988; Haug 1989.
class Prismatic final : public Joint {
 public:
  explicit Prismatic(const Parameters&) {}

  void declare(JointLayout& layout) const override {
    layout.coordinate = Coordinate::position;
    layout.constraint_rows = 2;
  }
  void coordinate(const JointInput& in, CoordinateRow& row) const override {
    const Line line(in);
    const double w = angular_velocity(*in.a);
    row.value = line.h.dot(line.d);
    row.bias = 2.0 * w * line.n.dot(line.rate) - w * w * line.h.dot(line.d);
    write_row(row.jacobian, line.h, line.n.dot(line.d));
  }
  void constrain(const JointInput& in, ConstraintRows& rows) const override {
    const Line line(in);
    const double w = angular_velocity(*in.a);
    rows.phi[0] = line.n.dot(line.d);
    rows.gamma[0] = 2.0 * w * line.h.dot(line.rate) + w * w * line.n.dot(line.d);
    write_row(rows.jacobian.data, line.n, -line.h.dot(line.d));
    rows.phi[1] = relative_angle(*in.a, *in.b);
    write_turn(rows.jacobian.data + 12);
  }
  bool place(double position, Pose& b_in_a) const override {
    b_in_a = pose(position, 0.0);
    return true;
  }

 private:
  struct Line {
    explicit Line(const JointInput& in)
        : h(x_axis(*in.a)),
          n(turned(h)),
          d(position(*in.b) - position(*in.a)),
          rate(velocity(*in.b) - velocity(*in.a)) {}
    Eigen::Vector2d h, n, d, rate;
  };

  static void write_row(double* row, const Eigen::Vector2d& direction, double turn) {
    for (int i = 0; i < 2; ++i) {
      row[velocity_a + i] = -direction[i];
      row[velocity_b + i] = direction[i];
    }
    row[turn_a] = turn;
  }
};

}  // namespace

Component prismatic() {
  return joint<Prismatic>(
      {.name = "prismatic",
       .space = Space::planar,
       .summary = "Slider: the second origin stays on the x axis of the first frame, the frames stay parallel.",
       .formula =
           "n.(P_b - P_a) = 0 with n normal to the x axis h of the first frame, theta_b - theta_a = 0 up to whole "
           "turns; coordinate: h.(P_b - P_a).",
       .references = "Nikravesh 1988, Computer-Aided Analysis of Mechanical Systems; Haug 1989, Computer "
                     "Aided Kinematics and Dynamics of Mechanical Systems"});
}

}  // namespace freeplay
