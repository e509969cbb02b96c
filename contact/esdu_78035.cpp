#include "freeplay/plugin.h"
#include "line_contact.h"

namespace freeplay {
namespace {

/// Line contact (line_contact.h) with
///   delta = F/(pi E* L) [ln(B/F) + k],  B = 4 pi E* L c,  k = +1
/// for delta [m] below 4 c, with the force F [N], length L [m], radial clearance c [m]. ESDU 78035, quoted from
/// secondary sources.
class Esdu78035 final : public LineContact {
 public:
  Esdu78035(const Parameters& p, const ContactPair& pair) : LineContact(p, pair, {4.0 * pi, 1.0}) {}
};

}  // namespace

Component esdu_78035() {
  return contact_law<Esdu78035>(
      {.name = "esdu-78035",
       .summary = "Line contact of a pin in a hole, the softest of the three.",
       .formula = "delta = F_s/(pi E* L) [ln(B/F_s) + k], B = 4 pi E* L c, k = +1, L: length, c: radial clearance, L: "
                  "length, c: radial clearance, 1/E* = h_b + h_j, h = (1 - nu^2)/E; F_N = max(0, F_s (1 + chi "
                  "delta'/v_0)), chi of the law named by damping.",
       .validity = "Axial length, material and clearance known; fails where delta reaches 4 c, as the slope of the "
                   "force has no bound there.",
       .references = "ESDU 78035, 1978; Pereira, Ramalho and Ambrosio 2011, Nonlinear Dyn 63",
       .parameters = line_contact_parameters});
}

}  // namespace freeplay
