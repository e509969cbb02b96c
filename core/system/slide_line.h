// SlideLine: the line along which one marker of a planar joint slides on the other.
#pragma once

#include <span>

#include "base/index.h"
#include "system/joint_ends.h"
#include "system/markers.h"

namespace freeplay::planar {

/// h the x axis of marker a, n = h turned by +90 degrees, d = P_b - P_a, and their rates.
///
///   (n.d)' = n.d' - w h.d,  (n.d)'' = n.d'' - h.d alpha - 2 w h.d' - w^2 n.d
///   (h.d)' = h.d' + w n.d,  (h.d)'' = h.d'' + n.d alpha + 2 w n.d' - w^2 h.d
struct SlideLine {
  SlideLine(const JointEnds& ends, std::span<const Mount> mounts, const MarkerValues& e)
      : a(e.arms[at(ends.marker_a)]), b(e.arms[at(ends.marker_b)]) {
    const Mount& mount = mounts[at(ends.marker_a)];
    const planar::Turn still, &turn = ends.body_a == ground ? still : e.turns[at(ends.body_a)];
    h_x = turn.cosine * mount.cosine - turn.sine * mount.sine;
    h_y = turn.sine * mount.cosine + turn.cosine * mount.sine;
    d_x = b.at_x - a.at_x;
    d_y = b.at_y - a.at_y;
    const auto speed = [&](BodyId body, std::size_t i) { return body == ground ? 0.0 : e.v[3 * at(body) + i]; };
    rate_x = (speed(ends.body_b, 0) - b.y * b.w) - (speed(ends.body_a, 0) - a.y * a.w);
    rate_y = (speed(ends.body_b, 1) + b.x * b.w) - (speed(ends.body_a, 1) + a.x * a.w);
  }
  double along() const { return h_x * d_x + h_y * d_y; }
  double across() const { return h_x * d_y - h_y * d_x; }
  double rate_along() const { return h_x * rate_x + h_y * rate_y; }
  double rate_across() const { return h_x * rate_y - h_y * rate_x; }

  const Arm &a, &b;
  double h_x, h_y, d_x, d_y, rate_x, rate_y;
};

/// Angle of marker b beyond that of marker a [rad], without jumps where bodies turn.
inline double angle_between(const JointEnds& ends, std::span<const Mount> mounts, const MarkerValues& e) {
  const auto angle = [&](BodyId body, int marker) {
    return (body == ground ? 0.0 : e.q[3 * at(body) + 2]) + mounts[at(marker)].angle;
  };
  return angle(ends.body_b, ends.marker_b) - angle(ends.body_a, ends.marker_a);
}

}  // namespace freeplay::planar
