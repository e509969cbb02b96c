#include "freeplay/plugin.h"
#include "newmark_step.h"

namespace freeplay {
namespace {

/// Newmark's method (newmark_step.h with alpha_m = alpha_f = 0, so that A = a):
///   v_1 = v_n + h [(1 - gamma) a_n + gamma a_1]      d_1 = h v_n + h^2 [(1/2 - beta) a_n + beta a_1]
/// with velocities v, accelerations a, increment d, step h. beta = 1/4, gamma = 1/2 is the trapezoidal rule. Newmark
/// 1959.
class Newmark final : public NewmarkStep {
 public:
  explicit Newmark(const Parameters& p)
      : NewmarkStep(p, {.alpha_m = 0.0, .alpha_f = 0.0, .beta = p.number("beta"), .gamma = p.number("gamma")}) {}
};

constexpr Parameter newmark_parameters[] = {
    {.name = "beta",
     .default_value = 0.25,
     .minimum = 0.0,
     .maximum = 1.0,
     .open = Open::minimum,
     .summary = "Weight of the acceleration at the end of the step in the position."},
    {.name = "gamma",
     .default_value = 0.5,
     .minimum = 0.5,
     .maximum = 1.0,
     .summary = "Weight of the acceleration at the end of the step in the velocity; above 1/2 it damps."},
    newton_tolerance_parameter,
    newton_iterations_parameter,
};

}  // namespace

Component newmark() {
  return integrator<Newmark>(
      {.name = "newmark",
       .summary = "Newmark's method, implicit, order 2 without damping; the trapezoidal rule by default.",
       .formula = "v_1 = v_n + h ((1 - gamma) a_n + gamma a_1), d_1 = h v_n + h^2 ((1/2 - beta) a_n + beta a_1).",
       .validity = "Stable for every step where 2 beta >= gamma; order 1 for gamma above 1/2. Without damping, stiff "
                   "modes that are excited ring on.",
       .references = "Newmark 1959, J Eng Mech Div 85, 67-94",
       .parameters = newmark_parameters});
}

}  // namespace freeplay
