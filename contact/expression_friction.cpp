#include <algorithm>
#include <cmath>

#include "freeplay/plugin.h"
#include "friction_coefficient.h"

namespace freeplay {
namespace {

/// A coefficient of friction that the model file gives as a formula mu in slip speed v [m/s], with its sign, and normal
/// force F_N [N]:
///   F_T = -mu(v, F_N) F_N
/// What would drive the slip, mu v < 0, counts as zero.
class ExpressionFriction final : public FrictionLaw {
 public:
  explicit ExpressionFriction(const Parameters& p) : coefficient_(p.formula("coefficient")) { require_rest(); }

  FrictionForce evaluate(const FrictionState& state, Span<double>) const override {
    const double at[] = {state.slip_speed, std::max(state.normal_force, smallest_load)};
    double slopes[2];
    const double mu = coefficient_.at(at, slopes);
    if (mu * state.slip_speed < 0.0) return {};
    FrictionForce force = friction_force({mu, slopes[0]}, state);
    force.d_normal -= slopes[1] * state.normal_force;
    return force;
  }

  std::int32_t switches() const override { return coefficient_.switches(); }
  void decide(const FrictionState& state, Span<double> values) const override {
    const double at[] = {state.slip_speed, std::max(state.normal_force, smallest_load)};
    coefficient_.decide(at, values);
  }

 private:
  /// Pressure may stand below a line, and no force is left without a load [N].
  static constexpr double smallest_load = 1e-9;

  void require_rest() const {
    double jump = 0.0;
    for (const double slip : {-1e-14, 0.0, 1e-14}) {
      const double at[] = {slip, 1.0};
      try {
        jump = std::max(jump, std::abs(coefficient_.at(at)));
      } catch (const std::exception&) {
        throw BadParameter("coefficient", "bad-expression", "'coefficient' has no value at vt = 0 and fn = 1 N");
      }
    }
    if (jump <= 1e-6) return;
    throw BadParameter("coefficient", "out-of-range",
                       "'coefficient' must go to zero with vt, and have its sign: a force that jumps at rest has none "
                       "there; write a factor such as tanh(vt/(1 mm/s))");
  }

  Formula coefficient_;
};

constexpr Parameter expression_friction_parameters[] = {
    {.name = "coefficient",
     .kind = ParameterKind::formula,
     .unit = "1",
     .summary = "Coefficient of friction with the sign of the slip; what would drive the slip counts as zero.",
     .variables = "vt: m/s; fn: N"},
};

}  // namespace

Component expression_friction() {
  return friction_law<ExpressionFriction>(
      {.name = "expression",
       .summary = "A coefficient of friction that the model file gives as a formula.",
       .formula = "F_T = -coefficient F_N; the formula is of the slip speed with its sign and of F_N.",
       .validity = "What the formula says; under load the surfaces creep, as the force of rest takes a slip speed.",
       .parameters = expression_friction_parameters});
}

}  // namespace freeplay
