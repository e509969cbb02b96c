#include "freeplay/plugin.h"
#include "spatial_marker.h"

namespace freeplay {
namespace {

/// Massless link with a pin about z_a at the first end and a ball at the second. With d = P_b - P_a [m], u = d/|d|:
///
///   Phi_1 = z_a.d = 0      Phi_2 = |d| - length = 0, gamma_2 = -|u x d'|^2/|d|
class RevoluteSpherical final : public Joint {
 public:
  explicit RevoluteSpherical(const Parameters& parameters) : length_(parameters.number("length")) {}

  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;
    layout.constraint_rows = 2;
  }
  void constrain(const JointInput& in, ConstraintRows& rows) const override {
    space::Separation(in).close(space::axis(*in.a, 2), 0, rows);
    const Eigen::Vector3d d = space::position(*in.b) - space::position(*in.a);
    const double distance = d.norm();
    // Where the origins coincide, x_a stands for u, so that an assembly finds its way out.
    const Eigen::Vector3d u = distance > 0.0 ? Eigen::Vector3d(d / distance) : space::axis(*in.a, 0);
    rows.phi[1] = distance - length_;
    space::write(space::row_of(rows, 1), space::velocity_a, -u);
    space::write(space::row_of(rows, 1), space::velocity_b, u);
    const double across = u.cross(space::velocity(*in.b) - space::velocity(*in.a)).squaredNorm();
    rows.gamma[1] = distance > 0.0 ? -across / distance : 0.0;
  }

 private:
  double length_;
};

constexpr Parameter revolute_spherical_parameters[] = {
    {.name = "length", .unit = "m", .minimum = 0.0, .open = Open::minimum, .summary = "Length of the link."}};

}  // namespace

Component revolute_spherical() {
  return joint<RevoluteSpherical>(
      {.name = "revolute-spherical",
       .space = Space::spatial,
       .summary = "Massless link with a pin about z of the first frame and a ball at the second origin.",
       .formula = "z_a.d = 0, |d| = length with d = P_b - P_a.",
       .references = "Haug 1989, Computer Aided Kinematics and Dynamics of Mechanical Systems, composite joints",
       .parameters = revolute_spherical_parameters,
       .axis = MarkerAxis::z});
}

}  // namespace freeplay
