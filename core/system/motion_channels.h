// MotionChannels: the values of channels of the motion at a point, how they change with it, and with which bodies.
#pragma once

#include <span>

#include "system/joints.h"

namespace freeplay {

/// A channel in the columns of one body: how it changes with the body's increments and velocities, body_velocities()
/// numbers each.
struct ChannelRows {
  BodyId place = ground;  ///< Layout::place; `ground`: nothing to change
  double by_q[spatial::velocities] = {}, by_v[spatial::velocities] = {};
};

class MotionChannels {
 public:
  MotionChannels(const Model& model, const Layout& layout, const Markers& markers, const Joints& joints)
      : model_(model), layout_(layout), markers_(markers), joints_(joints) {}

  /// Where markers and the coordinates of the joints that are asked for are.
  double value(const MotionChannel& channel, const Evaluation& e) const;
  /// Whether it is an angle or an angular velocity.
  bool turns(const MotionChannel& channel) const;
  /// Its time derivative, for the accelerations `a` of the unknowns.
  double rate(const MotionChannel& channel, std::span<const double> a, const Evaluation& e) const;
  /// The one or two bodies that it depends on. The speed of a coordinate along an axis that turns changes with the
  /// turn, too, which is left out: nothing but Newton's iteration asks.
  int bodies(const MotionChannel& channel, BodyId (&places)[2]) const;
  void rows(const MotionChannel& channel, const Evaluation& e, ChannelRows (&rows)[2]) const;

  /// Linear and angular acceleration of a marker, or of a body at its centre of mass, world axes, 6 numbers.
  void acceleration(int marker, std::span<const double> a, const Evaluation& e, double* out) const;
  void body_acceleration(int body, std::span<const double> a, const Evaluation& e, double* out) const;

 private:
  const Model& model_;
  const Layout& layout_;
  const Markers& markers_;
  const Joints& joints_;
};

}  // namespace freeplay
