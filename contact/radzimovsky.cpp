#include "freeplay/plugin.h"
#include "line_contact.h"

namespace freeplay {
namespace {

/// Line contact (line_contact.h) with
///   delta = F/(pi E* L) [ln(B/F) + k],  B = 3.125 E* L c,  k = 2/3
/// for delta [m] below 0.713 c, with the force F [N], length L [m], radial clearance c [m]. Radzimovsky 1953, in the
/// form with diameters, delta = F/(pi E* L) [2/3 + ln(4 R_b/b) + ln(4 R_j/b)], b the contact width.
class Radzimovsky final : public LineContact {
 public:
  Radzimovsky(const Parameters& p, const ContactPair& pair) : LineContact(p, pair, {3.125, 2.0 / 3.0}) {}
};

}  // namespace

Component radzimovsky() {
  return contact_law<Radzimovsky>(
      {.name = "radzimovsky",
       .summary = "Line contact of a pin in a hole, from the stress in cylinders pressed together.",
       .formula =
           "delta = F_s/(pi E* L) [ln(B/F_s) + k], B = 3.125 E* L c, k = 2/3, L: length, c: radial clearance, 1/E* = "
           "h_b + h_j, h = (1 - nu^2)/E; F_N = max(0, F_s (1 + chi delta'/v_0)), chi of the law named by damping.",
       .validity = "Axial length, material and clearance known; fails where delta reaches 0.713 c, as the slope of the "
                   "force has no bound there.",
       .references = "Radzimovsky 1953, Univ Illinois Bull 408; Pereira, Ramalho and Ambrosio 2011, Nonlinear Dyn 63",
       .parameters = line_contact_parameters});
}

}  // namespace freeplay
