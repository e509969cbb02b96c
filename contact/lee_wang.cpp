#include "damped_hertz.h"
#include "freeplay/plugin.h"

namespace freeplay {
namespace {

/// Hertz contact with hysteresis damping:
///   F_N = max(0, K delta^n (1 + chi delta'/v_0)),  chi = 3(1 - e)/4
/// with penetration delta [m] and its rate delta' [m/s], approach speed v_0 [m/s], restitution e, K [N/m^n].
/// Half the damping of Hunt and Crossley: near e = 1 half of the energy that e asks for is lost. Lee and Wang 1983.
class LeeWang final : public DampedHertz {
 public:
  LeeWang(const Parameters& p, const ContactPair& pair) : DampedHertz(p, pair, loss::lee_wang) {}
};

}  // namespace

Component lee_wang() {
  return contact_law<LeeWang>(
      {.name = loss::lee_wang.name,
       .summary = "Hertz contact with hysteresis damping, half that of Hunt and Crossley.",
       .formula =
           "F_N = max(0, K delta^n (1 + 3(1 - e)/4 delta'/v_0)); v_0: approach speed, e: restitution; K as in hertz.",
       .validity = "Restitution near 1, with half of the loss that it asks for; penetration below a tenth of the "
                   "radial clearance.",
       .references = "Lee and Wang 1983, J Mech Des 105",
       .parameters = damped_hertz_parameters});
}

}  // namespace freeplay
