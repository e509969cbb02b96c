#include "freeplay/kit/planar_marker.h"
#include "freeplay/plugin.h"
#include "spatial_marker.h"

namespace freeplay {
namespace {

using namespace planar;

/// Massless rod between two origins, in the plane. With d = P_b - P_a [m], |d| > 0 and u = d/|d|:
///
///   Phi = |d| - length = 0        Phi' = u.d'        gamma = -(d'.d' - (u.d')^2)/|d|
///
/// Where the origins coincide the x axis of marker a stands for u, so that an assembly finds its way out.
/// Nikravesh 1988; Haug 1989.
class Distance final : public Joint {
 public:
  explicit Distance(const Parameters& parameters) : length_(parameters.number("length")) {}

  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;
    layout.constraint_rows = 1;
  }
  void constrain(const JointInput& in, ConstraintRows& rows) const override {
    const Eigen::Vector2d d = position(*in.b) - position(*in.a), rate = velocity(*in.b) - velocity(*in.a);
    const double distance = d.norm();
    const bool apart = distance > 0.0;
    const Eigen::Vector2d u = apart ? Eigen::Vector2d(d / distance) : x_axis(*in.a);
    rows.phi[0] = distance - length_;
    for (int i = 0; i < 2; ++i) {
      rows.jacobian.data[velocity_a + i] = -u[i];
      rows.jacobian.data[velocity_b + i] = u[i];
    }
    const double across = turned(u).dot(rate);
    rows.gamma[0] = apart ? -across * across / distance : 0.0;
  }

 private:
  double length_;
};

/// The same in space; there d' - (u.d') u is what lies across the rod.
class SpatialDistance final : public Joint {
 public:
  explicit SpatialDistance(const Parameters& parameters) : length_(parameters.number("length")) {}

  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;
    layout.constraint_rows = 1;
  }
  void constrain(const JointInput& in, ConstraintRows& rows) const override {
    const Eigen::Vector3d d = space::position(*in.b) - space::position(*in.a);
    const double distance = d.norm();
    const bool apart = distance > 0.0;
    const Eigen::Vector3d u = apart ? Eigen::Vector3d(d / distance) : space::axis(*in.a, 0);
    rows.phi[0] = distance - length_;
    space::write(rows.jacobian.data, space::velocity_a, -u);
    space::write(rows.jacobian.data, space::velocity_b, u);
    const double across = u.cross(space::velocity(*in.b) - space::velocity(*in.a)).squaredNorm();
    rows.gamma[0] = apart ? -across / distance : 0.0;
  }

 private:
  double length_;
};

constexpr Parameter distance_parameters[] = {
    {.name = "length", .unit = "m", .minimum = 0.0, .open = Open::minimum, .summary = "Distance of the origins."}};

}  // namespace

Component distance() {
  return joint<Distance>({.name = "distance",
                          .space = Space::both,
                          .summary = "Massless rod: the origins of both frames stay a length apart.",
                          .formula = "|P_b - P_a| = length.",
                          .references = "Nikravesh 1988, Computer-Aided Analysis of Mechanical Systems; Haug 1989, "
                                        "Computer Aided Kinematics and Dynamics of Mechanical Systems",
                          .parameters = distance_parameters,
                          .in_space = joint_face<SpatialDistance>()});
}

}  // namespace freeplay
