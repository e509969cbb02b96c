#include "freeplay/kit/planar_marker.h"
#include "freeplay/plugin.h"
#include "rotation_vector.h"

namespace freeplay {
namespace {

using namespace planar;

/// Two markers that coincide, in the plane. With origins P [m] and angles theta:
///
///   Phi = (P_b - P_a, theta_b - theta_a) = 0, the angle up to whole turns
///   d(Phi)/dt = (v_b - v_a, w_b - w_a)        gamma = 0
class Fixed final : public Joint {
 public:
  explicit Fixed(const Parameters&) {}

  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;
    layout.constraint_rows = 3;
    layout.planar_rows = planar_rows;
  }
  void constrain(const JointInput& in, ConstraintRows& rows) const override {
    for (int i = 0; i < 2; ++i) {
      rows.phi.data[i] = in.b->position[i] - in.a->position[i];
      rows.jacobian.data[12 * i + velocity_a + i] = -1.0;
      rows.jacobian.data[12 * i + velocity_b + i] = 1.0;
    }
    rows.phi[2] = relative_angle(*in.a, *in.b);
    write_turn(rows.jacobian.data + 24);
  }
  bool place(double, Pose& b_in_a) const override {
    b_in_a = pose(0.0, 0.0);
    return true;
  }

 private:
  static constexpr PlanarRow planar_rows[] = {PlanarRow::origins, PlanarRow::turn};
};

/// Two markers that coincide, in space: P_b - P_a = 0, and the rotation vector of b in a is zero.
class SpatialFixed final : public Joint {
 public:
  explicit SpatialFixed(const Parameters&) {}

  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;
    layout.constraint_rows = 6;
  }
  void constrain(const JointInput& in, ConstraintRows& rows) const override {
    space::join_origins(in, 0, rows);
    space::RotationVector(in).close(in, 3, rows);
  }
  bool place(double, Pose& b_in_a) const override {
    b_in_a = pose(0.0, 0.0);
    return true;
  }
};

}  // namespace

Component fixed() {
  return joint<Fixed>({.name = "fixed",
                       .space = Space::both,
                       .summary = "Weld: both frames coincide.",
                       .formula = "P_b - P_a = 0, theta_b - theta_a = 0 up to whole turns; in space the "
                                  "rotation vector of the second frame in the first is zero.",
                       .in_space = joint_face<SpatialFixed>()});
}

}  // namespace freeplay
