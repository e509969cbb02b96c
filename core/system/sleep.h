// Sleep: how far a joint in flight may move before it is asked again.
#pragma once

#include <cmath>
#include <cstddef>

#include "freeplay/joint.h"

namespace freeplay {

/// State of a sleeping joint: its forces are not evaluated while its second marker stays within `radius` of `from` [m]
/// (0: it does not sleep), as Joint::free_distance counts the way. While it sleeps (`now`) nothing else of it is
/// evaluated either.
struct Sleep {
  /// How the way is counted: JointLayout::free_turns, play between walls in the plane, or any other.
  enum class Kind { round, walls, turns };

  bool now = false;
  double radius = 0.0, from[12] = {};
  bool left = false;        ///< set by evaluations that found it elsewhere, and asked it
  double levers[3] = {};    ///< Joint::free_levers
  Kind kind = Kind::round;  ///< fixed
  double reach = 0.0;       ///< JointLayout::contact_reach of walls, fixed

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.now, self.radius, self.from, self.left, self.levers);
  }

  /// Where b stands [m]: its origin from that of a in world axes; between walls its shift across the x axis of a, and
  /// cosine and sine of its angle against a times `reach`; with turns its origin from that of a and its axes times
  /// their levers, in the axes of a.
  void place(const MarkerKinematics& a, const MarkerKinematics& b, double (&at)[12]) const {
    const double* h = a.rotation;
    const double d[3] = {b.position[0] - a.position[0], b.position[1] - a.position[1], b.position[2] - a.position[2]};
    for (int i = 0; i < 3; ++i) at[i] = d[i];
    if (kind == Kind::round) return;
    const double* x = b.rotation;
    if (kind == Kind::walls) {
      at[0] = h[0] * d[1] - h[3] * d[0];
      at[1] = reach * (h[0] * x[0] + h[3] * x[3]);
      at[2] = reach * (h[0] * x[3] - h[3] * x[0]);
      return;
    }
    for (int i = 0; i < 3; ++i) {
      at[i] = h[i] * d[0] + h[3 + i] * d[1] + h[6 + i] * d[2];
      for (int k = 0; k < 3; ++k)
        at[3 + 3 * k + i] =
            levers[k] == 0.0 ? 0.0 : levers[k] * (h[i] * x[k] + h[3 + i] * x[3 + k] + h[6 + i] * x[6 + k]);
    }
  }
  bool holds(const MarkerKinematics& a, const MarkerKinematics& b) const {
    if (kind != Kind::round) return way(a, b) < radius;
    double squared = 0.0;
    for (int i = 0; i < 3; ++i) {
      const double moved = b.position[i] - a.position[i] - from[i];
      squared += moved * moved;
    }
    return squared < radius * radius;
  }
  /// Upper bound of how far b moved [m]: the sum of the components, which no length exceeds.
  double way(const MarkerKinematics& a, const MarkerKinematics& b) const {
    double at[12];
    place(a, b, at);
    const int numbers = kind == Kind::turns ? 12 : 3;
    double moved = 0.0;
    for (int i = 0; i < numbers; ++i) moved += std::abs(at[i] - from[i]);
    return moved;
  }
  /// No less than how fast that grows [m/s].
  double speed(const MarkerKinematics& a, const MarkerKinematics& b) const {
    double u[3], sum = 0.0;
    for (int i = 0; i < 3; ++i) sum += std::abs(u[i] = b.velocity[i] - a.velocity[i]);
    if (kind == Kind::round) return sum;
    if (kind == Kind::turns) return speed_with_turns(a, b, u);
    constexpr double root_of_two = 1.4142135623730951;  // of cosine and sine together
    const double *h = a.rotation, w = a.angular_velocity[2];
    const double along = h[0] * (b.position[0] - a.position[0]) + h[3] * (b.position[1] - a.position[1]);
    return std::abs(h[0] * u[1] - h[3] * u[0] - w * along) + root_of_two * reach * std::abs(b.angular_velocity[2] - w);
  }

 private:
  /// Of the origin |u - w_a x d|, of the tip of an axis |(w_b - w_a) x axis|; the parts in the axes of a add up to no
  /// more than the length times the root of three.
  double speed_with_turns(const MarkerKinematics& a, const MarkerKinematics& b, const double (&u)[3]) const {
    constexpr double root_of_three = 1.7320508075688773;
    double d[3], w[3];
    for (int i = 0; i < 3; ++i) {
      d[i] = b.position[i] - a.position[i];
      w[i] = b.angular_velocity[i] - a.angular_velocity[i];
    }
    const auto length = [](double x, double y, double z) { return std::sqrt(x * x + y * y + z * z); };
    const double *w_a = a.angular_velocity, *x = b.rotation;
    double sum = length(u[0] - (w_a[1] * d[2] - w_a[2] * d[1]), u[1] - (w_a[2] * d[0] - w_a[0] * d[2]),
                        u[2] - (w_a[0] * d[1] - w_a[1] * d[0]));
    for (int k = 0; k < 3; ++k) {
      if (levers[k] == 0.0) continue;
      sum += levers[k] *
             length(w[1] * x[6 + k] - w[2] * x[3 + k], w[2] * x[k] - w[0] * x[6 + k], w[0] * x[3 + k] - w[1] * x[k]);
    }
    return root_of_three * sum;
  }
};

}  // namespace freeplay
