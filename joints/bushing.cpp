#include <cmath>

#include "freeplay/plugin.h"
#include "relative_motion.h"

namespace freeplay {
namespace {

using space::Dual;
using space::PairInFirstAxes;
using space::RelativeForce;
using space::RelativeMotion;
using space::Vec;

/// Elastic bed of one frame in another: three springs and dampers along the axes of marker a and three about them, with
/// diagonal matrices K, C (translation) and K_r, C_r (rotation). All in the axes of a, w = w_b - w_a:
///
///   d = P_b - P_a,  d' = v_b - v_a - w_a x d        force on b at P_b: F = -(K d + C d')
///   rho: rotation vector of b in a,  rho' = L w     moment on b:       M = -L^T (K_r rho + C_r rho')
///
/// (`rotation_vector.h` has L, the identity for small turns.) M is the moment whose work is that of K_r rho + C_r rho'
/// on rho: stored d.K d/2 + rho.K_r rho/2 and dissipated d'.C d' + rho'.C_r rho' are exact for any turn below half a
/// one, where rho jumps. Of a turn about one axis, or with equal rotational stiffnesses, M = -K_r rho. The opposite
/// wrench acts on a at P_b.
class Bushing : public Joint {
 public:
  explicit Bushing(const Parameters& p)
      : stiffness_{p.number("stiffness.x"), p.number("stiffness.y"), p.number("stiffness.z")},
        damping_{p.number("damping.x"), p.number("damping.y"), p.number("damping.z")},
        turn_stiffness_{p.number("stiffness.turn_x"), p.number("stiffness.turn_y"), p.number("stiffness.turn_z")},
        turn_damping_{p.number("damping.turn_x"), p.number("damping.turn_y"), p.number("damping.turn_z")} {}

  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;
    layout.forces = 1;
    layout.analytic_derivatives = 1;
  }
  void apply(const JointInput& in, JointForces& out) const override {
    const PairInFirstAxes pair = PairInFirstAxes::with_rotation_vector(in);
    const RelativeMotion<double> x = pair.numbers();
    pair.write(force(x), out);
    const Vec<double> pull = scaled(stiffness_, x.d), twist = scaled(turn_stiffness_, x.r);
    out.potential = 0.5 * (dot(x.d, pull) + dot(x.r, twist));
    out.potential_rate = dot(pull, x.u - cross(x.w_a, x.d)) + dot(twist, rate_of(x.r, x.w_b - x.w_a, 1.0));
    if (!out.derivatives.empty()) pair.write_derivatives(force(pair.duals()), 24, out);
  }

 private:
  template <class T>
  static Vec<T> scaled(const Vec<double>& k, const Vec<T>& x) {
    return {k.x * x.x, k.y * x.y, k.z * x.z};
  }
  static double kappa(const Vec<double>& r) { return space::Kappa(std::sqrt(dot(r, r))).value; }
  static Dual kappa(const Vec<Dual>& r) {
    const space::Kappa k(std::sqrt(dot(r, r).value));
    return {k.value, 0.5 * k.slope * dot(r, r).gradient};
  }
  /// L x for `side` 1, L^T x for `side` -1: x - side rho x x/2 + kappa rho x (rho x x).
  template <class T>
  static Vec<T> rate_of(const Vec<T>& r, const Vec<T>& x, double side) {
    const Vec<T> once = cross(r, x);
    return x - T(0.5 * side) * once + kappa(r) * cross(r, once);
  }

  template <class T>
  RelativeForce<T> force(const RelativeMotion<T>& x) const {
    const Vec<T> rate = x.u - cross(x.w_a, x.d), turn_rate = rate_of(x.r, x.w_b - x.w_a, 1.0);
    const Vec<T> twist = scaled(turn_stiffness_, x.r) + scaled(turn_damping_, turn_rate);
    const Vec<T> force = -(scaled(stiffness_, x.d) + scaled(damping_, rate)), moment = -rate_of(x.r, twist, -1.0);
    return {force, -(moment + cross(x.d, force)), moment};
  }

  Vec<double> stiffness_, damping_, turn_stiffness_, turn_damping_;
};

/// In the plane the same, with what acts out of it left out.
class PlanarBushing final : public Bushing {
 public:
  explicit PlanarBushing(const Parameters& p) : Bushing(p) {
    for (const char* out_of_plane :
         {"stiffness.z", "stiffness.turn_x", "stiffness.turn_y", "damping.z", "damping.turn_x", "damping.turn_y"}) {
      if (p.given(out_of_plane))
        throw BadParameter(out_of_plane, "out-of-range", "a bushing in the plane acts along x and y and about z alone");
    }
  }
};

constexpr Parameter row(const char* name, const char* unit, const char* summary) {
  return {.name = name, .unit = unit, .default_value = 0.0, .minimum = 0.0, .summary = summary};
}
constexpr Parameter bushing_parameters[] = {row("stiffness.x", "N/m", "Stiffness along the x axis of the first frame."),
                                            row("stiffness.y", "N/m", "Stiffness along its y axis."),
                                            row("stiffness.z", "N/m", "Stiffness along its z axis."),
                                            row("stiffness.turn_x", "N*m/rad", "Stiffness of a turn about its x axis."),
                                            row("stiffness.turn_y", "N*m/rad", "Stiffness of a turn about its y axis."),
                                            row("stiffness.turn_z", "N*m/rad", "Stiffness of a turn about its z axis."),
                                            row("damping.x", "N*s/m", "Damping along the x axis of the first frame."),
                                            row("damping.y", "N*s/m", "Damping along its y axis."),
                                            row("damping.z", "N*s/m", "Damping along its z axis."),
                                            row("damping.turn_x", "N*m*s/rad", "Damping of a turn about its x axis."),
                                            row("damping.turn_y", "N*m*s/rad", "Damping of a turn about its y axis."),
                                            row("damping.turn_z", "N*m*s/rad", "Damping of a turn about its z axis.")};

}  // namespace

Component bushing() {
  return joint<PlanarBushing>(
      {.name = "bushing",
       .space = Space::both,
       .summary = "Force element: an elastic bed, springs and dampers along and about the axes of the first frame.",
       .formula = "in the axes of the first frame: force on the second body -(K d + C d') with d = P_b - P_a; moment "
                  "-L^T (K_r rho + C_r rho') with rho the rotation vector of the second frame in the first, rho' = L "
                  "(w_b - w_a); work and stored energy agree exactly.",
       .validity = "Turns below half a revolution.",
       .parameters = bushing_parameters,
       .in_space = joint_face<Bushing>()});
}

}  // namespace freeplay
