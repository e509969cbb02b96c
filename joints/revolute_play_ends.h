// The four places where a journal touches a bearing of finite length: both ends and both shoulders.
#pragma once

#include "spatial_play.h"

namespace freeplay::play {

using space::RelativeForce;
using space::RelativeMotion;

/// In this order the joint keeps its contacts. The upper ones are those on the side of +z of marker a.
enum Place : std::size_t { upper_end, lower_end, upper_shoulder, lower_shoulder, places };

/// Begin and end of each.
inline constexpr Event end_events[] = {{"upper_contact_begin", Crossing::rising, 1, event_fields},
                                       {"upper_contact_end", Crossing::falling, 1, event_fields},
                                       {"lower_contact_begin", Crossing::rising, 1, event_fields},
                                       {"lower_contact_end", Crossing::falling, 1, event_fields},
                                       {"upper_shoulder_contact_begin", Crossing::rising, 1, event_fields},
                                       {"upper_shoulder_contact_end", Crossing::falling, 1, event_fields},
                                       {"lower_shoulder_contact_begin", Crossing::rising, 1, event_fields},
                                       {"lower_shoulder_contact_end", Crossing::falling, 1, event_fields}};
inline constexpr EventRole end_event_roles[] = {
    EventRole::contact_begin, EventRole::contact_end, EventRole::contact_begin, EventRole::contact_end,
    EventRole::contact_begin, EventRole::contact_end, EventRole::contact_begin, EventRole::contact_end};

/// A pin is kept by its shoulders and has an angle; a shaft in its sleeve goes along and has no single coordinate.
enum class Kept : bool { by_shoulders, not_along };

/// Of a shaft `ex ey ez` are no place of its origin.
inline constexpr ChannelRole along_roles[] = {
    ChannelRole::none,        ChannelRole::none,         ChannelRole::none,
    ChannelRole::penetration, ChannelRole::normal_force, ChannelRole::friction_force,
    ChannelRole::none,        ChannelRole::in_contact,   ChannelRole::slip_speed};

constexpr bool is_end(std::size_t place) { return place <= lower_end; }
constexpr double side(std::size_t place) { return place == upper_end || place == upper_shoulder ? 1.0 : -1.0; }
/// Each end carries half of the law's force, so that both together are the joint of a planar model.
constexpr double share(std::size_t place) { return is_end(place) ? 0.5 : 1.0; }

/// Where the axis of the journal passes an end plane of the bearing; axes of marker a, z = z_a. With r = z_b, L the
/// length of the bearing and s = +1 or -1:
///
///   q = (s L/2 - d_z)/r_z r        from P_b to the axis in the end plane
///   e = d + q - s L/2 z            eccentricity, in the plane       n = e/|e|     delta = |e| - c
///   m = n - (n.r)/r_z z            across the journal's axis: the derivative of delta by a shift of the journal
///   h = u + w_b x q - w_a x s L/2 z,   g = h - w_a x e,   delta' = m.g,   e' = g - g_z/r_z r
///   v_T = h + (R_J w_b - R_B w_a) x n, without its part along n
///
/// u = v_b - v_a. Tilts are taken to be small where the round sections of the journal stay round in the end planes.
template <class T>
struct EndGap {
  EndGap(const RelativeMotion<T>& x, double end_side, double half_length, const SpatialPlay& play) {
    using std::sqrt;
    const double height = end_side * half_length;
    // A journal that lies across its bearing is none; numbers stay finite.
    const T along = space::value_of(x.r.z) > 1e-3 ? x.r.z : T(1e-3);
    q = ((T(height) - x.d.z) / along) * x.r;
    e = {x.d.x + q.x, x.d.y + q.y, T(0.0)};
    const T squared = dot(e, e), distance = sqrt(squared);
    penetration = depth(squared, distance, play.radii.clearance);
    if (space::value_of(distance) >= 1e-12 * play.radii.clearance) n = (T(1.0) / distance) * e;
    m = {n.x, n.y, -(dot(n, x.r) / along)};
    h = x.u + cross(x.w_b, q) - cross(x.w_a, Vec<T>{T(0.0), T(0.0), T(height)});
    g = h - cross(x.w_a, e);
    rate = dot(m, g);
    slip = across(h + cross(T(play.radius_b()) * x.w_b - T(play.radius_a()) * x.w_a, n), n);
  }
  /// n' in the axes of a, for the motion that made this; zero at the centre.
  Vec<T> n_rate(const RelativeMotion<T>& x) const {
    using std::sqrt;
    const T distance = sqrt(dot(e, e));
    if (!(space::value_of(distance) > 0.0)) return {};
    return (T(1.0) / distance) * across(g - (g.z / x.r.z) * x.r, n);
  }
  Vec<T> q, e, n{T(1.0), T(0.0), T(0.0)}, m, h, g, slip;
  T penetration, rate;
};

/// A shoulder of the journal at an end face of the bearing, with axial play a: delta = s d_z - a.
template <class T>
struct ShoulderGap {
  ShoulderGap(const RelativeMotion<T>& x, double face_side, double axial_clearance)
      : penetration(T(face_side) * x.d.z - T(axial_clearance)), rate(T(face_side) * (x.u - cross(x.w_a, x.d)).z) {}
  T penetration, rate;
};

/// Geometry of the bearing and all four gaps.
struct Bearing {
  double half_length, axial_clearance;

  template <class T>
  EndGap<T> end(const RelativeMotion<T>& x, std::size_t place, const SpatialPlay& play) const {
    return {x, side(place), half_length, play};
  }
  /// From the journal's origin along its axis to the farther end plane [m].
  double lever(const RelativeMotion<double>& x) const {
    return (half_length + std::abs(x.d.z)) / std::max(x.r.z, 1e-3);
  }
  template <class T>
  ShoulderGap<T> shoulder(const RelativeMotion<T>& x, std::size_t place) const {
    return {x, side(place), axial_clearance};
  }
  Approach approach(const RelativeMotion<double>& x, std::size_t place, const SpatialPlay& play) const {
    if (is_end(place)) {
      const EndGap<double> gap = end(x, place, play);
      return {gap.penetration, gap.rate};
    }
    const ShoulderGap<double> gap = shoulder(x, place);
    return {gap.penetration, gap.rate};
  }
};

}  // namespace freeplay::play
