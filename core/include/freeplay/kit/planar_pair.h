// The motion of marker b in the axes of marker a in the plane, contacts between both, and the way of a force back.
#pragma once

#include "freeplay/kit/contact_phase.h"
#include "freeplay/kit/dual.h"
#include "freeplay/kit/planar_marker.h"

namespace freeplay::play {

template <class T>
struct Vec2 {
  T x{}, y{};
  friend Vec2 operator+(const Vec2& a, const Vec2& b) { return {a.x + b.x, a.y + b.y}; }
  friend Vec2 operator-(const Vec2& a, const Vec2& b) { return {a.x - b.x, a.y - b.y}; }
  friend Vec2 operator*(const T& k, const Vec2& a) { return {k * a.x, k * a.y}; }
  friend T dot(const Vec2& a, const Vec2& b) { return a.x * b.x + a.y * b.y; }
  friend T cross(const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; }
  /// Turned by +90 degrees.
  friend Vec2 turned(const Vec2& a) { return {-a.y, a.x}; }
};

/// How b stands and moves against a, in the axes of a. Geometry is written for numbers and for duals at once.
template <class T>
struct PlanarMotion {
  Vec2<T> d;   ///< P_b - P_a [m]
  T c, s;      ///< cosine and sine of the angle of b against a
  Vec2<T> u;   ///< v_b - v_a [m/s]
  T w_a, w_b;  ///< [rad/s]
};

/// Where one contact stands, in the axes of a. Both forces act at one point, so that the pair has neither a resultant
/// nor a moment.
template <class T>
struct ContactPlace {
  T penetration;       ///< delta, written so that it keeps its digits near zero [m]
  Vec2<T> normal;      ///< unit, along which b pushes a
  Vec2<T> arm;         ///< from P_b to the point of both forces [m]
  double along = 1.0;  ///< slip counts along the normal turned by +90 degrees, or against it: -1
};

/// The kinematics that follow: velocity of b less that of a, both at the point of the forces.
template <class T>
struct PlanarContact : ContactPlace<T> {
  PlanarContact() = default;
  PlanarContact(const ContactPlace<T>& place, const PlanarMotion<T>& m)
      : ContactPlace<T>(place),
        from_a(m.d + place.arm),
        tangent(T(place.along) * turned(place.normal)),
        velocity(m.u + m.w_b * turned(place.arm) - m.w_a * turned(from_a)),
        rate(dot(place.normal, velocity)),
        slip(dot(tangent, velocity)) {}
  Vec2<T> from_a, tangent, velocity;
  T rate, slip;
  Approach approach() const { return {space::value_of(this->penetration), space::value_of(rate)}; }
};

/// The 7 numbers of a relative motion in the plane, and the way of a force found there back to both markers.
class PlanarPair {
 public:
  using Dual = space::DualBy<7>;
  /// Force on b, its opposite on a, and the moments on both about their origins, in the axes of a.
  template <class T>
  struct Force {
    Vec2<T> force;
    T moment_a{}, moment_b{};
    void add(const Vec2<T>& f, const PlanarContact<T>& at) {
      force = force + f;
      moment_a = moment_a - cross(at.from_a, f);
      moment_b = moment_b + cross(at.arm, f);
    }
  };

  explicit PlanarPair(const JointInput& in) {
    const Eigen::Vector2d h = planar::x_axis(*in.a), n = planar::turned(h), x_b = planar::x_axis(*in.b);
    const Eigen::Vector2d d = planar::position(*in.b) - planar::position(*in.a);
    const Eigen::Vector2d u = planar::velocity(*in.b) - planar::velocity(*in.a);
    to_a_ << h.transpose(), n.transpose();
    motion_ = {
        {h.dot(d), n.dot(d)},           h.dot(x_b), n.dot(x_b), {h.dot(u), n.dot(u)}, planar::angular_velocity(*in.a),
        planar::angular_velocity(*in.b)};
  }
  const PlanarMotion<double>& numbers() const { return motion_; }
  PlanarMotion<Dual> duals() const {
    const PlanarMotion<double>& m = motion_;
    const auto unit = [](double x, int i) { return Dual(x, Dual::Gradient::Unit(i)); };
    return {{unit(m.d.x, 0), unit(m.d.y, 1)},
            Dual(m.c, -m.s * Dual::Gradient::Unit(2)),
            Dual(m.s, m.c * Dual::Gradient::Unit(2)),
            {unit(m.u.x, 3), unit(m.u.y, 4)},
            unit(m.w_a, 5),
            unit(m.w_b, 6)};
  }
  /// Rates of the 7 numbers for given accelerations of the markers.
  Dual::Gradient rates(const MarkerAccelerations& acc) const {
    const PlanarMotion<double>& m = motion_;
    const Eigen::Vector2d second = to_a_ * Eigen::Vector2d(acc.b[0] - acc.a[0], acc.b[1] - acc.a[1]);
    Dual::Gradient rates;
    rates << m.u.x + m.w_a * m.d.y, m.u.y - m.w_a * m.d.x, m.w_b - m.w_a, second.x() + m.w_a * m.u.y,
        second.y() - m.w_a * m.u.x, acc.a[5], acc.b[5];
    return rates;
  }
  /// A vector given in the axes of a, in world axes.
  Eigen::Vector2d in_world(const Vec2<double>& v) const { return to_a_.transpose() * Eigen::Vector2d(v.x, v.y); }

  void write(const Force<double>& f, JointForces& out) const {
    const Eigen::Vector2d force = in_world(f.force);
    for (int i = 0; i < 2; ++i) {
      out.wrench_a[i] = -force[i];
      out.wrench_b[i] = force[i];
    }
    out.wrench_a[5] = f.moment_a;
    out.wrench_b[5] = f.moment_b;
  }
  /// All derivatives of the wrenches by the markers; `columns` is the length of a row.
  void write_derivatives(const Force<Dual>& f, std::size_t columns, JointForces& out) const {
    const Inputs inputs = inputs_by_markers();
    Eigen::Matrix<double, 2, 24> force;
    force << f.force.x.gradient.transpose() * inputs, f.force.y.gradient.transpose() * inputs;
    force = to_a_.transpose() * force;
    // A turn of a carries its axes along.
    force.col(planar::turn_a) += planar::turned(in_world({f.force.x.value, f.force.y.value}));
    const auto row = [&](std::size_t i) { return Eigen::Map<Row>(out.derivatives.data + i * columns); };
    for (std::size_t i = 0; i < 2; ++i) {
      row(i) = -force.row(static_cast<int>(i));
      row(6 + i) = force.row(static_cast<int>(i));
    }
    row(5) = f.moment_a.gradient.transpose() * inputs;
    row(11) = f.moment_b.gradient.transpose() * inputs;
  }
  /// Row `index` of z' by the markers.
  void write_rate(std::size_t index, const Dual::Gradient& rate, std::size_t columns, JointForces& out) const {
    Eigen::Map<Row>(out.derivatives.data + (12 + index) * columns) = rate.transpose() * inputs_by_markers();
  }
  /// Column of internal variable `index`: derivatives of the wrenches by it.
  void write_column(std::size_t index, const Force<double>& f, std::size_t columns, JointForces& out) const {
    JointForces part{};
    write(f, part);
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}, std::size_t{5}}) {
      out.derivatives[i * columns + 24 + index] = part.wrench_a[i];
      out.derivatives[(6 + i) * columns + 24 + index] = part.wrench_b[i];
    }
  }

 private:
  using Row = Eigen::Matrix<double, 1, 24>;
  using Inputs = Eigen::Matrix<double, 7, 24>;

  /// Derivatives of the 7 numbers by [pose a, pose b, twist a, twist b].
  Inputs inputs_by_markers() const {
    constexpr int twist = 12;
    Inputs t = Inputs::Zero();
    t.block<2, 2>(0, planar::velocity_a) = -to_a_;
    t.block<2, 2>(0, planar::velocity_b) = to_a_;
    t(0, planar::turn_a) = motion_.d.y;
    t(1, planar::turn_a) = -motion_.d.x;
    t(2, planar::turn_a) = -1.0;
    t(2, planar::turn_b) = 1.0;
    t.block<2, 2>(3, twist + planar::velocity_a) = -to_a_;
    t.block<2, 2>(3, twist + planar::velocity_b) = to_a_;
    t(3, planar::turn_a) = motion_.u.y;
    t(4, planar::turn_a) = -motion_.u.x;
    t(5, twist + planar::turn_a) = t(6, twist + planar::turn_b) = 1.0;
    return t;
  }

  Eigen::Matrix2d to_a_;
  PlanarMotion<double> motion_;
};

}  // namespace freeplay::play
