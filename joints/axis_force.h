// A force along or about the axis of a joint: friction in it, stops at its ends.
#pragma once

#include "freeplay/plugin.h"
#include "relative_motion.h"

namespace freeplay {
/// A limit, friction, stiffness or damping above this is not negative: one that fades out by a formula ends at
/// rounding.
constexpr double below_zero = -1e-9;
}  // namespace freeplay

namespace freeplay::space {

/// Where and how fast marker b moves in the axes of a: along x_a [m], or about z_a [rad, counted over turns] with u the
/// direction in which a torque works on that angle (`AngleAboutZ`).
template <class T>
struct AxisMotion {
  T value, rate;
  Vec<T> u;
};

inline double counted_angle(const Vec<double>&, double angle) { return angle; }
inline Dual counted_angle(const Vec<Dual>& r, double angle) { return {angle, atan2(r.y, r.x).gradient}; }

/// `x.r` is the x axis of b; the host counts the turns of `angle`, the derivatives are those of the angle without them.
template <class T>
AxisMotion<T> turn_about_z(const RelativeMotion<T>& x, double angle) {
  const T squared = x.r.x * x.r.x + x.r.y * x.r.y, share = x.r.z / squared;
  const Vec<T> u{-(share * x.r.x), -(share * x.r.y), T(1.0)};
  return {counted_angle(x.r, angle), dot(u, x.w_b - x.w_a), u};
}

template <class T>
AxisMotion<T> slide_along_x(const RelativeMotion<T>& x) {
  const Vec<T> u{T(1.0), T(0.0), T(0.0)};
  return {x.d.x, dot(u, x.u - cross(x.w_a, x.d)), u};
}

/// The same place as the coordinate of a joint: along x_a, or about z_a.
inline void write_axis_coordinate(const JointInput& in, bool slides, CoordinateRow& row) {
  if (slides) {
    Separation(in).write_coordinate(axis(*in.a, 0), row);
  } else {
    AngleAboutZ(in).write(row);
  }
}

/// The first parameter of a force along an axis: does it slide or turn?
inline constexpr Parameter axis_kind_parameter{.name = "kind",
                                               .kind = ParameterKind::choice,
                                               .default_value = 0,
                                               .choices = "linear|rotational",
                                               .summary =
                                                   "Acts along the x axis of the first frame, or about its z "
                                                   "axis."};

/// The effort E of a Law of the coordinate s and its rate, in the plane and in space: force -E on b along x_a at P_b,
/// or torque -E u on b; the opposite on a. Work is -E s' exactly. A Law is made from the parameters and has
///   effort(s, s')     for numbers and for duals; or effort(in, s, s') of a Law whose parameters may follow the motion
///   stored(s)         potential energy [J]
///   stored_rate(s, s')
///   doubt(s, slides), or doubt(in)  a sentence where s is far outside of what the law is for, else null; optional
///   lowest(), highest()  ends of the way of s, of a Law that has them
template <class Law>
class AxisForce final : public Joint {
 public:
  explicit AxisForce(const Parameters& parameters) : slides_(parameters.word("kind") == 0), law_(parameters) {}

  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;
    layout.forces = 1;
    layout.analytic_derivatives = 1;
    layout.coordinate = slides_ ? Coordinate::position : Coordinate::angle;
    if constexpr (requires { law_.lowest(); }) {
      layout.lowest = law_.lowest();
      layout.highest = law_.highest();
    }
  }
  void coordinate(const JointInput& in, CoordinateRow& row) const override { write_axis_coordinate(in, slides_, row); }
  void apply(const JointInput& in, JointForces& out) const override {
    const PairInFirstAxes pair =
        slides_ ? PairInFirstAxes(in, Vector3d::Zero(), Eigen::Matrix3d::Zero()) : PairInFirstAxes::with_axis(in, 0);
    const RelativeMotion<double> x = pair.numbers();
    const AxisMotion<double> now = motion(x, in.coordinate);
    out.potential = law_.stored(now.value);
    out.potential_rate = law_.stored_rate(now.value, now.rate);
    pair.write(force(in, x, now), out);
    if (out.derivatives.empty()) return;
    const RelativeMotion<Dual> slopes = pair.duals();
    pair.write_derivatives(force(in, slopes, motion(slopes, in.coordinate)), 24, out);
  }
  const char* warning(const JointInput& in) const override {
    if constexpr (requires { law_.doubt(0.0, false); }) return law_.doubt(in.coordinate, slides_);
    if constexpr (requires { law_.doubt(in); }) return law_.doubt(in);
    return nullptr;
  }

 private:
  template <class T>
  AxisMotion<T> motion(const RelativeMotion<T>& x, double coordinate) const {
    return slides_ ? slide_along_x(x) : turn_about_z(x, coordinate);
  }
  template <class T>
  T effort(const JointInput& in, const AxisMotion<T>& now) const {
    if constexpr (requires { law_.effort(in, now.value, now.rate); }) return law_.effort(in, now.value, now.rate);
    if constexpr (requires { law_.effort(now.value, now.rate); }) return law_.effort(now.value, now.rate);
  }
  template <class T>
  RelativeForce<T> force(const JointInput& in, const RelativeMotion<T>& x, const AxisMotion<T>& now) const {
    const Vec<T> pull = -(effort(in, now) * now.u);
    if (slides_) return {pull, -cross(x.d, pull), {}};
    return {{}, -pull, pull};
  }

  bool slides_;
  Law law_;
};

}  // namespace freeplay::space
