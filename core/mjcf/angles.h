// MjcfAngles: angles that were probably written in the other unit.
#pragma once

#include <string>
#include <vector>

#include "mjcf/settings.h"

namespace freeplay::mjcf {

/// Warns `doubtful-angle` of the first that looks like radians where degrees count, or like degrees where radians do.
void doubt_angles(const std::vector<double>& angles, const char* attribute, const XmlElement& xml,
                  const std::string& owner, const Settings& settings, Messages& messages);

}  // namespace freeplay::mjcf
