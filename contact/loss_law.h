// Loss factors: how the laws of continuous impact turn a coefficient of restitution into damping.
#pragma once

#include <cmath>

#include "freeplay/contact_law.h"

namespace freeplay {

/// The loss factor chi(e) of a law F_N = F_s(delta) (1 + chi delta'/v_0), for a restitution 0 < e <= 1. A mass that
/// falls on a fixed surface leaves it with the share s of its speed, whatever F_s: chi (1 + s) = ln[(1 + chi)/(1 - chi
/// s)]. Each law meets s = e only in its range.
struct LossLaw {
  const char* name;
  double (*factor)(double restitution);  ///< chi
  double lowest_restitution;             ///< end of the range; 0 without one
  const char* outside;                   ///< sentence for a restitution below
};

namespace loss {
inline constexpr LossLaw hunt_crossley{
    "hunt-crossley", [](double e) { return 1.5 * (1.0 - e); }, 0.9,
    "The law of Hunt and Crossley rebounds faster than asked for a restitution below 0.9."};
inline constexpr LossLaw herbert_mcwhannell{
    "herbert-mcwhannell", [](double e) { return 6.0 * (1.0 - e) / ((2.0 * e - 1.0) * (2.0 * e - 1.0) + 3.0); }, 0.5,
    "The law of Herbert and McWhannell rebounds faster than asked for a restitution below 0.5."};
inline constexpr LossLaw lee_wang{"lee-wang", [](double e) { return 0.75 * (1.0 - e); }, 0.9,
                                  "The law of Lee and Wang rebounds faster than asked for a restitution below 0.9."};
inline constexpr LossLaw lankarani_nikravesh{
    "lankarani-nikravesh", [](double e) { return 0.75 * (1.0 - e * e); }, 0.9,
    "The law of Lankarani and Nikravesh rebounds faster than asked for a restitution below 0.9."};
inline constexpr LossLaw gonthier{"gonthier", [](double e) { return (1.0 - e * e) / e; }, 0.0, nullptr};
inline constexpr LossLaw flores{"flores", [](double e) { return 8.0 * (1.0 - e) / (5.0 * e); }, 0.0, nullptr};
inline constexpr LossLaw hu_guo{"hu-guo", [](double e) { return 1.5 * (1.0 - e) / e; }, 0.0, nullptr};
inline constexpr LossLaw zhiying_qishao{
    "zhiying-qishao", [](double e) { return 0.75 * (1.0 - e * e) * std::exp(2.0 * (1.0 - e)); }, 0.4,
    "The law of Zhiying and Qishao rebounds faster than asked for a restitution below 0.4."};
}  // namespace loss

inline constexpr Parameter restitution_parameter{.name = "restitution",
                                                 .minimum = 0.0,
                                                 .maximum = 1.0,
                                                 .open = Open::minimum,
                                                 .summary = "Coefficient of restitution."};

/// The elastic part of a law at a penetration.
struct ElasticForce {
  double force;      ///< F_s [N]
  double slope;      ///< dF_s/ddelta [N/m]
  double potential;  ///< integral of F_s from 0 [J]
};

/// F_N = max(0, F_s (1 + chi delta'/v_0)). v_0 is the approach speed; v_0 = 0 leaves the elastic part.
inline ContactForce with_loss(const ElasticForce& elastic, double chi, const ContactState& state) {
  const double damping = state.approach_speed > 0.0 ? chi / state.approach_speed : 0.0;
  const double factor = 1.0 + damping * state.rate;
  if (factor <= 0.0) return {0.0, 0.0, 0.0, elastic.potential, elastic.force};
  return {elastic.force * factor, elastic.slope * factor, elastic.force * damping, elastic.potential, elastic.force};
}

}  // namespace freeplay
