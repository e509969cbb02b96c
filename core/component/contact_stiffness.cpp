#include "component/contact_stiffness.h"

#include <cmath>
#include <string_view>

#include <fmt/format.h>

namespace freeplay {
namespace {

constexpr double depth_by_clearance = 0.1, depth_by_radius = 1e-3;
constexpr double usual_size = 0.1;  // [m]; limits ten times beyond all materials hold from 1 mm to 10 m

/// The exponent n of a unit N/m^n, which may be named by another parameter; nothing for other units.
std::optional<double> exponent_of(std::string_view unit, const ParameterBlock& law) {
  if (unit == "N/m") return 1.0;
  constexpr std::string_view power = "N/m^";
  if (!unit.starts_with(power)) return std::nullopt;
  const auto found = law.values.find(unit.substr(power.size()));
  if (found == law.values.end() || !std::isfinite(found->second.number)) return std::nullopt;
  return found->second.number;
}

/// Radius of the sphere on a plane that stands for the contact, and a depth at which it is looked at [m].
struct TouchingSphere {
  double radius, depth;
};

TouchingSphere sphere_of(const JointLayout& layout, double size) {
  const double smaller = layout.smaller_radius, play = layout.clearance;
  if (smaller > 0.0 && play > 0.0) return {smaller * smaller / play, depth_by_clearance * play};
  const double radius = smaller > 0.0 ? smaller : size > 0.0 ? size : usual_size;
  return {radius, depth_by_radius * radius};
}

}  // namespace

std::optional<ContactStiffness> given_stiffness(const ParameterBlock& block, const JointLayout& layout, double size) {
  for (const auto& [key, entry] : block.values) {
    const ParameterBlock* law = entry.law.get();
    if (law == nullptr || law->component->kind != ComponentKind::contact_law) continue;
    for (const Parameter& parameter : law->component->description.parameters) {
      const auto value = law->values.find(parameter.name);
      if (value == law->values.end() || !value->second.given || !(value->second.number > 0.0)) continue;
      const std::optional<double> exponent = exponent_of(parameter.unit, *law);
      if (!exponent) continue;
      const TouchingSphere contact = sphere_of(layout, size);
      const double by_root = 0.75 * value->second.number * std::pow(contact.depth, *exponent - 1.5);
      const double modulus = by_root / std::sqrt(contact.radius);
      return ContactStiffness{parameter.name, fmt::format("N/m^{:g}", *exponent), value->second.number, modulus};
    }
  }
  return std::nullopt;
}

}  // namespace freeplay
