#include "freeplay/plugin.h"
#include "newmark_step.h"

namespace freeplay {
namespace {

/// Generalized-alpha method: newmark_step.h with
///   (1 - alpha_m) A_1 + alpha_m A_n = (1 - alpha_f) a_1 + alpha_f a_n
///   alpha_m = (2 rho - 1)/(rho + 1)                alpha_f = rho/(rho + 1)
///   gamma = 1/2 - alpha_m + alpha_f                beta = (1 - alpha_m + alpha_f)^2/4
/// with accelerations a, auxiliary accelerations A, and the spectral radius rho for steps without bound; rho = 1 does
/// not damp. Chung and Hulbert 1993; Arnold and Bruls 2007.
class GeneralizedAlpha final : public NewmarkStep {
 public:
  explicit GeneralizedAlpha(const Parameters& p) : NewmarkStep(p, weights(p.number("rho_inf"))) {}

 private:
  static NewmarkWeights weights(double rho) {
    const double alpha_m = (2.0 * rho - 1.0) / (rho + 1.0), alpha_f = rho / (rho + 1.0), sum = 1.0 - alpha_m + alpha_f;
    return {.alpha_m = alpha_m, .alpha_f = alpha_f, .beta = 0.25 * sum * sum, .gamma = sum - 0.5};
  }
};

constexpr Parameter generalized_alpha_parameters[] = {
    {.name = "rho_inf",
     .default_value = 0.8,
     .minimum = 0.0,
     .maximum = 1.0,
     .summary = "Spectral radius for large steps: 0 damps high frequencies most, 1 not at all."},
    newton_tolerance_parameter,
    newton_iterations_parameter,
};

}  // namespace

Component generalized_alpha() {
  return integrator<GeneralizedAlpha>(
      {.name = "generalized-alpha",
       .summary = "Generalized-alpha method, implicit, order 2, damps high frequencies as asked.",
       .formula = "v_1 = v_n + h ((1 - gamma) A_n + gamma A_1), d_1 = h v_n + h^2 ((1/2 - beta) A_n + beta A_1), (1 - "
                  "am) A_1 + am A_n = (1 - af) a_1 + af a_n; am = (2 rho - 1)/(rho + 1), af = rho/(rho + 1), gamma = "
                  "1/2 - am + af, beta = (1 - am + af)^2/4.",
       .validity =
           "Stable for every step in linear problems. Below rho_inf = 1 disturbances of the multipliers decay; at 1 "
           "nothing is damped, and they alternate.",
       .references = "Chung and Hulbert 1993, J Appl Mech 60, 371-375; Arnold and Bruls 2007, Multibody Syst Dyn 18, "
                     "185-202",
       .parameters = generalized_alpha_parameters});
}

}  // namespace freeplay
