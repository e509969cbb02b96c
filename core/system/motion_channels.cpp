#include "system/motion_channels.h"

#include <algorithm>

#include "base/index.h"
#include "system/evaluation.h"
#include "system/spatial_kinematics.h"

namespace freeplay {
namespace {

using Of = MotionChannel::Of;

/// Of a marker whose arm is known. x, y or angle.
void marker_rows(const MotionChannel& channel, const planar::Arm& arm, ChannelRows& rows) {
  const bool turns = channel.of == Of::angle || channel.of == Of::angular_velocity;
  const bool moves = channel.of == Of::velocity || channel.of == Of::angular_velocity;
  double* const row = moves ? rows.by_v : rows.by_q;
  if (turns) {
    row[2] = 1.0;
    return;
  }
  row[channel.component] = 1.0;
  row[2] = channel.component == 0 ? -arm.y : arm.x;
  if (moves) rows.by_q[2] = -(channel.component == 0 ? arm.x : arm.y) * arm.w;
}

void marker_rows(const MotionChannel& channel, const spatial::Arm& arm, ChannelRows& rows) {
  const int component = channel.component + (channel.of == Of::angular_velocity ? 3 : 0);
  for (int c = 0; c < spatial::velocities; ++c) {
    double pose[6], twist[6], speed[6];
    spatial::by_increment(c, arm, pose, twist);
    spatial::by_velocity(c, arm, speed);
    rows.by_q[c] = channel.of == Of::position ? pose[component] : twist[component];
    rows.by_v[c] = channel.of == Of::position ? 0.0 : speed[component];
  }
}

}  // namespace

double MotionChannels::value(const MotionChannel& channel, const Evaluation& e) const {
  const std::size_t element = at(channel.element);
  switch (channel.of) {
    case Of::position:
      return e.markers[element].position[channel.component];
    case Of::angle:
      return markers_.angle(channel.element, e.q);
    case Of::velocity:
      return e.markers[element].velocity[channel.component];
    case Of::angular_velocity:
      return e.markers[element].angular_velocity[channel.component];
    case Of::coordinate:
      return e.coordinate[element];
    case Of::speed:
      break;
  }
  return e.coordinate_rate[element];
}

bool MotionChannels::turns(const MotionChannel& channel) const {
  if (channel.is_of_joint()) return joints_.layout(channel.element).coordinate == Coordinate::angle;
  return channel.of == Of::angle || channel.of == Of::angular_velocity;
}

void MotionChannels::acceleration(int marker, std::span<const double> a, const Evaluation& e, double* out) const {
  by_space(model_.space, [&]<class Bodies>(Bodies) {
    const double rest[Bodies::velocities] = {};
    const BodyId place = markers_.place(marker);
    const int driven = place - layout_.free_bodies();
    const double* of = rest;
    if (place != ground) {
      of = driven < 0 ? &a[Bodies::velocities * at(place)] : &e.driven_a[Bodies::velocities * at(driven)];
    }
    marker_acceleration(of, e.arms_of<Bodies>()[at(marker)], out);
  });
}

void MotionChannels::body_acceleration(int body, std::span<const double> a, const Evaluation& e, double* out) const {
  const BodyId place = layout_.place(body);
  const int driven = place - layout_.free_bodies();
  by_space(model_.space, [&]<class Bodies>(Bodies) {
    const double* of = driven < 0 ? &a[Bodies::velocities * at(place)] : &e.driven_a[Bodies::velocities * at(driven)];
    typename Bodies::Arm centre{};
    if constexpr (requires { centre.turn; }) {
      centre.turn = turn(Bodies{}, &e.q[Bodies::coordinates * at(place)], &e.v[Bodies::velocities * at(place)]);
    }
    marker_acceleration(of, centre, out);
  });
}

double MotionChannels::rate(const MotionChannel& channel, std::span<const double> a, const Evaluation& e) const {
  double acceleration_of[6];
  switch (channel.of) {
    case Of::position:
      return e.markers[at(channel.element)].velocity[channel.component];
    case Of::angle:
      return e.markers[at(channel.element)].angular_velocity[2];
    case Of::velocity:
      acceleration(channel.element, a, e, acceleration_of);
      return acceleration_of[channel.component];
    case Of::angular_velocity:
      acceleration(channel.element, a, e, acceleration_of);
      return acceleration_of[3 + channel.component];
    case Of::coordinate:
      return e.coordinate_rate[at(channel.element)];
    case Of::speed:
      break;
  }
  // The row in marker space holds the rest of what the markers' accelerations make of it.
  const CoordinateRow& row = e.coordinate_rows[at(channel.element)];
  MarkerAccelerations ends;
  joints_.accelerations(channel.element, e, a, ends);
  double rate = row.bias;
  for (int i = 0; i < 6; ++i) rate += row.jacobian[i] * ends.a[i] + row.jacobian[6 + i] * ends.b[i];
  return rate;
}

int MotionChannels::bodies(const MotionChannel& channel, BodyId (&places)[2]) const {
  places[0] = places[1] = ground;
  if (!channel.is_of_joint()) {
    places[0] = markers_.place(channel.element);
    return 1;
  }
  places[0] = joints_[channel.element].body_a;
  places[1] = joints_[channel.element].body_b;
  return 2;
}

void MotionChannels::rows(const MotionChannel& channel, const Evaluation& e, ChannelRows (&rows)[2]) const {
  BodyId places[2];
  bodies(channel, places);
  for (int k = 0; k < 2; ++k) rows[k] = ChannelRows{.place = places[k]};
  if (!channel.is_of_joint()) {
    by_space(model_.space,
             [&]<class Bodies>(Bodies) { marker_rows(channel, e.arms_of<Bodies>()[at(channel.element)], rows[0]); });
    return;
  }
  double row[2 * spatial::velocities], bias = 0.0;
  joints_.coordinate_row(channel.element, e, row, bias);
  const std::size_t width = at(layout_.body_velocities());
  for (std::size_t k = 0; k < 2; ++k) {
    std::copy_n(row + width * k, width, channel.of == Of::coordinate ? rows[k].by_q : rows[k].by_v);
  }
}

}  // namespace freeplay
