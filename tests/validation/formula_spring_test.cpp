// Springs and dampers that formulas give: closed forms, order, energy, and what they copy.
#include <fmt/format.h>

#include "run_model.h"

namespace freeplay::test::formula_spring {
namespace {

/// A mass of 2 kg on a rail along x, tied to the ground by a spring that is slack at 1 m.
std::string sled(const std::string& keys, double stretch, double v, const std::string& simulation) {
  return "freeplay: 1\n"
         "bodies: {sled: {mass: 2, inertia: 1}}\n"
         "joints: {rail: {type: prismatic, between: [ground, sled]}}\n"
         "forces: {tie: {type: spring-damper, between: [ground, sled], free_length: 1 m, " +
         keys + "}}\ninitial: {joints: {rail: " + number(1.0 + stretch) + "}, speeds: {rail: " + number(v) +
         "}}\nsimulation: {" + simulation + "}\n";
}

constexpr const char* progressive = "spring: \"(50 N/m + 10 N/m^2*abs(x))*x\"";
constexpr double amplitude = 0.8, mass = 2.0;

double stored(double x) { return 25.0 * x * x + 10.0 / 3.0 * x * x * std::abs(x); }

/// From A to -A and back takes four times the integral of 1/v: with x = A sin(p) it is smooth.
double period() {
  const auto integrand = [&](double p) {
    const double c = amplitude * std::cos(p), left = stored(amplitude) - stored(amplitude * std::sin(p));
    return std::sqrt(c * c > 1e-7 ? mass * c * c / 2.0 / left : mass / (50.0 + 10.0 * amplitude));
  };
  double quarter = 0.0;
  const int panels = 2000;
  for (int i = 0; i < panels; ++i) {
    const double h = 0.5 * M_PI / panels, p = i * h;
    quarter += h / 6.0 * (integrand(p) + 4.0 * integrand(p + 0.5 * h) + integrand(p + h));
  }
  return 4.0 * quarter;
}

TEST(FormulaSpring, ThatGrowsStifferHasItsPeriodAndKeepsItsEnergy) {
  for (const char* integrator : {"bathe", "dopri5", "verner7"}) {
    const ModelRun run(
        sled(progressive, amplitude, 0.0,
             "end: " + number(period()) + ", accuracy: 1e-9, integrator: " + integrator + ", output: {interval: 0.1}"));
    ASSERT_EQ(run.outcome().exit_code, 0) << run.outcome().reason;
    EXPECT_NEAR(run.at(0, "energy.potential"), stored(amplitude), 1e-10 * stored(amplitude));
    EXPECT_NEAR(run.last("joint.rail.position"), 1.0 + amplitude, 1e-8) << integrator;
    EXPECT_NEAR(run.last("joint.rail.speed"), 0.0, 1e-7) << integrator;
    EXPECT_NEAR(run.last("energy.residual"), 0.0, 1e-8) << integrator;
    EXPECT_EQ(run.last("energy.work"), 0.0) << integrator;
    for (std::size_t row = 0; row < run.rows(); ++row) {
      const double x = run.at(row, "joint.rail.position") - 1.0;
      EXPECT_NEAR(run.at(row, "force.tie.fx"), -(50.0 + 10.0 * std::abs(x)) * x, 1e-10);
      EXPECT_NEAR(run.at(row, "energy.potential"), stored(x), 1e-9);
    }
  }
}

class FormulaSpringOrder : public ::testing::TestWithParam<const char*> {};
TEST_P(FormulaSpringOrder, IsThatOfTheMethod) {
  std::vector<double> errors;
  for (double step = 0.01; errors.size() < 3; step *= 0.5) {
    const ModelRun run(sled(progressive, amplitude, 0.0,
                            "end: " + number(period()) + ", step: " + number(step) + ", integrator: " + GetParam() +
                                ", output: {interval: " + number(period()) + "}"));
    ASSERT_EQ(run.outcome().exit_code, 0) << run.outcome().reason;
    errors.push_back(std::hypot(run.last("joint.rail.position") - 1.0 - amplitude, run.last("joint.rail.speed")));
  }
  record("error", errors[2]);
  EXPECT_GE(order(errors[1], errors[2]), 1.9);
}
INSTANTIATE_TEST_SUITE_P(Methods, FormulaSpringOrder,
                         ::testing::Values("bathe", "newmark", "hht", "generalized-alpha"));

// 0.2 J within 8 mm of the way, of 1 J.
TEST(FormulaSpring, StoresWhatActsInASmallPartOfItsWay) {
  const ModelRun run(
      sled("spring: {interpolation: linear, points: [[0, 0], [0.4237, 0], [0.4277, 50], [0.4317, 0], [2, 0]]}", 0.0,
           1.0, "end: 1, step: 0.1 ms, output: {interval: 0.1}"));
  EXPECT_NEAR(run.last("energy.potential"), 0.2, 1e-9);
  EXPECT_NEAR(run.last("joint.rail.speed"), std::sqrt(0.8), 1e-4);
  EXPECT_NEAR(run.last("energy.residual"), 0.0, 1e-4);
}

// Tents: the place of their top is where a difference passes zero, the ends of their sides are not.
TEST(FormulaSpring, StoresTheAreaBelowATentOfAnyWidth) {
  for (const double width : {0.3, 0.1, 1e-2, 1e-4, 1e-6}) {
    const double top = 0.2 / width;
    const ModelRun run(sled(fmt::format("spring: \"max(0 N, {} N - {} N/m*abs(x - 0.4237 m))\"", top, top / width), 0.0,
                            1.0, "end: 1, accuracy: 1e-7, output: {interval: 0.1}"));
    ASSERT_EQ(run.outcome().exit_code, 0) << run.outcome().reason;
    EXPECT_NEAR(run.last("energy.potential"), 0.2, 1e-10) << width;
    EXPECT_NEAR(run.last("joint.rail.speed"), std::sqrt(0.8), 1e-6) << width;
  }
}

// The same as a bump that is smooth, or has corners, along steps that are as long as the motion beside it lets them be.
TEST(FormulaSpring, ABumpIsMetAndItsEnergyStoredHoweverNarrowItIs) {
  for (const double width : {1e-2, 1e-3, 1e-4, 1e-5}) {
    const std::string force = number(0.2 / (width * std::sqrt(std::numbers::pi)));
    const std::string smooth = "spring: \"" + force + " N*exp(-((x - 0.4237 m)/(" + number(width) + " m))^2)\"";
    const std::string corners = "spring: {interpolation: linear, points: [[0, 0], [" + number(0.4237 - width) +
                                ", 0], [0.4237, " + number(0.2 / width) + "], [" + number(0.4237 + width) +
                                ", 0], [2, 0]]}";
    for (const std::string& spring : {smooth, corners}) {
      for (const double accuracy : {1e-4, 1e-6, 1e-8}) {
        const ModelRun run(
            sled(spring, 0.0, 1.0, "end: 1, accuracy: " + number(accuracy) + ", output: {interval: 0.1}"));
        ASSERT_EQ(run.outcome().exit_code, 0) << run.outcome().reason;
        EXPECT_NEAR(run.last("joint.rail.speed"), std::sqrt(0.8), 10.0 * accuracy) << spring;
        // What is smooth is integrated where it is wider than a 256th of its doubling.
        if (spring == corners || width >= 1e-3) {
          EXPECT_NEAR(run.last("energy.potential"), 0.2, 1e-9) << spring;
        }
      }
    }
  }
}

// The angle of a dial counts over turns: 0.2 N m exp(-((x - a)/0.02)^2) takes 0.004 sqrt(pi) J of 0.5 0.01 10^2 J.
// The cogging of a motor over sixteen turns, and the poles of a linear one.
TEST(FormulaSpring, OfManyPeriodsStoresWhatTheyAddUpTo) {
  const double speed = 100.0, torque = 0.5;
  for (const double periods : {8.0, 36.0, 72.0}) {
    const ModelRun run(
        "freeplay: 1\nbodies: {rotor: {mass: 1, inertia: 0.01}}\n"
        "joints: {hub: {type: revolute, between: [ground, rotor]}}\n"
        "forces: {cog: {type: spring-damper, kind: rotational, between: [ground, rotor], spring: \"" +
        number(torque) + " N*m*sin(" + number(periods) + "*x)\"}}\ninitial: {speeds: {hub: " + number(speed) +
        "}}\nsimulation: {end: 1, accuracy: 1e-6, output: {interval: 0.01}}\n");
    for (std::size_t row = 0; row < run.rows(); ++row) {
      const double angle = run.at(row, "joint.hub.angle");
      EXPECT_NEAR(run.at(row, "energy.potential"), torque / periods * (1.0 - std::cos(periods * angle)), 1e-9);
    }
  }
  const ModelRun run(sled("spring: \"50 N*sin(2*pi*x/(5 mm))\"", 0.0, 10.0, "end: 0.3, accuracy: 1e-6"));
  const double wave = 2.0 * M_PI / 5e-3;
  for (std::size_t row = 0; row < run.rows(); ++row) {
    const double way = run.at(row, "joint.rail.position") - 1.0;
    EXPECT_NEAR(run.at(row, "energy.potential"), 50.0 / wave * (1.0 - std::cos(wave * way)), 1e-8);
  }
}

// A product of functions that fade out is a rounding below zero at its end.
TEST(FormulaSpring, ADampingThatFadesOutIsNotDoubted) {
  const ModelRun run(sled("damping: \"60 N*s/m*smooth(t, 0.12 s, 0.13 s)*(1 - smooth(t, 0.13 s, 0.14 s))\"", 0.0, 1.0,
                          "end: 0.3, accuracy: 1e-6"));
  EXPECT_EQ(run.outcome().doubts.size(), 0U);
  const ModelRun negative(
      sled("damping: \"-1e-3 N*s/m*smooth(t, 0.12 s, 0.13 s)\"", 0.0, 1.0, "end: 0.3, accuracy: 1e-6"));
  EXPECT_EQ(negative.outcome().doubts.size(), 1U);
}

TEST(FormulaSpring, ABumpOfATurnIsMetInFewSteps) {
  for (const char* place : {"1", "7"}) {
    for (const char* integrator : {"dopri5", "verner7", "bathe"}) {
      const ModelRun run(fmt::format(
          "freeplay: 1\nbodies: {{dial: {{mass: 1, inertia: 0.01}}}}\n"
          "joints: {{pin: {{type: revolute, between: [ground, dial]}}}}\ninitial: {{speeds: {{pin: 10}}}}\n"
          "forces: {{cog: {{type: spring-damper, kind: rotational, between: [ground, dial], "
          "spring: \"0.2 N*m*exp(-((x - {})/0.02)^2)\"}}}}\nsimulation: {{end: 1, accuracy: 1e-5, integrator: {}}}\n",
          place, integrator));
      ASSERT_EQ(run.outcome().exit_code, 0) << run.outcome().reason;
      EXPECT_LT(run.outcome().steps, 300) << integrator;
      EXPECT_NEAR(run.last("joint.pin.speed"), std::sqrt(100.0 - 0.8 * std::sqrt(std::numbers::pi)), 1e-4)
          << integrator;
    }
  }
}

// In steps of 1 ms and about 1 mm: what lies between the ends of two steps alone, and what several of them show.
TEST(FormulaSpring, StepsOfOneSizeThatGoOverAPartOfItAreDoubted) {
  const auto doubted = [](const std::string& keys, const char* integrator = "bathe") {
    const ModelRun run(sled(
        keys, 0.0, 1.0, "end: 0.6, step: 1 ms, integrator: " + std::string(integrator) + ", output: {interval: 0.1}"));
    EXPECT_EQ(run.outcome().exit_code, 0) << run.outcome().reason;
    const auto& doubts = run.outcome().doubts;
    const auto doubt = std::ranges::find(doubts, "unresolved-input", &TrustReason::id);
    return doubt == doubts.end() ? std::string() : doubt->message;
  };
  const auto bump = [](const char* place, const char* width) {
    return fmt::format("spring: \"20 N/m*x + 200 N*exp(-((x - {} m)/({} m))^2)\"", place, width);
  };
  const auto peak = [](double width) {
    return fmt::format("spring: {{interpolation: linear, points: [[0, 0], [{}, 5], [0.30023, 200], [{}, 5], [2, 40]]}}",
                       0.30023 - width, 0.30023 + width);
  };
  for (const char* integrator : {"bathe", "newmark", "generalized-alpha"}) {
    const std::string words = doubted(bump("0.30023", "2e-5"), integrator);
    EXPECT_TRUE(words.starts_with("force 'tie' changes with the motion at t = 0.3")) << integrator << ": " << words;
  }
  EXPECT_NE(doubted(bump("0.30023", "2e-8")), "");
  // Flat where it is not.
  EXPECT_NE(doubted("spring: \"20 N*(smooth(x, 0.3002, 0.3004) - smooth(x, 0.3004, 0.3006))\""), "");
  EXPECT_NE(doubted(peak(1e-4)), "");
  EXPECT_NE(doubted("damper: \"0.1 N*s/m*v + 50 N*exp(-((v - 0.9801 m/s)/(1e-6 m/s))^2)\", stiffness: 2"), "");
  EXPECT_EQ(doubted(bump("0.3", "2e-2")), "");
  EXPECT_EQ(doubted(peak(5e-2)), "");
  EXPECT_EQ(doubted(progressive), "");
  EXPECT_EQ(doubted("spring: \"20 N/m*x\", damper: \"3 N*s^2/m^2*v*abs(v)\""), "");
}

// A staircase of thirty steps of 0.1 N, 10 mm apart: at x beyond them it has taken 0.1 (30 x - 0.01 (1 + ... + 30)) J.
TEST(FormulaSpring, AStaircaseOfManyStepsTakesItsEnergyInFewSteps) {
  std::string stairs = "spring: \"0 N";
  for (int i = 1; i <= 30; ++i) stairs += " + if(x > " + number(0.01 * i) + " m, 0.1 N, 0 N)";
  const ModelRun run(sled(stairs + "\"", 0.0, 1.0, "end: 0.5, accuracy: 1e-7, output: {interval: 0.1}"));
  ASSERT_EQ(run.outcome().exit_code, 0) << run.outcome().reason;
  EXPECT_LT(run.outcome().steps, 3000);
  const double x = run.last("joint.rail.position") - 1.0, v = run.last("joint.rail.speed");
  ASSERT_GT(x, 0.3);
  EXPECT_NEAR(v * v, 1.0 - (3.0 * x - 0.1 * 0.01 * 30 * 31 / 2), 1e-6);
}

// 2 v' = -3 v |v| from 4 m/s: v = 4/(1 + 6 t).
TEST(FormulaSpring, ADamperMayBeQuadratic) {
  const ModelRun run(
      sled("damper: \"3 N*s^2/m^2*v*abs(v)\"", 0.0, 4.0, "end: 0.5, accuracy: 1e-8, output: {interval: 0.1}"));
  ASSERT_EQ(run.outcome().exit_code, 0) << run.outcome().reason;
  const double v = 4.0 / (1.0 + 6.0 * 0.5);
  EXPECT_NEAR(run.last("joint.rail.speed"), v, 1e-7);
  EXPECT_NEAR(run.last("joint.rail.position"), 1.0 + std::log(4.0) / 1.5, 1e-8);
  EXPECT_NEAR(run.last("energy.dissipated"), 16.0 - v * v, 1e-6);
  EXPECT_NEAR(run.last("energy.residual"), 0.0, 1e-6);
}

/// Both ways to write a linear spring: the columns of both runs agree to rounding.
void expect_same(const std::string& text, const std::string& keys, const std::string& formulas) {
  const ModelRun one(replaced(text, "KEYS", formulas)), other(replaced(text, "KEYS", keys));
  ASSERT_EQ(one.outcome().exit_code, 0) << one.outcome().reason;
  ASSERT_EQ(one.rows(), other.rows());
  for (const std::string& name : one.kept().names()) {
    if (name == "energy.residual") continue;
    for (std::size_t row = 0; row < one.rows(); ++row) {
      EXPECT_NEAR(one.at(row, name), other.at(row, name), 1e-9 * (1.0 + std::abs(other.at(row, name)))) << name;
    }
  }
}

TEST(FormulaSpring, LinearOnesAreThoseOfTheNumbers) {
  expect_same(sled("KEYS", 0.3, -1.0, "end: 1, step: 5 ms, output: {interval: 0.1}"),
              "stiffness: 500, damping: 7, preload: 4", "spring: \"500 N/m*x + 4 N\", damper: \"7 N*s/m*v\"");
  const std::string turning =
      "freeplay: 1\nSPACEgravity: GRAVITY\nbodies: {rod: {mass: 2, inertia: INERTIA, com: [0.4, 0ZERO]}}\n"
      "joints: {pin: {type: revolute, between: [ground, rod]}}\n"
      "forces: {coil: {type: spring-damper, between: [ground, rod], kind: rotational, free_angle: 20 deg, KEYS}}\n"
      "simulation: {end: 1, step: 5 ms, output: {interval: 0.1}}\n";
  const char *keys = "stiffness: 30, damping: 0.5", *formulas = "spring: \"30 N*m*x\", damper: \"0.5 N*m*s*v\"";
  const auto in = [&](const std::string& space, const std::string& gravity, const std::string& inertia,
                      const std::string& zero) {
    return replaced(replaced(replaced(replaced(turning, "SPACE", space), "GRAVITY", gravity), "INERTIA", inertia),
                    "ZERO", zero);
  };
  expect_same(in("", "[0, -9.81]", "0.1", ""), keys, formulas);
  expect_same(in("space: spatial\n", "[0, -9.81, 0]", "[0.1, 0.1, 0.1]", ", 0"), keys, formulas);
  expect_same(
      "freeplay: 1\nspace: spatial\ngravity: [0, 0, -9.81]\nbodies: {bob: {mass: 2, inertia: [0.1, 0.1, 0.1],"
      " pose: {position: [0.3, 0.1, -0.8]}, velocity: {linear: [0, 0.5, 0]}}}\n"
      "forces: {tie: {type: spring-damper, between: [ground, bob], free_length: 0.7, KEYS}}\n"
      "simulation: {end: 1, step: 5 ms, output: {interval: 0.1}}\n",
      "stiffness: 200, damping: 3", "spring: \"200 N/m*x\", damper: \"3 N*s/m*v\"");
}

}  // namespace
}  // namespace freeplay::test::formula_spring
