#include "format/rotation_keys.h"

#include <cmath>

#include <fmt/format.h>

#include "format/doubtful_number.h"
#include "model/rotation.h"

namespace freeplay {
namespace {

/// Says that something is made a unit one whose length is off 1 by more than its digits may leave.
void tell_length(const CheckedValue& value, const std::string& what, double length) {
  if (std::abs(length - 1.0) <= 1e-6) return;
  value.warn("not-unit", fmt::format("{} has length {:.6g}: made one of length 1", what, length));
}

}  // namespace

std::optional<Rotation> read_rotation(MapReader& map) {
  if (!map.owner().in_space()) {
    for (const char* key : {"rpy", "quaternion"}) map.refuse(key, "only in spatial models");
    return std::nullopt;
  }
  const auto rpy = map.find("rpy"), quaternion = map.find("quaternion");
  map.conflict("rpy", "quaternion");
  if (rpy) {
    const auto angles = rpy->quantities(3, dimension::angle);
    for (std::size_t i = 0; angles && i < 3; ++i) doubt_direction(rpy->item(i), (*angles)[i]);
    if (angles) return from_roll_pitch_yaw((*angles)[0], (*angles)[1], (*angles)[2]);
    return std::nullopt;
  }
  if (!quaternion) return std::nullopt;
  const auto numbers = quaternion->quantities(4, dimension::none);
  if (!numbers) return std::nullopt;
  const double size = std::hypot(std::hypot((*numbers)[0], (*numbers)[1]), std::hypot((*numbers)[2], (*numbers)[3]));
  if (!(size > 0.0)) {
    quaternion->fail("out-of-range", "a quaternion of zeros is no rotation");
    return std::nullopt;
  }
  tell_length(*quaternion, "the quaternion", size);
  const double w = (*numbers)[0] / size, x = (*numbers)[1] / size, y = (*numbers)[2] / size, z = (*numbers)[3] / size;
  return Rotation{1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z),       2.0 * (x * z + w * y),
                  2.0 * (x * y + w * z),       1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x),
                  2.0 * (x * z - w * y),       2.0 * (y * z + w * x),       1.0 - 2.0 * (x * x + y * y)};
}

std::optional<Vector3> read_axis(const CheckedValue& value) {
  std::optional<Vector3> axis = value.vector(dimension::none);
  if (!axis) return std::nullopt;
  const double size = std::hypot((*axis)[0], (*axis)[1], (*axis)[2]);
  if (!(size > 0.0)) {
    value.fail("out-of-range", "an axis needs a direction, but this one has no length");
    return std::nullopt;
  }
  tell_length(value, "the axis", size);
  for (double& component : *axis) component /= size;
  return axis;
}

}  // namespace freeplay
