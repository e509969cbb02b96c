// MarkerStates: random poses, twists and paths of a joint's two markers.
#pragma once

#include <array>
#include <vector>

#include "contract/random_numbers.h"
#include "freeplay/joint.h"

namespace freeplay {

/// [pose a, pose b] or [twist a, twist b]: displacements and rotation vectors, or velocities, world axes.
using Twelve = std::array<double, 12>;

struct MarkerPair {
  MarkerKinematics a{}, b{};
};

/// Which of the twelve components a motion in this space has.
std::vector<std::size_t> moving_components(Space space);

/// A marker whose pose is moved by a displacement and a rotation vector (6 numbers).
MarkerKinematics moved(const MarkerKinematics& marker, const double* by);
MarkerPair moved(const MarkerPair& pair, const Twelve& by);
/// The same pose with other twists.
MarkerPair with_twists(const MarkerPair& pair, const Twelve& twists);
Twelve twists(const MarkerPair& pair);

/// A motion through `start` with nearly constant accelerations; twist and acceleration are exact at time 0, pose and
/// twist belong together to second order.
struct MarkerPath {
  MarkerPair start;
  Twelve acceleration{};
  MarkerPair at(double time) const;
};

/// A random pose for a, and b beside it: anywhere within half a metre.
MarkerPair random_pair(Space space, RandomNumbers& random);

/// How large the numbers of a random state are.
struct StateSize {
  double distance = 0.5;  ///< of coordinates of the origins [m]
  double speed = 1.5;     ///< [m/s]
  double turning = 1.5;   ///< [rad/s]
};
/// Markers turned by any angle, b against a by `relative` [rad]. Each number is at least half as large as `size` says.
MarkerPair turned_pair(Space space, const StateSize& size, double relative, RandomNumbers& random);

/// Twists and pose of a are those of `base`; b stands where `relative` puts it in a.
MarkerPair placed_pair(const MarkerPair& base, const Pose& relative);
/// `base` with the origin of b at the distance `gap` from that of a.
MarkerPair distant_pair(const MarkerPair& base, Space space, double gap, RandomNumbers& random);
Twelve random_twelve(Space space, RandomNumbers& random, double size);

}  // namespace freeplay
