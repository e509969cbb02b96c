#include "format/doubtful_play.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace freeplay {
namespace {

// Of bearings: clearances are 0.1 to 1 % of the radius, worn ones and those of studies 5 %, and of a bolt of 6 mm in a
// hole of 7 mm 17 %; polished surfaces are rough by 10 nm.
constexpr double widest_play = 0.2;      // in smaller radii
constexpr double narrowest_play = 1e-8;  // [m]
// Teeth have 0.05 to 1 deg; a gap of 3 % of the pitch radius is a third of a tooth of a wheel with thirty.
constexpr double widest_tooth_gap = 0.03, widest_backlash = 0.1;

bool is_gap(const std::string& path) { return path.ends_with("gap"); }
bool is_play(const std::string& path) { return path.ends_with("clearance") || is_gap(path); }

/// Calls use(path, value) for every number of the dimension that the file gives, or that has a default.
template <class Use>
void each_number(const ParameterBlock& block, std::string_view unit, Use&& use) {
  for (const Parameter& parameter : block.component->description.parameters) {
    const auto value = block.values.find(parameter.name);
    if (std::string_view(parameter.unit) != unit || parameter.kind != ParameterKind::number) continue;
    if (value != block.values.end() && value->second.number > 0.0) use(value->first, value->second.number);
  }
}

}  // namespace

void doubt_play(const CheckedValue& entry, const JointLayout& layout, double scale) {
  const double share = layout.clearance / layout.smaller_radius;
  std::string against;
  if (share > widest_play) {
    against = fmt::format("{:.2g} times the smaller radius of its surfaces", share);
  } else if (scale > 0.0 && layout.clearance > scale) {
    against = fmt::format("more than the lengths of the mechanism, about {:.3g} m", scale);
  } else if (layout.clearance > 0.0 && layout.clearance < narrowest_play) {
    against = "less than the roughness of any surface";
  }
  if (against.empty()) return;
  entry.warn_at_key("doubtful-clearance",
                    fmt::format("the clearance of joint '{}' is {:.4g} m, {}: check it, the radii and their units",
                                entry.key(), layout.clearance, against));
}

void doubt_play_inside(const CheckedParameters& parameters, const JointLayout& layout) {
  const ParameterBlock& block = *parameters.block;
  double longest = 0.0, shortest = std::numeric_limits<double>::infinity();
  bool teeth = false;
  each_number(block, "m", [&](const std::string& path, double value) {
    if (is_play(path)) return;
    longest = std::max(longest, value), shortest = std::min(shortest, value);
    teeth = teeth || path.ends_with("pitch_radius");
  });
  each_number(block, "m", [&](const std::string& path, double value) {
    const auto place = parameters.places.find(path);
    if (!is_play(path) || !(longest > 0.0) || place == parameters.places.end()) return;
    if (layout.clearance > widest_play * layout.smaller_radius) return;  // reported already
    std::string against;
    if (!is_gap(path) && value > longest && !(layout.clearance >= value)) {
      against = fmt::format("more than all radii and lengths of the bearing ({:.4g} m)", longest);
    } else if (is_gap(path) && value > (teeth ? widest_tooth_gap : widest_play) * shortest) {
      against =
          fmt::format("{:.2g} times the smallest radius or width beside it ({:.4g} m)", value / shortest, shortest);
    }
    if (against.empty()) return;
    place->second.warn("doubtful-clearance", fmt::format("'{}' is {:.4g} m, {}: check the number and its unit",
                                                         place->second.path(), value, against));
  });
  each_number(block, "rad", [&](const std::string& path, double value) {
    const auto place = parameters.places.find(path);
    if (!path.ends_with("backlash") || !(value > widest_backlash) || place == parameters.places.end()) return;
    place->second.warn("doubtful-angle",
                       fmt::format("'{0}' is {1:.4g} rad, that is {2:.3g} deg, which teeth do not have: write "
                                   "'{1:.4g} deg' if degrees are meant",
                                   place->second.path(), value, value * 180.0 / M_PI));
  });
}

}  // namespace freeplay
