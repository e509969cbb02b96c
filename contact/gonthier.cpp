#include "damped_hertz.h"
#include "freeplay/plugin.h"

namespace freeplay {
namespace {

/// Hertz contact with hysteresis damping:
///   F_N = max(0, K delta^n (1 + chi delta'/v_0)),  chi = (1 - e^2)/e
/// with penetration delta [m] and its rate delta' [m/s], approach speed v_0 [m/s], restitution e, K [N/m^n].
/// The rebound is close to e for every e. Gonthier, McPhee, Lange and Piedboeuf 2004.
class Gonthier final : public DampedHertz {
 public:
  Gonthier(const Parameters& p, const ContactPair& pair) : DampedHertz(p, pair, loss::gonthier) {}
};

}  // namespace

Component gonthier() {
  return contact_law<Gonthier>(
      {.name = loss::gonthier.name,
       .summary = "Hertz contact with hysteresis damping, for every restitution.",
       .formula =
           "F_N = max(0, K delta^n (1 + (1 - e^2)/e delta'/v_0)); v_0: approach speed, e: restitution; K as in hertz.",
       .validity = "Restitution above 0; penetration below a tenth of the radial clearance.",
       .references = "Gonthier et al. 2004, Multibody Syst Dyn 11, 209-233",
       .parameters = damped_hertz_parameters});
}

}  // namespace freeplay
