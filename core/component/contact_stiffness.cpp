#include "component/contact_stiffness.h"

#include <cmath>
#include <string_view>

#include <fmt/format.h>

namespace freeplay {
namespace {

constexpr double depth_by_clearance = 0.1;

/// The exponent n of a unit N/m^n, which may be named by another parameter; nothing for other units.
std::optional<double> exponent_of(std::string_view unit, const ParameterBlock& law) {
  if (unit == "N/m") return 1.0;
  constexpr std::string_view power = "N/m^";
  if (!unit.starts_with(power)) return std::nullopt;
  const auto found = law.values.find(unit.substr(power.size()));
  if (found == law.values.end() || !std::isfinite(found->second.number)) return std::nullopt;
  return found->second.number;
}

}  // namespace

std::optional<ContactStiffness> given_stiffness(const ParameterBlock& block, const JointLayout& layout) {
  if (!(layout.clearance > 0.0) || !(layout.smaller_radius > 0.0)) return std::nullopt;
  for (const auto& [key, entry] : block.values) {
    const ParameterBlock* law = entry.law.get();
    if (law == nullptr || law->component->kind != ComponentKind::contact_law) continue;
    for (const Parameter& parameter : law->component->description.parameters) {
      const auto value = law->values.find(parameter.name);
      if (value == law->values.end() || !value->second.given || !(value->second.number > 0.0)) continue;
      const std::optional<double> exponent = exponent_of(parameter.unit, *law);
      if (!exponent) continue;
      const double depth = depth_by_clearance * layout.clearance;
      // K delta^n / (4/3 delta^1.5), and the root of R = R_j^2/c is R_j/sqrt(c).
      const double by_root = 0.75 * value->second.number * std::pow(depth, *exponent - 1.5);
      const double modulus = by_root * std::sqrt(layout.clearance) / layout.smaller_radius;
      return ContactStiffness{parameter.name, fmt::format("N/m^{:g}", *exponent), value->second.number, modulus};
    }
  }
  return std::nullopt;
}

}  // namespace freeplay
