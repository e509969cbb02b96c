// EvaluationContext: what evaluations of one run share and others do not, so that runs can share the equations of
// motion.
#pragma once

#include <cmath>
#include <vector>

#include "freeplay/joint.h"
#include "system/profile.h"

namespace freeplay {

/// Of a joint that is not asked for forces while its second marker stays within `radius` of `from` [m], 0 for none, as
/// Joint::free_distance counts the way. Where it sleeps (`now`), it is asked for nothing else either.
struct Sleep {
  bool now = false;
  double radius = 0.0, from[3] = {};
  bool left = false;     ///< set by evaluations that found it elsewhere, and asked it
  double reach = round;  ///< JointLayout::contact_reach of play between walls, fixed
  static constexpr double round = -1.0;

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.now, self.radius, self.from, self.left);
  }

  /// Where b stands [m]: its origin from that of a in world axes or, between walls, its shift across the x axis of a,
  /// and cosine and sine of its angle against a times `reach`.
  void place(const MarkerKinematics& a, const MarkerKinematics& b, double (&at)[3]) const {
    for (int i = 0; i < 3; ++i) at[i] = b.position[i] - a.position[i];
    if (reach == round) return;
    const double *h = a.rotation, *x = b.rotation;
    at[0] = h[0] * at[1] - h[3] * at[0];
    at[1] = reach * (h[0] * x[0] + h[3] * x[3]);
    at[2] = reach * (h[0] * x[3] - h[3] * x[0]);
  }
  bool holds(const MarkerKinematics& a, const MarkerKinematics& b) const {
    if (reach != round) return way(a, b) < radius;
    double squared = 0.0;
    for (int i = 0; i < 3; ++i) {
      const double moved = b.position[i] - a.position[i] - from[i];
      squared += moved * moved;
    }
    return squared < radius * radius;
  }
  /// No less than how far b moved: lengths are never more than the sums of their parts [m].
  double way(const MarkerKinematics& a, const MarkerKinematics& b) const {
    double at[3];
    place(a, b, at);
    double moved = 0.0;
    for (int i = 0; i < 3; ++i) moved += std::abs(at[i] - from[i]);
    return moved;
  }
  /// No less than how fast that grows [m/s].
  double speed(const MarkerKinematics& a, const MarkerKinematics& b) const {
    double u[3], sum = 0.0;
    for (int i = 0; i < 3; ++i) sum += std::abs(u[i] = b.velocity[i] - a.velocity[i]);
    if (reach == round) return sum;
    constexpr double root_of_two = 1.4142135623730951;  // of cosine and sine together
    const double *h = a.rotation, w = a.angular_velocity[2];
    const double along = h[0] * (b.position[0] - a.position[0]) + h[3] * (b.position[1] - a.position[1]);
    return std::abs(h[0] * u[1] - h[3] * u[0] - w * along) + root_of_two * reach * std::abs(b.angular_velocity[2] - w);
  }
};

/// Not for several threads.
struct EvaluationContext {
  double per_contact = 0.0;     ///< JointInput::per_contact
  Profile* profile = nullptr;   ///< where the time of the run is counted, or null
  std::vector<Sleep> sleeps{};  ///< by joint; a run decides which joints sleep (run/sleeping_joints.h)

  template <class Self, class Archive>
  static void exchange(Self& self, Archive& archive) {
    archive(self.sleeps);
  }

  bool is_asleep(int joint) const {
    const auto j = static_cast<std::size_t>(joint);
    return j < sleeps.size() && sleeps[j].now;
  }
};

}  // namespace freeplay
