#include "damped_hertz.h"
#include "freeplay/plugin.h"

namespace freeplay {
namespace {

/// Hertz contact with hysteresis damping:
///   F_N = max(0, K delta^n (1 + chi delta'/v_0)),  chi = 3(1 - e)/(2e)
/// with penetration delta [m] and its rate delta' [m/s], approach speed v_0 [m/s], restitution e, K [N/m^n].
/// The rebound is close to e for every e. Hu and Guo 2015.
class HuGuo final : public DampedHertz {
 public:
  HuGuo(const Parameters& p, const ContactPair& pair) : DampedHertz(p, pair, loss::hu_guo) {}
};

}  // namespace

Component hu_guo() {
  return contact_law<HuGuo>({.name = loss::hu_guo.name,
                             .summary = "Hertz contact with hysteresis damping, for every restitution.",
                             .formula = "F_N = max(0, K delta^n (1 + 3(1 - e)/(2e) delta'/v_0)); v_0: approach speed, "
                                        "e: restitution; K as in hertz.",
                             .validity = "Restitution above 0; penetration below a tenth of the radial clearance.",
                             .references = "Hu and Guo 2015, Multibody Syst Dyn 35",
                             .parameters = damped_hertz_parameters});
}

}  // namespace freeplay
