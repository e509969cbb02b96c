// What the block `clearance` of a joint with play says: radii, materials and the start of the journal.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "freeplay/plugin.h"

namespace freeplay::play {

inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Radii [m] of the journal and of its bearing, or half the widths of a slider and of its guide. Those that the file
/// leaves open are NaN; the clearance is known.
struct Radii {
  double bearing, journal, clearance;
  bool known() const { return !std::isnan(bearing); }
};

/// Paths of the keys that give the sizes of both surfaces, and the parts of which one counts: play = outer/outer_parts
/// - inner/inner_parts.
struct SizeKeys {
  const char *outer, *inner, *play;
  double outer_parts = 1.0, inner_parts = 1.0;

  static std::string quoted(const char* path) { return "'" + std::string(path).substr(path_start) + "'"; }
  /// The outer size as the play counts it.
  std::string share_of_outer() const { return (outer_parts == 1.0 ? "" : "half of ") + quoted(outer); }
  static constexpr std::size_t path_start = sizeof("clearance.") - 1;
};
inline constexpr SizeKeys radius_keys{"clearance.bearing_radius", "clearance.journal_radius",
                                      "clearance.radial_clearance"};

/// Reads two of three, all three that agree to 1e-9 of the clearance, or the clearance alone. Throws BadParameter.
inline Radii read_radii(const Parameters& p, const SizeKeys& keys = radius_keys) {
  const std::string outer = SizeKeys::quoted(keys.outer), inner = SizeKeys::quoted(keys.inner),
                    play = SizeKeys::quoted(keys.play);
  Radii r{p.number(keys.outer) / keys.outer_parts, p.number(keys.inner) / keys.inner_parts, p.number(keys.play)};
  const bool bearing = !std::isnan(r.bearing), journal = !std::isnan(r.journal), gap = !std::isnan(r.clearance);
  if (!gap && !(bearing && journal))
    throw BadParameter("clearance", "missing-key", "give two of " + outer + ", " + inner + " and " + play);
  if (bearing && journal && !(r.journal < r.bearing))
    throw BadParameter(
        keys.inner, "out-of-range",
        inner + " must be below " + (keys.outer_parts == keys.inner_parts ? outer : keys.share_of_outer()));
  if (bearing && journal && gap && !(std::abs(r.bearing - r.journal - r.clearance) <= 1e-9 * r.clearance))
    throw BadParameter(keys.play, "conflicting-keys", play + " is not " + keys.share_of_outer() + " minus " + inner);
  if (bearing && gap && !(r.clearance < r.bearing))
    throw BadParameter(keys.play, "out-of-range", play + " must be below " + keys.share_of_outer());
  // All three come from the two that keep the difference exact.
  if (!gap) r.clearance = r.bearing - r.journal;
  if (gap && bearing) r.journal = r.bearing - r.clearance;
  if (gap && !bearing && journal) r.bearing = r.journal + r.clearance;
  if (!bearing && !journal) r.bearing = r.journal = not_a_number;
  return r;
}

/// One block {E, nu}. Throws BadParameter when one of the two is missing.
inline Material read_material(const Parameters& p, const char* block, const char* modulus, const char* ratio) {
  const Material m{p.number(modulus), p.number(ratio)};
  if (std::isnan(m.youngs_modulus) != std::isnan(m.poisson_ratio))
    throw BadParameter(block, "missing-key", std::isnan(m.youngs_modulus) ? "'nu' without 'E'" : "'E' without 'nu'");
  return m;
}

/// Materials of both sides into `pair`: one for both, or one for each, or none (NaN). Throws BadParameter.
inline void read_materials(const Parameters& p, ContactPair& pair) {
  const Material both = read_material(p, "clearance.material", "clearance.material.E", "clearance.material.nu");
  pair.bearing =
      read_material(p, "clearance.material.bearing", "clearance.material.bearing.E", "clearance.material.bearing.nu");
  pair.journal =
      read_material(p, "clearance.material.journal", "clearance.material.journal.E", "clearance.material.journal.nu");
  const bool bearing = !std::isnan(pair.bearing.youngs_modulus), journal = !std::isnan(pair.journal.youngs_modulus);
  if (!std::isnan(both.youngs_modulus)) {
    if (bearing || journal)
      throw BadParameter("clearance.material", "conflicting-keys",
                         "give 'E' and 'nu' for both sides, or 'bearing' and 'journal'");
    pair.bearing = pair.journal = both;
  } else if (bearing != journal) {
    throw BadParameter("clearance.material", "missing-key", bearing ? "'journal' is missing" : "'bearing' is missing");
  }
}

/// What the host may know of the two surfaces; NaN where the file does not give it.
struct Surfaces {
  Surfaces() = default;
  explicit Surfaces(const ContactPair& pair)
      : radius(pair.journal_radius),
        length(pair.length),
        modulus(1.0 / (compliance(pair.bearing) + compliance(pair.journal))) {}
  void declare(JointLayout& layout) const {
    layout.smaller_radius = radius;
    layout.contact_length = length;
    layout.contact_modulus = modulus;
  }
  static double compliance(const Material& m) { return (1.0 - m.poisson_ratio * m.poisson_ratio) / m.youngs_modulus; }
  double radius = not_a_number, length = not_a_number;  // [m]
  double modulus = not_a_number;                        // E* [Pa]
};

/// Forces that do not depend on slip: tried at an ordinary and at a very high speed, with a unit normal force.
inline bool is_inert(const FrictionLawRef& law) {
  if (law.internal_variables() != 0) return false;
  for (const double slip : {1.0, 1e6})
    if (law.evaluate({1.0, slip, {}}, {}).tangential != 0.0) return false;
  return true;
}
inline void require_radii(const Radii& radii, const FrictionLawRef& friction) {
  if (!radii.known() && !is_inert(friction))
    throw BadParameter("clearance", "missing-key", "friction needs 'bearing_radius' or 'journal_radius'");
}

/// The key `initial`: `loaded`, or an offset, which is zero for `centered`.
struct Start {
  explicit Start(const Parameters& p) {
    const int word = p.word("clearance.initial");
    loaded = word == 1;
    if (word >= 0) return;
    const auto eccentricity = p.vector("clearance.initial.eccentricity"),
               velocity = p.vector("clearance.initial.velocity");
    std::copy(eccentricity.begin(), eccentricity.end(), offset.position);
    std::copy(velocity.begin(), velocity.end(), offset.velocity);
  }
  bool loaded = false;
  InitialOffset offset{};
};

/// Leaves what the host has given; all else of a start is zero then.
inline void clear_start(InitialOffset& out) {
  const InitialOffset given = out;
  out = InitialOffset{};
  out.rotation = given.rotation;
  out.a = given.a;
  out.b = given.b;
}

/// The keys `tilt` and `tilt_speed` of `initial`: a rotation vector [rad] and an angular velocity [rad/s].
struct TiltStart {
  explicit TiltStart(const Parameters& p) {
    if (p.word("clearance.initial") >= 0) return;
    tilt = p.vector("clearance.initial.tilt");
    tilt_rate = p.vector("clearance.initial.tilt_speed");
  }
  bool tilts() const { return tilt != std::array<double, 3>{}; }
  std::array<double, 3> tilt{}, tilt_rate{};
};
/// Of a type that keeps parallel in the plane. Throws BadParameter with `remedy`.
inline void refuse_tilt(const Parameters& p, const char* remedy) {
  for (const char* key : {"clearance.initial.tilt", "clearance.initial.tilt_speed"})
    if (p.given(key)) throw BadParameter(key, "type-space", remedy);
}

constexpr Parameter length(const char* name, const char* summary) {
  return {
      .name = name, .unit = "m", .default_value = optional, .minimum = 0.0, .open = Open::minimum, .summary = summary};
}
constexpr Parameter modulus(const char* name, const char* summary) {
  return {
      .name = name, .unit = "Pa", .default_value = optional, .minimum = 0.0, .open = Open::minimum, .summary = summary};
}
constexpr Parameter poisson(const char* name, const char* summary) {
  return {.name = name,
          .default_value = optional,
          .minimum = 0.0,
          .maximum = 0.5,
          .open = Open::maximum,
          .summary = summary};
}

/// Rows of the parameter tables: radii first, then what a type has of its own, then the rest.
inline constexpr Parameter radius_rows[] = {
    length("clearance.bearing_radius", "Inner radius of the ring on the first body."),
    length("clearance.journal_radius", "Radius of the pin on the second body."),
    length("clearance.radial_clearance", "Bearing minus journal radius."),
};
inline constexpr Parameter law_rows[] = {
    modulus("clearance.material.E", "Young's modulus of both sides."),
    poisson("clearance.material.nu", "Poisson's ratio of both sides."),
    modulus("clearance.material.bearing.E", "Young's modulus of the bearing."),
    poisson("clearance.material.bearing.nu", "Poisson's ratio of the bearing."),
    modulus("clearance.material.journal.E", "Young's modulus of the journal."),
    poisson("clearance.material.journal.nu", "Poisson's ratio of the journal."),
    {.name = "clearance.contact",
     .kind = ParameterKind::contact_law,
     .default_value = required,
     .summary = "Law of the normal force."},
    {.name = "clearance.friction",
     .kind = ParameterKind::friction_law,
     .default_value = optional,
     .summary = "Law of the tangential force."},
};
inline constexpr Parameter start_rows[] = {
    {.name = "clearance.initial",
     .kind = ParameterKind::choice,
     .default_value = 0,
     .choices = "centered|loaded",
     .summary = "Start of the journal: in the middle, resting where static contact carries the load, or a map."},
    {.name = "clearance.initial.eccentricity",
     .kind = ParameterKind::vector,
     .unit = "m",
     .default_value = optional,
     .summary = "Journal centre minus bearing centre at the start, global axes."},
    {.name = "clearance.initial.velocity",
     .kind = ParameterKind::vector,
     .unit = "m/s",
     .default_value = optional,
     .summary = "Velocity of the journal centre relative to the bearing centre at the start, global axes."},
};

/// Of those that may also start tilted, in space.
inline constexpr Parameter tilt_start_rows[] = {
    {.name = "clearance.initial.tilt",
     .kind = ParameterKind::vector,
     .unit = "rad",
     .default_value = optional,
     .summary = "Spatial models: rotation vector by which the journal is tilted in the bearing at the start, global "
                "axes; its part along the axis, about which it turns freely, does nothing."},
    {.name = "clearance.initial.tilt_speed",
     .kind = ParameterKind::vector,
     .unit = "rad/s",
     .default_value = optional,
     .summary = "Spatial models: angular velocity by which that changes at the start, likewise."},
};

/// Tables one after the other.
template <std::size_t... N>
constexpr auto joined(const Parameter (&... tables)[N]) {
  std::array<Parameter, (N + ...)> all{};
  auto next = all.begin();
  ((next = std::copy(std::begin(tables), std::end(tables), next)), ...);
  return all;
}

}  // namespace freeplay::play
