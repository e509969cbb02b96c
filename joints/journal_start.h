// Where a journal in space starts in its bearing.
#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "revolute_play_ends.h"

namespace freeplay::play {

/// A journal in the axes of its bearing: its origin [m], and the slopes dx/dz and dy/dz of its axis.
struct JournalStand {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();

  /// Rotation vector that tilts the axis so.
  Eigen::Vector3d tilt() const {
    const double steep = slope.norm(), factor = steep > 0.0 ? std::atan(steep) / steep : 1.0;
    return factor * Eigen::Vector3d(-slope.y(), slope.x(), 0.0);
  }
};

/// The journal at rest under the force and the moment about its origin that its bearing exerts on it, both in the axes
/// of the bearing. With F across the axis, M the moment across it, L the length of the bearing, h the height of the
/// origin in it and N at the upper and the lower end,
///
///   N_upper + N_lower = F      z x ((L/2 - h) N_upper - (L/2 + h) N_lower) = M
///
/// where each end stands off against its N by the clearance and the depth that carries it. A shoulder carries what is
/// left along the axis, as the ends push across the tilted journal: it has moved the origin by h, which a few rounds
/// settle. Without shoulders h is `height`. Left out: squares of the tilt.
inline JournalStand resting_journal(const SpatialPlay& play, const Bearing& bearing, bool has_shoulders, double height,
                                    const Eigen::Vector3d& force, const Eigen::Vector3d& moment) {
  constexpr double least_load = 1e-12, least_share = 1e-9;
  constexpr int rounds = 4;
  const double clearance = play.radii.clearance, length = 2.0 * bearing.half_length;
  const Eigen::Vector2d across = force.head<2>(), couple(moment.y(), -moment.x());
  const auto stand_off = [&](const Eigen::Vector2d& load, double most) -> Eigen::Vector2d {
    const double size = load.norm();
    if (size < least_load || size < least_share * most) return Eigen::Vector2d::Zero();
    return -(clearance + resting_penetration(play.normal, clearance, size / share(upper_end))) / size * load;
  };
  JournalStand stand;
  for (int i = 0; i < rounds; ++i) {
    const double axial = force.z() + across.dot(stand.slope);
    if (has_shoulders)
      height = std::abs(axial) < least_load
                   ? 0.0
                   : -std::copysign(
                         bearing.axial_clearance + resting_penetration(play.normal, clearance, std::abs(axial)), axial);
    const Eigen::Vector2d apart = (couple + height * across) / length, upper = 0.5 * across + apart,
                          lower = 0.5 * across - apart;
    const double most = upper.norm() + lower.norm();
    const Eigen::Vector2d e_upper = stand_off(upper, most), e_lower = stand_off(lower, most);
    stand.slope = (e_upper - e_lower) / length;
    stand.place.head<2>() = 0.5 * (e_upper + e_lower) + height * stand.slope;
  }
  if (has_shoulders) stand.place.z() = height;
  return stand;
}

/// Throws where an end of a journal at `place`, its axis turned by the rotation vector `tilt`, stands in the bearing;
/// both in the axes of the bearing. At the wall it does not, but for rounding.
inline void require_free_ends(const SpatialPlay& play, const Bearing& bearing, const Eigen::Vector3d& place,
                              const Eigen::Vector3d& tilt) {
  const double angle = tilt.norm();
  const Eigen::Vector3d turn = angle > 0.0 ? Eigen::Vector3d(tilt / angle) : Eigen::Vector3d::UnitX(),
                        axis = Eigen::AngleAxisd(angle, turn) * Eigen::Vector3d::UnitZ();
  RelativeMotion<double> motion{};
  motion.d = {place.x(), place.y(), place.z()};
  motion.r = {axis.x(), axis.y(), axis.z()};
  for (const std::size_t end : {upper_end, lower_end})
    if (!(axis.z() > 0.5) || bearing.approach(motion, end, play).penetration > 1e-9 * play.radii.clearance)
      throw std::runtime_error(
          "an end of the journal would start in the bearing: eccentricity and half the length times the tilt must stay "
          "within the clearance together");
}

/// InitialOffset of a journal whose block starts it `loaded`, the ends then carrying force and moment across the axis
/// and a shoulder the force along it, or with a shift and a tilt in the axes of the world.
inline void write_journal_start(const SpatialPlay& play, const Bearing& bearing, const TiltStart& start,
                                bool has_shoulders, Span<const double> reaction, InitialOffset& out) {
  clear_start(out);
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  if (out.rotation != nullptr) axes = Eigen::Map<const RowMajor3>(out.rotation);
  const Eigen::Vector3d along = axes.col(2);
  Eigen::Map<Eigen::Vector3d> position(out.position), tilt(out.tilt), tilt_rate(out.tilt_rate);
  double height = 0.0;  // of a shaft, which may be anywhere along
  if (!has_shoulders && out.a != nullptr) height = along.dot(space::position(*out.b) - space::position(*out.a));
  if (play.start.loaded) {
    const auto load = [&](std::size_t first) -> Eigen::Vector3d {
      if (first + 3 > reaction.size) return Eigen::Vector3d::Zero();
      return axes.transpose() * Eigen::Map<const Eigen::Vector3d>(reaction.data + first);
    };
    const JournalStand stand = resting_journal(play, bearing, has_shoulders, height, load(0), load(3));
    position = axes * stand.place;
    tilt = axes * stand.tilt();
    return;
  }
  std::copy_n(play.start.offset.position, 3, out.position);
  std::copy_n(play.start.offset.velocity, 3, out.velocity);
  tilt = Eigen::Map<const Eigen::Vector3d>(start.tilt.data());
  tilt_rate = Eigen::Map<const Eigen::Vector3d>(start.tilt_rate.data());
  if (out.rotation == nullptr) return;
  if (has_shoulders && std::abs(along.dot(position)) > bearing.axial_clearance + 1e-9 * play.radii.clearance)
    throw std::runtime_error(
        "a shoulder of the journal would start in the bearing: the part of the eccentricity along the axis must stay "
        "within 'axial_clearance'");
  tilt -= along.dot(tilt) * along;
  tilt_rate -= along.dot(tilt_rate) * along;
  if (start.tilts())
    require_free_ends(play, bearing, axes.transpose() * position + height * Eigen::Vector3d::UnitZ(),
                      axes.transpose() * tilt);
}

/// How far a journal may go by Joint::free_distance and `lever`, with nothing nearer to it than `free`: a way of its
/// axis moves the place where that passes an end plane by a little more where the axis leans.
inline double free_way(const RelativeMotion<double>& motion, double free, double lever) {
  const double turn = free / lever, along = motion.r.z - turn;
  if (!(along > 0.5)) return 0.0;
  return free * along / (1.0 + (std::hypot(motion.r.x, motion.r.y) + turn) / along);
}

}  // namespace freeplay::play
