// Line contact: the laws of a cylinder in a cylinder, which give the penetration as a function of the force.
#pragma once

#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>

#include "loss_law.h"
#include "pair_data.h"

namespace freeplay {

/// In what the line contact laws differ: B = factor E* L c and the constant k.
struct LineForm {
  double factor, constant;
};

/// The laws that `damping` may name, in the order of its words after "none".
inline constexpr LossLaw line_losses[] = {loss::hunt_crossley, loss::herbert_mcwhannell,
                                          loss::lee_wang,      loss::lankarani_nikravesh,
                                          loss::gonthier,      loss::flores,
                                          loss::hu_guo,        loss::zhiying_qishao};
inline constexpr Parameter line_contact_parameters[] = {
    {.name = "damping",
     .kind = ParameterKind::choice,
     .default_value = 0,
     .choices = "none|hunt-crossley|herbert-mcwhannell|lee-wang|lankarani-nikravesh|gonthier|flores|hu-guo|"
                "zhiying-qishao",
     .summary = "Law whose factor 1 + chi delta'/v_0 damps this one; none is elastic."},
    {.name = "restitution",
     .default_value = optional,
     .minimum = 0.0,
     .maximum = 1.0,
     .open = Open::minimum,
     .summary = "Coefficient of restitution; required with damping."},
};

/// Elastic contact of a cylinder in a cylindrical hole, implicit in the force F [N]:
///   delta = F/(pi E* L) [ln(B/F) + k],  B = factor E* L c
/// with penetration delta [m], length L [m], radial clearance c [m], 1/E* = h_b + h_j, h = (1 - nu^2)/E; damped by 1 +
/// chi delta'/v_0 of another law. With x = ln(B/F) + k > 1:
///   F = pi E* L delta/x,  x - ln x = 1 + ln(delta_max/delta),  dF/ddelta = pi E* L/(x - 1),
///   integral of F ddelta = F delta (1/2 - 1/(4x)),  delta_max = factor c/pi exp(k - 1)
/// At delta_max the slope is infinite: from there on there is no force. Below 1e-14 m it is taken as zero.
class LineContact : public ContactLaw {
 public:
  /// Throws std::runtime_error from delta_max on.
  ContactForce evaluate(const ContactState& state) const final {
    if (!(state.penetration >= 1e-14)) return {};
    if (state.penetration >= largest_penetration_) refuse(state.penetration);
    const double excess = root(std::log(largest_penetration_ / state.penetration)), x = 1.0 + excess;
    const double force = modulus_ * state.penetration / x;
    return with_loss(
        {.force = force, .slope = modulus_ / excess, .potential = force * state.penetration * (0.5 - 0.25 / x)}, chi_,
        state);
  }
  const char* outside_range(const ContactState&) const final { return outside_; }

 protected:
  /// Reads damping and restitution. Throws BadParameter "missing-key" when the pair lacks something.
  LineContact(const Parameters& p, const ContactPair& pair, const LineForm& form) {
    if (pair.bearing_shape == SurfaceShape::plane || pair.journal_shape == SurfaceShape::corner)
      throw BadParameter("", "out-of-range",
                         "this law is one of a cylinder in a cylindrical hole, here is a flat wall");
    const double clearance =
        known(pair.radial_clearance) ? pair.radial_clearance : pair.bearing_radius - pair.journal_radius;
    const std::string missing = MissingData()
                                    .need(known(clearance), "the radial clearance")
                                    .need(known(pair.length), "'length'")
                                    .need_materials(pair)
                                    .words();
    if (!missing.empty()) throw BadParameter("", "missing-key", "this law cannot do without " + missing);
    modulus_ = pi * pair.length / contact_compliance(pair);
    largest_penetration_ = form.factor * clearance / pi * std::exp(form.constant - 1.0);
    read_loss(p);
  }

  static constexpr double pi = 3.14159265358979323846;

 private:
  void read_loss(const Parameters& p) {
    const int word = p.word("damping");
    const bool given = p.given("restitution");
    if (word == 0) {
      if (given) throw BadParameter("restitution", "conflicting-keys", "'restitution' needs the key 'damping'");
      return;
    }
    if (!given) throw BadParameter("", "missing-key", "'restitution' is required with 'damping'");
    const LossLaw& law = line_losses[word - 1];
    const double restitution = p.number("restitution");
    chi_ = law.factor(restitution);
    if (restitution < law.lowest_restitution) outside_ = law.outside;
  }

  /// s > 0 with s - ln(1 + s) = u for u > 0; 1 + s is minus the lower Lambert branch at -exp(-1 - u). The start is
  /// above the root (Chatzigeorgiou 2013) and the function convex, so that Newton's method falls until rounding ends
  /// it.
  static double root(double u) {
    double s = u + std::sqrt(2.0 * u);
    for (int i = 0; i < 50; ++i) {
      const double next = s - (s - std::log1p(s) - u) * (1.0 + s) / s;
      if (!(next < s)) break;
      s = next;
    }
    return s;
  }

  [[noreturn]] void refuse(double penetration) const {
    char text[120];
    std::snprintf(text, sizeof text,
                  "the penetration of %.4g m is not below the %.4g m at which this line contact law ends", penetration,
                  largest_penetration_);
    throw std::runtime_error(text);
  }

  double modulus_;              // pi E* L [N/m]
  double largest_penetration_;  // delta_max [m]
  double chi_ = 0.0;
  const char* outside_ = nullptr;
};

}  // namespace freeplay
