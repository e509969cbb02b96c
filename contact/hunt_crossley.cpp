#include "damped_hertz.h"
#include "freeplay/plugin.h"

namespace freeplay {
namespace {

/// Hertz contact with hysteresis damping:
///   F_N = max(0, K delta^n (1 + chi delta'/v_0)),  chi = 3(1 - e)/2
/// with penetration delta [m] and its rate delta' [m/s], approach speed v_0 [m/s], restitution e, K [N/m^n].
/// The rebound is close to e only for e near 1. Hunt and Crossley 1975.
class HuntCrossley final : public DampedHertz {
 public:
  HuntCrossley(const Parameters& p, const ContactPair& pair) : DampedHertz(p, pair, loss::hunt_crossley) {}
};

}  // namespace

Component hunt_crossley() {
  return contact_law<HuntCrossley>(
      {.name = loss::hunt_crossley.name,
       .summary = "Hertz contact with hysteresis damping, for a restitution near 1.",
       .formula =
           "F_N = max(0, K delta^n (1 + 3(1 - e)/2 delta'/v_0)); v_0: approach speed, e: restitution; K as in hertz.",
       .validity = "Restitution near 1; penetration below a tenth of the radial clearance.",
       .references = "Hunt and Crossley 1975, J Appl Mech 42, 440-445",
       .parameters = damped_hertz_parameters});
}

}  // namespace freeplay
