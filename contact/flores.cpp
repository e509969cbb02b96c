#include "damped_hertz.h"
#include "freeplay/plugin.h"

namespace freeplay {
namespace {

/// Hertz contact with hysteresis damping:
///   F_N = max(0, K delta^n (1 + chi delta'/v_0)),  chi = 8(1 - e)/(5e)
/// with penetration delta [m] and its rate delta' [m/s], approach speed v_0 [m/s], restitution e, K [N/m^n].
/// The rebound is close to e for every e. Flores, Machado, Silva and Martins 2011.
class Flores final : public DampedHertz {
 public:
  Flores(const Parameters& p, const ContactPair& pair) : DampedHertz(p, pair, loss::flores) {}
};

}  // namespace

Component flores() {
  return contact_law<Flores>(
      {.name = loss::flores.name,
       .summary = "Hertz contact with hysteresis damping, for every restitution and soft materials.",
       .formula = "F_N = max(0, K delta^n (1 + 8(1 - e)/(5e) delta'/v_0)); v_0: approach speed, e: restitution; K as "
                  "in hertz.",
       .validity = "Restitution above 0; penetration below a tenth of the radial clearance.",
       .references = "Flores, Machado, Silva and Martins 2011, Multibody Syst Dyn 25, 357-375",
       .parameters = damped_hertz_parameters});
}

}  // namespace freeplay
