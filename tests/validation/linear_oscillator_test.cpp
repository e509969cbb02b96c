#include "run_model.h"
#include "test_springs.h"

namespace freeplay::test {
namespace {

/// q'' = -omega^2 q - 2 zeta omega q' as a mass on a slider; one step of `h`.
struct Oscillator {
  double omega, zeta, q0, v0, h;
  std::string integrator;

  ModelRun run(double end) const {
    const std::string text =
        "freeplay: 1\nbodies:\n  mass: {mass: 1, inertia: 1}\njoints:\n"
        "  guide: {type: prismatic, between: [ground, mass]}\n"
        "  spring: {type: axial-spring, between: [ground, mass], stiffness: " +
        number(omega * omega) + ", damping: " + number(2.0 * zeta * omega) +
        "}\n"
        "initial: {joints: {guide: " +
        number(q0) + "}, speeds: {guide: " + number(v0) +
        "}}\n"
        "simulation: {end: " +
        number(end) + ", step: " + number(h) + ", integrator: {type: bathe" + integrator +
        ", newton: {tolerance: 1e-14}}, output: {interval: " + number(h) + "}}\n";
    return ModelRun(text, {}, {}, types_with_springs());
  }
};

// Matrix recursion of the method in double precision, one step from consistent initial values.
TEST(LinearOscillator, OneStepEqualsTheRecursionOfTheMethod) {
  const struct {
    Oscillator model;
    double q, v, a;
  } cases[] = {
      {{1.0, 0.0, 1.0, 0.0, 0.1, ""}, 0.995007975731039, -0.0997919585497688, -0.99500797573104},
      {{1.0, 0.0, 1.0, 0.0, 0.1, ", split: optimal"}, 0.995007832947154, -0.0997931746341209, -0.99500783294715},
      {{1.0, 0.0, 1.0, 0.0, 0.1, ", split: optimal, rho_inf: 0.5"},
       0.995006914583094,
       -0.0998040774626316,
       -0.99500691458309},
      {{1.0, 0.0, 1.0, 0.0, 0.1, ", rho_inf: 1"}, 0.995006244145504, -0.0998126951417388, -0.9950062441455},
      {{3.0, 0.05, 0.2, -1.0, 0.25, ""}, -0.0653050791135196, -1.07246747271287, 0.90948595383554},
      {{3.0, 0.05, 0.2, -1.0, 0.25, ", split: optimal"}, -0.0654598830376207, -1.07222060395382, 0.91080512852473},
      {{3.0, 0.05, 0.2, -1.0, 0.25, ", split: optimal, rho_inf: 0.5"},
       -0.0670238891769333,
       -1.07098259574874,
       0.92450978131702},
      {{3.0, 0.05, 0.2, -1.0, 0.25, ", rho_inf: 1"}, -0.0682842794349492, -1.07016151766045, 0.93560697021268}};
  double worst = 0.0;
  for (const auto& c : cases) {
    const ModelRun run = c.model.run(c.model.h);
    ASSERT_EQ(run.outcome().steps, 1);
    const double q = run.last("body.mass.x"), v = run.last("body.mass.vx"), a = run.last("joint.spring.fx");
    worst = std::max({worst, std::abs(q - c.q), std::abs(v - c.v), std::abs(a - c.a)});
    EXPECT_NEAR(q, c.q, 1e-13) << c.model.integrator;
    EXPECT_NEAR(v, c.v, 1e-13) << c.model.integrator;
    EXPECT_NEAR(a, c.a, 1e-13) << c.model.integrator;
  }
  record("worst_difference", worst);
}

// abs(R) in 34 digits: the 2 x 2 matrix of a step of the undamped oscillator has the determinant abs(R)^2.
TEST(LinearOscillator, SpectralRadiusOfLongStepsEqualsTheClosedForm) {
  const struct {
    const char* integrator;
    double steps_of_period, radius;
  } cases[] = {{"", 0.1, 0.999493934337159},
               {"", 1.0, 0.64846636770808},
               {"", 10.0, 0.0793841811474615},
               {", split: optimal", 0.1, 0.999463321935721},
               {", split: optimal", 1.0, 0.635575314210254},
               {", split: optimal", 10.0, 0.076677104507046},
               {", split: optimal, rho_inf: 0.5", 0.1, 0.999715065263},
               {", split: optimal, rho_inf: 0.5", 1.0, 0.768233340145411},
               {", split: optimal, rho_inf: 0.5", 10.0, 0.505236783761441},
               {", rho_inf: 1", 1.0, 1.0},
               {", rho_inf: 1", 10.0, 1.0}};
  double worst = 0.0;
  for (const auto& c : cases) {
    const double h = 2.0 * M_PI * c.steps_of_period;
    double column[2][2];
    for (int i = 0; i < 2; ++i) {
      const Oscillator model{1.0, 0.0, i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, h, c.integrator};
      const ModelRun run = model.run(h);
      ASSERT_EQ(run.outcome().steps, 1);
      column[i][0] = run.last("body.mass.x");
      column[i][1] = run.last("body.mass.vx");
    }
    const double radius = std::sqrt(column[0][0] * column[1][1] - column[0][1] * column[1][0]);
    worst = std::max(worst, std::abs(radius - c.radius));
    EXPECT_NEAR(radius, c.radius, 1e-12) << c.integrator << " at h/T = " << c.steps_of_period;
  }
  record("worst_difference", worst);
}

}  // namespace
}  // namespace freeplay::test
