// A joint with play in space: what its kinds share.
#pragma once

#include <cmath>

#include "contact_phase.h"
#include "relative_motion.h"

namespace freeplay::play {

using space::Dual;
using space::Vec;

/// Radii, laws and start. Throws BadParameter. A friction law with internal variables is refused: its bristles have no
/// direction in the tangential plane.
struct SpatialPlay {
  /// `length`: of the bearing [m], NaN without one.
  SpatialPlay(const Parameters& p, double length) : radii(read_radii(p)), start(p) {
    ContactPair pair{radii.bearing, radii.journal, radii.clearance, length, {}, {}};
    read_materials(p, pair);
    contact = p.contact_law("clearance.contact", pair);
    friction = p.friction_law("clearance.friction");
    if (friction.internal_variables() > 0)
      throw BadParameter("clearance.friction", "type-space",
                         "a friction law with internal variables works in planar models only");
    require_radii(radii, friction);
    slides = radii.known() && !is_inert(friction);
  }
  double radius_a() const { return radii.known() ? radii.bearing : 0.0; }
  double radius_b() const { return radii.known() ? radii.journal : 0.0; }

  /// Friction on b for the normal force and the slip velocity of b on a, both in the tangential plane:
  ///
  ///   F_T v/|v|, F_T the law's force at the speed |v|; near v = 0 its limit, the slope of the law times v
  template <class T>
  Vec<T> friction_force(const T& normal, const Vec<T>& slip) const {
    const T squared = dot(slip, slip);
    if (space::value_of(squared) < 1e-24)
      return T(friction.evaluate({space::value_of(normal), 0.0, {}}, {}).d_slip) * slip;
    using std::sqrt;
    const T speed = sqrt(squared);
    const FrictionForce f = friction.evaluate({space::value_of(normal), space::value_of(speed), {}}, {});
    return (space::chained(f.tangential, f.d_normal, normal, f.d_slip, speed) / speed) * slip;
  }

  Radii radii;
  Start start;
  ContactLawRef contact;
  FrictionLawRef friction;
  bool slides = false;  ///< is there friction?
};

/// |e| - c without the loss of digits of a difference of nearly equal numbers.
template <class T>
T depth(const T& squared, const T& distance, double clearance) {
  return (squared - T(clearance * clearance)) / (distance + T(clearance));
}

/// The part of v across the unit vector n.
template <class T>
Vec<T> across(const Vec<T>& v, const Vec<T>& n) {
  return v - dot(v, n) * n;
}

/// v_0 of a contact that begins within dt, from delta'' and the vectors of which delta is made: x' and x''. 0: none
/// does.
inline double foreseen_speed(const Approach& gap, double second, const Eigen::Vector3d& rate,
                             const Eigen::Vector3d& rate_of_rate, double dt) {
  if (gap.penetration >= 0.0) return gap.rate > 0.0 ? std::max(gap.rate, smallest_approach_speed) : 0.0;
  const double s = time_to_contact(gap, second);
  if (!(s <= dt)) return 0.0;
  // Near the centre the parabola is poor; the speed of approach never exceeds the speed.
  const double speed = (rate + s * rate_of_rate).norm();
  return std::max(std::min(gap.rate + second * s, speed), smallest_approach_speed);
}

/// Input and history of one of the contacts of a joint.
inline JointInput contact_input(const JointInput& in, std::size_t index) {
  JointInput one = in;
  one.history = in.history.part(index * slots, slots);
  return one;
}

}  // namespace freeplay::play
