#include "damped_hertz.h"
#include "freeplay/plugin.h"

namespace freeplay {
namespace {

/// Hertz contact with hysteresis damping:
///   F_N = max(0, K delta^n (1 + chi delta'/v_0)),  chi = 3(1 - e^2)/4
/// with penetration delta [m] and its rate delta' [m/s], approach speed v_0 [m/s], restitution e, K [N/m^n].
/// The rebound is close to e only for e above about 0.9. Lankarani and Nikravesh 1990.
class LankaraniNikravesh final : public DampedHertz {
 public:
  LankaraniNikravesh(const Parameters& p, const ContactPair& pair) : DampedHertz(p, pair, loss::lankarani_nikravesh) {}
};

}  // namespace

Component lankarani_nikravesh() {
  return contact_law<LankaraniNikravesh>(
      {.name = loss::lankarani_nikravesh.name,
       .summary = "Hertz contact with hysteresis damping from a coefficient of restitution.",
       .formula =
           "F_N = max(0, K delta^n (1 + 3(1 - e^2)/4 delta'/v_0)); v_0: approach speed, e: restitution; K as in hertz.",
       .validity =
           "Restitution above about 0.9 and low impact speed; penetration below a tenth of the radial clearance.",
       .references = "Lankarani and Nikravesh 1990, J Mech Des 112, 369-376",
       .parameters = damped_hertz_parameters});
}

}  // namespace freeplay
