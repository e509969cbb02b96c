#include "damped_hertz.h"
#include "freeplay/plugin.h"

namespace freeplay {
namespace {

/// Hertz contact with hysteresis damping:
///   F_N = max(0, K delta^n (1 + chi delta'/v_0)),  chi = 6(1 - e)/((2e - 1)^2 + 3)
/// with penetration delta [m] and its rate delta' [m/s], approach speed v_0 [m/s], restitution e, K [N/m^n].
/// The rebound is close to e for e above about 0.5. Herbert and McWhannell 1977.
class HerbertMcwhannell final : public DampedHertz {
 public:
  HerbertMcwhannell(const Parameters& p, const ContactPair& pair) : DampedHertz(p, pair, loss::herbert_mcwhannell) {}
};

}  // namespace

Component herbert_mcwhannell() {
  return contact_law<HerbertMcwhannell>(
      {.name = loss::herbert_mcwhannell.name,
       .summary = "Hertz contact with hysteresis damping, for a restitution above one half.",
       .formula = "F_N = max(0, K delta^n (1 + 6(1 - e)/((2e - 1)^2 + 3) delta'/v_0)); v_0: approach speed, e: "
                  "restitution; K as in hertz.",
       .validity = "Restitution above about 0.5; penetration below a tenth of the radial clearance.",
       .references = "Herbert and McWhannell 1977, J Eng Ind 99",
       .parameters = damped_hertz_parameters});
}

}  // namespace freeplay
