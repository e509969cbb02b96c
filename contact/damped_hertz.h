// Hertz contact with a loss factor: what the laws of continuous impact have in common.
#pragma once

#include "hertz_stiffness.h"

namespace freeplay {

inline constexpr Parameter damped_hertz_parameters[] = {stiffness_parameter, exponent_parameter, restitution_parameter};

/// F_N = max(0, K delta^n (1 + chi delta'/v_0)) with the chi of a loss law; a law is this and the name of its chi.
class DampedHertz : public ContactLaw {
 public:
  ContactForce evaluate(const ContactState& state) const final { return spring_.force(state, chi_); }
  const char* outside_range(const ContactState& state) const final {
    return outside_ != nullptr ? outside_ : spring_.outside_range(state);
  }

 protected:
  /// Reads K, exponent and restitution. Throws what HertzSpring throws.
  DampedHertz(const Parameters& p, const ContactPair& pair, const LossLaw& law) : spring_(p, pair) {
    const double restitution = p.number("restitution");
    chi_ = law.factor(restitution);
    if (restitution < law.lowest_restitution) outside_ = law.outside;
  }

 private:
  HertzSpring spring_;
  double chi_;
  const char* outside_ = nullptr;
};

}  // namespace freeplay
