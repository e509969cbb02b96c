#include "damped_hertz.h"
#include "freeplay/plugin.h"

namespace freeplay {
namespace {

/// Hertz contact with hysteresis damping:
///   F_N = max(0, K delta^n (1 + chi delta'/v_0)),  chi = 3(1 - e^2)/4 exp(2(1 - e))
/// with penetration delta [m] and its rate delta' [m/s], approach speed v_0 [m/s], restitution e, K [N/m^n].
/// The rebound is close to e for e above about 0.4. Zhiying and Qishao 2006.
class ZhiyingQishao final : public DampedHertz {
 public:
  ZhiyingQishao(const Parameters& p, const ContactPair& pair) : DampedHertz(p, pair, loss::zhiying_qishao) {}
};

}  // namespace

Component zhiying_qishao() {
  return contact_law<ZhiyingQishao>(
      {.name = loss::zhiying_qishao.name,
       .summary = "Hertz contact with hysteresis damping, that of Lankarani and Nikravesh with a larger loss.",
       .formula = "F_N = max(0, K delta^n (1 + 3(1 - e^2)/4 exp(2(1 - e)) delta'/v_0)); v_0: approach speed, e: "
                  "restitution; K as in hertz.",
       .validity = "Restitution above about 0.4; penetration below a tenth of the radial clearance.",
       .references = "Zhiying and Qishao 2006, J Dyn Control 4",
       .parameters = damped_hertz_parameters});
}

}  // namespace freeplay
