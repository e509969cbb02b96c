// Stiffness of the Hertz type laws: the elastic part F_s = K delta^n that they share.
#pragma once

#include <cmath>
#include <string>

#include "loss_law.h"
#include "pair_data.h"

namespace freeplay {

/// The parameters of every law with F_s = K delta^n; spread them into its table.
inline constexpr Parameter stiffness_parameter{
    .name = "K",
    .unit = "N/m^exponent",
    .default_value = optional,
    .minimum = 0.0,
    .open = Open::minimum,
    .summary = "Contact stiffness; without it the one of Hertz, from radii and material (exponent 1.5 only)."};
inline constexpr Parameter exponent_parameter{.name = "exponent",
                                              .default_value = 1.5,
                                              .minimum = 1.0,
                                              .maximum = 3.0,
                                              .summary = "Exponent n of the penetration; 1.5 for a point contact."};

/// What has to be in `pair` for hertz_stiffness() and is not, as words for a message; "" when all is there.
inline std::string missing_for_hertz(const ContactPair& pair) {
  const bool on_plane = pair.bearing_shape == SurfaceShape::plane;
  return MissingData()
      .need(known(pair.relative_curvature()), on_plane ? "the radius of what touches the wall" : "the radii")
      .need_materials(pair)
      .words();
}

/// Stiffness [N/m^1.5] of a sphere (journal) in a spherical cavity (bearing), or on a plane, whose 1/R_b is 0:
///   K = 4/(3 (h_b + h_j)) sqrt(R_b R_j/(R_b - R_j)),  h = (1 - nu^2)/E
/// with radii R [m], Young's modulus E [Pa], Poisson's ratio nu. Hertz 1881; Lankarani and Nikravesh 1990.
inline double hertz_stiffness(const ContactPair& pair) {
  const bool on_plane = pair.bearing_shape == SurfaceShape::plane;
  const double radius =
      on_plane ? pair.journal_radius : pair.bearing_radius * pair.journal_radius / pair.radial_clearance;
  return 4.0 / (3.0 * contact_compliance(pair)) * std::sqrt(radius);
}

/// F_N = max(0, K delta^n (1 + chi delta'/v_0)), the form of all laws with a loss factor chi (loss_law.h). The
/// potential is K delta^(n+1)/(n+1).
class HertzSpring {
 public:
  /// Reads K and exponent. Throws BadParameter "missing-key" when K is absent and does not follow from the pair.
  HertzSpring(const Parameters& p, const ContactPair& pair)
      : stiffness_(p.number("K")), exponent_(p.number("exponent")) {
    if (p.given("K")) return;
    if (exponent_ != point_contact) throw BadParameter("", "missing-key", "'K' is required unless 'exponent' is 1.5");
    const std::string missing = missing_for_hertz(pair);
    if (!missing.empty())
      throw BadParameter("", "missing-key", "'K' is required, as it cannot be computed without " + missing);
    stiffness_ = hertz_stiffness(pair);
    // Hertz theory needs a contact patch much smaller than the radii: half as wide as sqrt(R delta), R the relative
    // one.
    const bool on_plane = pair.bearing_shape == SurfaceShape::plane;
    largest_penetration_ = 0.1 * (on_plane ? pair.journal_radius : pair.radial_clearance);
    too_deep_ = on_plane ? "The penetration passes a tenth of the radius: the contact patch is not small against it, "
                           "and the stiffness of Hertz only serves as a model."
                         : too_deep_;
  }

  ContactForce force(const ContactState& state, double chi) const {
    if (!(state.penetration > 0.0)) return {};
    const double power = exponent_ == point_contact ? state.penetration * std::sqrt(state.penetration)
                                                    : std::pow(state.penetration, exponent_);
    const double elastic = stiffness_ * power;
    return with_loss({.force = elastic,
                      .slope = exponent_ * elastic / state.penetration,
                      .potential = elastic * state.penetration / (exponent_ + 1.0)},
                     chi, state);
  }

  /// A static sentence when the penetration is too deep for the computed K.
  const char* outside_range(const ContactState& state) const {
    return state.penetration > largest_penetration_ ? too_deep_ : nullptr;
  }

 private:
  static constexpr double point_contact = 1.5;
  double stiffness_, exponent_;
  double largest_penetration_ = unbounded;  // [m]
  const char* too_deep_ =
      "The penetration passes a tenth of the radial clearance: the contact is conformal, and the "
      "stiffness of Hertz only serves as a model.";
};

}  // namespace freeplay
