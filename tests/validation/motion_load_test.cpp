// Runs with error control go over no load that acts in a small part of the way, however it is written.
#include <random>

#include <fmt/format.h>

#include "run_model.h"

namespace freeplay::test {
namespace {

/// A mass of 1 kg on a guide along x that starts at 0 with 1 m/s.
std::string sled(const std::string& force, const std::string& simulation) {
  return "freeplay: 1\n"
         "bodies: {m: {mass: 1, inertia: 1}}\n"
         "joints: {guide: {type: prismatic, between: [ground, m]}}\n"
         "forces: {push: {type: force, at: m, value: ['" +
         force +
         "', 0]}}\n"
         "initial: {joints: {guide: 0}, speeds: {guide: 1}}\n"
         "simulation: {end: 2 s, " +
         simulation + "}\n";
}

/// A wheel of 1 kg m^2 that starts with 1 rad/s.
std::string wheel(const std::string& torque, const std::string& simulation) {
  return "freeplay: 1\n"
         "bodies: {m: {mass: 1, inertia: 1, frames: {rim: [1 m, 0]}}}\n"
         "joints: {guide: {type: revolute, between: [ground, m]}}\n"
         "forces: {push: {type: torque, on: m, value: '" +
         torque +
         "'}}\n"
         "initial: {joints: {guide: 0}, speeds: {guide: 1}}\n"
         "simulation: {end: 2 s, " +
         simulation + "}\n";
}

struct Bump {
  const char* form;  ///< of height 1, {u} being (x - c)/w
  double area;       ///< by w
};
const Bump bumps[] = {{"exp(-({u})^2)", std::sqrt(M_PI)},
                      {"smooth({u}, -1, 0)*(1 - smooth({u}, 0, 1))", 1.0},
                      {"1/(1 + ({u})^8)", M_PI / 4.0 / std::sin(M_PI / 8.0)},
                      {"if(({u})^2 < 1, 1, 0)", 2.0},
                      {"max(0, 1 - ({u})^2)", 4.0 / 3.0},
                      {"max(0, 1 - abs({u}))", 1.0},
                      {"sqrt(max(0, 1 - ({u})^2))", M_PI / 2.0},
                      {"if(abs({u}) < 4, max(0, cos({u})), 0)", 2.0}};

/// Of time alone, and 1 where bumps are met.
const char* const factors[] = {"", "*if(t > 0.1, 1, 0)", "*min(1, abs(t)/0.1)", "*max(0, sign(t - 0.1))"};

std::string written(const Bump& bump, double height, double centre, double width, bool turns) {
  const std::string u = turns ? fmt::format("(joint.guide.angle - {:.17g})/{:.17g}", centre, width)
                              : fmt::format("(body.m.x - {:.17g})/({:.17g} m)", centre, width);
  return fmt::format("{:.17g} {}*", height, turns ? "N*m" : "N") + replaced(bump.form, "{u}", u);
}

// Half a joule on the way makes sqrt(2) m/s of 1 m/s.
TEST(MotionLoad, ABumpOfTheWayIsMetHoweverNarrowItIs) {
  std::mt19937 draw(1);
  const auto uniform = [&](double from, double to) {
    return from + (to - from) * static_cast<double>(draw()) / 4294967296.0;
  };
  double worst = 0.0;
  for (int i = 0; i < 42; ++i) {
    const Bump& bump = bumps[static_cast<std::size_t>(i) % std::size(bumps)];
    const bool changes_often = std::string(bump.form).starts_with("if(abs");
    const double width = std::pow(10.0, uniform(changes_often ? -3.0 : -5.0, -1.5)), centre = uniform(0.2, 0.8);
    const double accuracy = std::pow(10.0, uniform(-8.0, -4.0));
    const bool turns = i % 3 == 0;
    const std::string load = written(bump, 0.5 / (bump.area * width), centre, width, turns) +
                             factors[static_cast<std::size_t>(i) / 3 % std::size(factors)];
    const std::string simulation = fmt::format("accuracy: {:.17g}", accuracy);
    BuildOptions options;
    if (i % 4 == 3) options.integrator = "verner7";
    if (i % 4 == 2) options.integrator = "bathe";
    const ModelRun run(turns ? wheel(load, simulation) : sled(load, simulation), options);
    const double v = run.last(turns ? "joint.guide.speed" : "body.m.vx");
    EXPECT_NEAR(v, std::sqrt(2.0), 10.0 * accuracy) << load << " " << accuracy << " " << i;
    worst = std::max(worst, std::abs(v - std::sqrt(2.0)) / accuracy);
  }
  record("velocity_error_by_accuracy", worst);
}

// Where it acts it would turn the mass back soon after, if it did not end: the ends of a long step do not show it.
TEST(MotionLoad, ABrakeOfAShortWayIsPassed) {
  for (const char* form : {"abs({x}) < {w}", "({x})^2 < ({w})^2"}) {
    for (const double width : {1e-2, 1e-4, 1e-6}) {
      for (const char* integrator : {"", "verner7", "bathe"}) {
        BuildOptions options;
        if (*integrator != '\0') options.integrator = integrator;
        const std::string inside =
            replaced(replaced(form, "{x}", "body.m.x - 0.21 m"), "{w}", fmt::format("{:.17g} m", width));
        const ModelRun run(sled(fmt::format("if({}, {:.17g} N, 0 N)", inside, -0.1 / width), "accuracy: 1 um"),
                           options);
        EXPECT_NEAR(run.last("body.m.vx"), std::sqrt(0.6), 1e-6) << inside << " " << integrator;
      }
    }
  }
}

// 1 N, and almost as much back for a short while: it takes longer by the sum of 0.9^k sqrt(pi/k) widths.
TEST(MotionLoad, SoIsABumpOfTheSpeed) {
  const double width = 1e-4;
  double late = 0.0;
  for (int k = 1; k < 400; ++k) late += std::pow(0.9, k) * std::sqrt(M_PI / k) * width;
  const ModelRun run(sled("1 N - 0.9 N*exp(-((body.m.vx - 1.5)/(0.1 mm/s))^2)", "accuracy: 1 um"));
  EXPECT_NEAR(run.last("body.m.vx"), 3.0 - late, 1e-5);
}

// A press closes in a tenth of a millimetre on the way.
TEST(MotionLoad, ADriveFeelsALoadOfAPartOfItsStroke) {
  const ModelRun run(
      "freeplay: 1\n"
      "bodies: {ram: {mass: 1, inertia: 1}}\n"
      "joints: {guide: {type: prismatic, between: [ground, ram]}}\n"
      "drivers: {motor: {joint: guide, kind: position, value: '0.1*sin(3*t)'}}\n"
      "forces: {press: {type: force, at: ram, value: ['-5000 N*smooth(body.ram.x, 0.05, 0.0501)*(1 - "
      "smooth(body.ram.x, 0.0501, 0.0502))', 0]}}\n"
      "simulation: {end: 0.5 s, accuracy: 1 um}\n");
  EXPECT_NEAR(run.statistics().driver(0).max_abs, 5000.0, 5.0);
  EXPECT_NEAR(run.statistics().force(0).work, -0.5, 2e-3);
  // The square of either ramp has the mean 181/462, and is gone through with 0.3 cos(asin(0.5)) m/s.
  const double squares = 25e6 * 2.0 * 181.0 / 462.0 * 1e-4 / (0.3 * std::sqrt(0.75));
  EXPECT_NEAR(run.statistics().driver(0).rms / std::sqrt(squares / 0.5), 1.0, 0.03);
}

TEST(MotionLoad, CostsFewStepsWhereItIsEven) {
  const ModelRun even(sled("-4 N/m*body.m.x", "accuracy: 1 um"));
  const ModelRun sine(sled("-4 N*sin(body.m.x/(1 m))", "accuracy: 1 um"));
  EXPECT_LT(sine.outcome().steps, 2 * even.outcome().steps);
  EXPECT_LT(sine.outcome().rejected, even.outcome().rejected + 5);
  const ModelRun far(sled("1 N*exp(-((body.m.x - 5)/(1 mm))^2)", "accuracy: 1 um"));
  EXPECT_LT(far.outcome().steps, 40);
}

/// "unresolved-input" of a run, which has no other doubt of the force.
std::size_t unresolved(const std::string& text) {
  const ModelRun run(text);
  return static_cast<std::size_t>(std::ranges::count_if(run.outcome().doubts, [](const TrustReason& reason) {
    return reason.id == "unresolved-input" && reason.element == "force 'push'";
  }));
}

TEST(MotionLoad, ThatStepsOfOneSizeGoOverIsDoubted) {
  for (const char* bump :
       {"5000 N*exp(-((body.m.x - 0.5071)/(0.4 mm))^2)", "5000 N*if((body.m.x - 0.5071)^2 < 0.16 mm^2, 1, 0)",
        "5000 N*max(0, 1 - abs(body.m.x - 0.5071)/(0.4 mm))"}) {
    EXPECT_EQ(unresolved(sled(bump, "step: 2 ms")), 1u) << bump;
    // A window with edges wants shorter steps: by 0.1 ms it ends with 3.5 m/s in place of 3.
    const bool edges = std::string(bump).find("if(") != std::string::npos;
    EXPECT_EQ(unresolved(sled(bump, edges ? "step: 0.01 ms" : "step: 0.1 ms")), 0u) << bump;
  }
  for (const char* even :
       {"-100 N/m*body.m.x", "-5 N*(2*smooth(body.m.vx, -0.1, 0.1) - 1)", "-50 N*sin(10 m^-1*body.m.x)",
        "-400 N/m*max(0, body.m.x - 0.5)", "-5 N*if(body.m.x > 0.5, 1, 0)"}) {
    EXPECT_EQ(unresolved(sled(even, "step: 2 ms")), 0u) << even;
  }
}

// A jump inside a step acts to its end, and ends of steps may see a window that they do not resolve.
TEST(MotionLoad, AJumpInsideAStepOfOneSizeIsDoubted) {
  for (const char* window : {"-40 kN*if(body.m.x > 0.4997, if(body.m.x < 0.5003, 1, 0), 0)",
                             "-40 kN*if(body.m.x > 0.4997, 1, 0)*if(body.m.x < 0.5003, 1, 0)",
                             "-40 kN*if(abs(body.m.x - 0.5) < 0.3 mm, 1, 0)",
                             "-20 kN*(sign(body.m.x - 0.4997) - sign(body.m.x - 0.5003))"}) {
    EXPECT_EQ(unresolved(sled(window, "step: 1 ms")), 1u) << window;
  }
  // Each crossing comes late and adds energy.
  EXPECT_EQ(unresolved(sled("if(body.m.x > 20 mm, -20 N, 20 N)", "step: 2 ms")), 1u);
  EXPECT_EQ(unresolved(sled("if(body.m.x > 20 mm, -20 N, 20 N)", "step: 0.01 ms")), 0u);
  // About rest it jumps to and fro, and is off by one jump alone.
  EXPECT_EQ(unresolved(sled("-5 N*sign(body.m.vx)", "step: 0.2 ms")), 0u);
}

// At a dead centre the impulses of a late begin and a late end cancel, but not their works: the steps find 270 J in
// place of none (an accuracy of 1e-7 m: 1e-4 J).
TEST(MotionLoad, AJumpAtADeadCentreThatAddsWorkIsDoubted) {
  const std::string crank =
      "freeplay: 1\n"
      "bodies:\n"
      "  crank: {mass: 0.3 kg, inertia: 1e-2, com: [25 mm, 0], frames: {tip: [50 mm, 0]}}\n"
      "  rod: {mass: 0.21 kg, inertia: 2.5e-4, com: [60 mm, 0], frames: {tip: [120 mm, 0]}}\n"
      "  slider: {mass: 0.14 kg, inertia: 1e-4}\n"
      "joints:\n"
      "  main: {type: revolute, between: [ground, crank]}\n"
      "  crankpin: {type: revolute, between: [crank/tip, rod]}\n"
      "  guide: {type: prismatic, between: [ground, slider]}\n"
      "  wrist: {type: revolute, between: [rod/tip, slider]}\n"
      "forces: {push: {type: force, at: slider, value: ['if(body.slider.x > 0.165 m, -3000 N, 0 N)', 0]}}\n"
      "drivers: {m: {joint: main, kind: velocity, value: 2*pi*17}}\n"
      "initial: {joints: {main: 60 deg}}\n";
  EXPECT_EQ(unresolved(crank + "simulation: {end: 2, step: 1 ms}\n"), 1u);
  EXPECT_EQ(unresolved(crank + "simulation: {end: 0.5, step: 0.02 ms}\n"), 0u);
}

// In the first step nothing is known yet of what a load may be.
TEST(MotionLoad, ABumpThatEarlyStepsOfOneSizeGoOverIsDoubted) {
  const char* bump = "-1225 N*smooth(body.m.x, 5.33 mm, 5.41 mm)*(1 - smooth(body.m.x, 5.41 mm, 5.49 mm))";
  for (const char* step : {"step: 2 ms", "step: 1 ms", "step: 0.6 ms"}) EXPECT_EQ(unresolved(sled(bump, step)), 1u);
}

// A test may take the eyes away: then steps are as they were before loads were looked at.
TEST(MotionLoad, ABlindRunGoesOverTheBump) {
  RunHooks blind;
  blind.blind_to_inputs = true;
  const ModelRun run(sled("4000 N*exp(-((body.m.x - 0.5)/(10 um))^2)", "accuracy: 1 um"), {}, {}, builtin_types(),
                     blind);
  EXPECT_NEAR(run.last("body.m.vx"), 1.0, 1e-9);
}

// A bead with 0.1 m/s rises by 0.51 mm. What no step sees of a hill of 1 mm, the energy of rows on it shows.
TEST(MotionLoad, AHillThatABlindRunGoesOverIsSeenInItsRows) {
  const std::string hill =
      "freeplay: 1\n"
      "gravity: [0, -9.81]\n"
      "bodies: {b: {mass: 0.5, inertia: 1e-5, pose: {position: [-0.5, 0]}, velocity: {linear: [0.1, 0]}}}\n"
      "joints: {T: {type: point-on-curve, between: [ground, b],\n"
      "             curve: \"1 mm*smooth(x, 3 mm, 6 mm)*(1 - smooth(x, 6 mm, 9 mm))\"}}\n"
      "simulation: {end: 10 s, accuracy: 1 um, output: {interval: 10 ms}}\n";
  RunHooks blind;
  blind.blind_to_inputs = true;
  const ModelRun over(hill, {}, {}, builtin_types(), blind), back(hill);
  EXPECT_GT(over.last("body.b.x"), 0.4);
  EXPECT_LT(back.last("body.b.x"), -0.4);
  double off = 0.0;
  for (std::size_t row = 0; row < over.rows(); ++row) off = std::max(off, std::abs(over.at(row, "energy.residual")));
  EXPECT_NEAR(off, 0.5 * 9.81 * 1e-3, 1e-5);
  for (std::size_t row = 0; row < back.rows(); ++row) EXPECT_NEAR(back.at(row, "energy.residual"), 0.0, 1e-6);
}

}  // namespace
}  // namespace freeplay::test
