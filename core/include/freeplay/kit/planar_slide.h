// The line of a slide in the plane: a point of one body on the x axis of a marker on another.
#pragma once

#include "freeplay/kit/planar_marker.h"

namespace freeplay::planar {

/// With d = P_b - P_a [m], h the x axis of marker a, n = h turned by +90 degrees and w the angular velocity of marker
/// a:
///
///   across  n.d,  (n.d)' = n.d' - w h.d,  (n.d)'' = n.d'' - h.d alpha - 2 w h.d' - w^2 n.d
///   along   h.d,  (h.d)' = h.d' + w n.d,  (h.d)'' = h.d'' + n.d alpha + 2 w n.d' - w^2 h.d
///
/// Terms with n.d stay, so that derivatives are exact off the constraint n.d = 0 too. Nikravesh 1988; Haug 1989.
class Slide {
 public:
  explicit Slide(const JointInput& in)
      : h_(x_axis(*in.a)),
        n_(turned(h_)),
        d_(position(*in.b) - position(*in.a)),
        rate_(velocity(*in.b) - velocity(*in.a)),
        w_(angular_velocity(*in.a)) {}

  /// Row n.d = 0: value, its row of marker twists, and gamma.
  double across() const { return n_.dot(d_); }
  void write_across(double* row) const { write_row(row, n_, -h_.dot(d_)); }
  double across_gamma() const { return 2.0 * w_ * h_.dot(rate_) + w_ * w_ * n_.dot(d_); }

  /// The coordinate h.d.
  void write_along(CoordinateRow& row) const {
    row.value = h_.dot(d_);
    row.bias = 2.0 * w_ * n_.dot(rate_) - w_ * w_ * h_.dot(d_);
    write_row(row.jacobian, h_, n_.dot(d_));
  }

 private:
  static void write_row(double* row, const Eigen::Vector2d& direction, double turn) {
    for (int i = 0; i < 2; ++i) {
      row[velocity_a + i] = -direction[i];
      row[velocity_b + i] = direction[i];
    }
    row[turn_a] = turn;
  }

  Eigen::Vector2d h_, n_, d_, rate_;
  double w_;
};

}  // namespace freeplay::planar
