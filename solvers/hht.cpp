#include "freeplay/plugin.h"
#include "newmark_step.h"

namespace freeplay {
namespace {

/// HHT-alpha: the balance M A_1 + (1 + alpha)(Phi_q^T lambda - f)_1 - alpha (Phi_q^T lambda - f)_n = 0 with Newmark's
/// rule for A. With a = M^-1 (f - Phi_q^T lambda) it is
///   A_1 = (1 + alpha) a_1 - alpha a_n,  gamma = 1/2 - alpha,  beta = (1 - alpha)^2/4
/// which is newmark_step.h with alpha_m = 0, alpha_f = -alpha; for a mass matrix M that changes, this form is the one
/// used. Accelerations a, A, step h, alpha in [-1/3, 0]; 0 is the trapezoidal rule. Hilber, Hughes and Taylor 1977.
class Hht final : public NewmarkStep {
 public:
  explicit Hht(const Parameters& p) : NewmarkStep(p, weights(p.number("alpha"))) {}

 private:
  static NewmarkWeights weights(double alpha) {
    return {.alpha_m = 0.0, .alpha_f = -alpha, .beta = 0.25 * (1.0 - alpha) * (1.0 - alpha), .gamma = 0.5 - alpha};
  }
};

constexpr Parameter hht_parameters[] = {
    {.name = "alpha",
     .default_value = -0.05,
     .minimum = -1.0 / 3.0,
     .maximum = 0.0,
     .summary = "Weight of the forces at the start of the step, negative; -1/3 damps most, 0 not at all."},
    newton_tolerance_parameter,
    newton_iterations_parameter,
};

}  // namespace

Component hht() {
  return integrator<Hht>(
      {.name = "hht",
       .summary = "HHT-alpha method, implicit, order 2, damps high frequencies.",
       .formula = "v_1 = v_n + h ((1 - gamma) A_n + gamma A_1), d_1 = h v_n + h^2 ((1/2 - beta) A_n + beta A_1), A_1 = "
                  "(1 + alpha) a_1 - alpha a_n; gamma = 1/2 - alpha, beta = (1 - alpha)^2/4.",
       .validity =
           "Stable for every step in linear problems. Below alpha = 0 disturbances of the multipliers decay; at 0 it "
           "is the trapezoidal rule, and they alternate.",
       .references =
           "Hilber, Hughes and Taylor 1977, Earthq Eng Struct Dyn 5, 283-292; Arnold and Bruls 2007, Multibody "
           "Syst Dyn 18, 185-202",
       .parameters = hht_parameters});
}

}  // namespace freeplay
