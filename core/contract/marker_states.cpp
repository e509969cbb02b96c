#include "contract/marker_states.h"

#include <cmath>

#include "freeplay/eigen.h"

namespace freeplay {
namespace {

using Eigen::Vector3d;

Eigen::Matrix3d turn(const Vector3d& vector) {
  const double angle = vector.norm();
  if (angle == 0.0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix();
}

void set_rotation(MarkerKinematics& marker, const Eigen::Matrix3d& rotation) {
  Eigen::Map<RowMajor3>(marker.rotation) = rotation;
}

}  // namespace

std::vector<std::size_t> moving_components(Space space) {
  if (space == Space::planar) return {0, 1, 5, 6, 7, 11};
  return {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
}

MarkerKinematics moved(const MarkerKinematics& marker, const double* by) {
  MarkerKinematics result = marker;
  for (int i = 0; i < 3; ++i) result.position[i] += by[i];
  set_rotation(result, turn(Vector3d(by[3], by[4], by[5])) * rotation(marker));
  return result;
}

MarkerPair moved(const MarkerPair& pair, const Twelve& by) {
  return {moved(pair.a, by.data()), moved(pair.b, by.data() + 6)};
}

MarkerPair with_twists(const MarkerPair& pair, const Twelve& twists) {
  MarkerPair result = pair;
  for (std::size_t i = 0; i < 3; ++i) {
    result.a.velocity[i] = twists[i];
    result.a.angular_velocity[i] = twists[3 + i];
    result.b.velocity[i] = twists[6 + i];
    result.b.angular_velocity[i] = twists[9 + i];
  }
  return result;
}

Twelve twists(const MarkerPair& pair) {
  Twelve result{};
  for (std::size_t i = 0; i < 3; ++i) {
    result[i] = pair.a.velocity[i];
    result[3 + i] = pair.a.angular_velocity[i];
    result[6 + i] = pair.b.velocity[i];
    result[9 + i] = pair.b.angular_velocity[i];
  }
  return result;
}

MarkerPair MarkerPath::at(double time) const {
  Twelve velocity = twists(start), by{};
  for (std::size_t i = 0; i < by.size(); ++i) {
    by[i] = time * (velocity[i] + 0.5 * time * acceleration[i]);
    velocity[i] += time * acceleration[i];
  }
  return with_twists(moved(start, by), velocity);
}

Twelve random_twelve(Space space, RandomNumbers& random, double size) {
  Twelve result{};
  for (const std::size_t i : moving_components(space)) result[i] = random.between(-size, size);
  return result;
}

MarkerPair random_pair(Space space, RandomNumbers& random) {
  MarkerPair still;
  set_rotation(still.a, Eigen::Matrix3d::Identity());
  set_rotation(still.b, Eigen::Matrix3d::Identity());
  Twelve by = random_twelve(space, random, 0.5);
  // Angles may be anywhere, but not next to the half turn at which they jump.
  for (const std::size_t i : {3u, 4u, 5u, 9u, 10u, 11u}) by[i] *= 2.4;
  return with_twists(moved(still, by), random_twelve(space, random, 1.5));
}

MarkerPair turned_pair(Space space, const StateSize& size, double relative, RandomNumbers& random) {
  const auto large = [&random](double most) {
    const double sign = random.between(-1.0, 1.0) < 0.0 ? -1.0 : 1.0;
    return sign * random.between(0.5 * most, most);
  };
  const bool planar = space == Space::planar;
  const auto axis = [&] {
    if (planar) return Vector3d(0.0, 0.0, 1.0);
    Vector3d any(random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.between(-1.0, 1.0));
    return Vector3d(any.normalized());
  };
  MarkerPair pair;
  const Eigen::Matrix3d first = turn(random.between(-M_PI, M_PI) * axis());
  set_rotation(pair.a, first);
  set_rotation(pair.b, first * turn(relative * axis()));
  Twelve twist{};
  for (const std::size_t i : moving_components(space)) {
    if (i % 6 < 3) {
      (i < 6 ? pair.a : pair.b).position[i % 6] = large(size.distance);
      twist[i] = large(size.speed);
    } else {
      twist[i] = large(size.turning);
    }
  }
  return with_twists(pair, twist);
}

MarkerPair placed_pair(const MarkerPair& base, const Pose& relative) {
  MarkerPair pair = base;
  const Vector3d offset = rotation(pair.a) * vector3(relative.position);
  for (int i = 0; i < 3; ++i) pair.b.position[i] = pair.a.position[i] + offset[i];
  set_rotation(pair.b, rotation(pair.a) * Eigen::Map<const RowMajor3>(relative.rotation));
  return pair;
}

MarkerPair distant_pair(const MarkerPair& base, Space space, double gap, RandomNumbers& random) {
  MarkerPair pair = base;
  Vector3d direction(random.between(-1.0, 1.0), random.between(-1.0, 1.0),
                     space == Space::planar ? 0.0 : random.between(-1.0, 1.0));
  direction *= gap / direction.norm();
  for (int i = 0; i < 3; ++i) pair.b.position[i] = pair.a.position[i] + direction[i];
  return pair;
}

}  // namespace freeplay
