#include "mjcf/angles.h"

#include <cmath>

#include <fmt/format.h>

namespace freeplay::mjcf {
namespace {

/// An eighth of a turn, or a multiple up to a whole turn, rounded to two decimals or more.
bool looks_like_radians(double angle) {
  constexpr double eighth = std::numbers::pi / 4.0;
  const double size = std::abs(angle);
  return size > 0.5 && size < 2.0 * std::numbers::pi + 0.01 && std::abs(std::remainder(size, eighth)) < 6e-3 &&
         size != std::round(size);
}

}  // namespace

void doubt_angles(const std::vector<double>& angles, const char* attribute, const XmlElement& xml,
                  const std::string& owner, const Settings& settings, Messages& messages) {
  const bool degrees = settings.angle_unit != 1.0;
  for (const double angle : angles) {
    if (degrees ? !looks_like_radians(angle) : !urdf::looks_like_degrees(angle)) continue;
    const std::string unit = degrees ? "degrees, the unit of this file" : "radians, the unit of this file";
    messages.warning(spot_of(xml, attribute), "doubtful-angle",
                     fmt::format("'{}' of {}: {:.6g} counts in {}", attribute, owner, angle, unit),
                     fmt::format("<compiler angle=\"{}\"/> changes the unit", degrees ? "radian" : "degree"));
    return;
  }
}

}  // namespace freeplay::mjcf
