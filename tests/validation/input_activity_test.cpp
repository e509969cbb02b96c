// Runs with error control go over no load, however short it is and however it is written.
#include <array>
#include <random>

#include <fmt/format.h>

#include "pulse_joint.h"
#include "results/verification.h"
#include "run_model.h"

namespace freeplay::test {
namespace {

BuildOptions with(const char* integrator) {
  BuildOptions options;
  if (*integrator != '\0') options.integrator = integrator;
  return options;
}

/// A mass of 1 kg on a guide along x, with `more` sections.
std::string mass(const std::string& more, double accuracy, double end = 2.0, double interval = 0.0) {
  const std::string output = interval > 0.0 ? fmt::format(", output: {{interval: {:.17g}}}", interval) : "";
  return fmt::format(
      "freeplay: 1\n"
      "bodies: {{m: {{mass: 1, inertia: 1}}}}\n"
      "joints: {{guide: {{type: prismatic, between: [ground, m]}}}}\n"
      "{}\n"
      "simulation: {{end: {:.17g}, accuracy: {:.17g}{}}}\n",
      more, end, accuracy, output);
}

std::string force(const std::string& value) {
  return "forces: {hit: {type: force, at: m, value: ['" + value + "', 0]}}";
}

// 1000 N over ramps of 1 ms: 1 N s at 0.501 s.
TEST(InputActivity, AShortPulseIsMetHoweverItIsWritten) {
  const char* const smooth = "1000*smooth(t, 0.5, 0.501)*(1-smooth(t, 0.501, 0.502))";
  for (const char* integrator : {"", "verner7", "bathe"}) {
    const ModelRun run(mass(force(smooth), 1e-6), with(integrator));
    EXPECT_NEAR(run.last("body.m.x"), 1.499, 5e-6) << integrator;
    const ModelRun table(mass("drivers: {d: {joint: guide, kind: force, table: {points: [[0, 0], [0.5, 0], [0.501, "
                              "1000], [0.502, 0], [2, 0]], interpolation: linear}}}",
                              1e-6),
                         with(integrator));
    EXPECT_NEAR(table.last("body.m.x"), 1.499, 5e-6) << integrator;
  }
}

// Neither has a corner that could be told.
TEST(InputActivity, APulseWithoutCornersIsMetIfItLastsAnOutputInterval) {
  const double width = 2e-3, impulse = std::sqrt(M_PI) * width * 1000.0;
  for (const char* integrator : {"", "verner7"}) {
    const ModelRun bell(mass(force("1000*exp(-((t - 0.7)/2e-3)^2)"), 1e-6), with(integrator));
    EXPECT_NEAR(bell.last("body.m.x"), 1.3 * impulse, 2e-5) << integrator;
    const ModelRun cubic(mass("drivers: {d: {joint: guide, kind: force, table: {points: [[0, 0], [0.5, 0], [0.501, "
                              "1000], [0.502, 0], [1, 0], [2, 0]]}}}",
                              1e-6),
                         with(integrator));
    const ModelRun finer(mass("drivers: {d: {joint: guide, kind: force, table: {points: [[0, 0], [0.5, 0], [0.501, "
                              "1000], [0.502, 0], [1, 0], [2, 0]]}}}",
                              1e-9),
                         with(integrator));
    EXPECT_NEAR(cubic.last("body.m.x") / finer.last("body.m.x"), 1.0, 1e-7) << integrator;  // the spline swings far
  }
}

TEST(InputActivity, AFunctionOfTimeOfAJointIsAnalysedToo) {
  const ModelRun run(mass("forces: {hit: {type: written-load, between: [ground, m], load: 'max(0, 1e6 - "
                          "1e11*abs(t - 0.5))'}}",
                          1e-6),
                     {}, {}, types_with_pulses());
  EXPECT_NEAR(run.last("body.m.x"), 15.0, 2e-5);  // 1 MN at 0.5 s, 10 us to both sides: 10 N s
}

// A test may take the eyes away: then steps are as they were before loads were looked at.
TEST(InputActivity, ABlindRunGoesOverThePulse) {
  RunHooks blind;
  blind.blind_to_inputs = true;
  const ModelRun run(mass(force("1000*smooth(t, 0.5, 0.501)*(1-smooth(t, 0.501, 0.502))"), 1e-6), {}, {},
                     builtin_types(), blind);
  EXPECT_NEAR(run.last("body.m.x"), 0.0, 1e-9);
}

ResultTable table_of(const ModelRun& run) {
  ResultTable table{run.kept().names(), {}};
  table.values.resize(table.names.size());
  for (std::size_t r = 0; r < run.rows(); ++r) {
    for (std::size_t c = 0; c < table.names.size(); ++c) table.values[c].push_back(run.at(r, table.names[c]));
  }
  return table;
}

// As `run --verify` does it: a method of another kind with steps of an output interval at most, blind as the first.
TEST(InputActivity, ASecondRunByAnotherKindFindsABlindOne) {
  RunHooks blind;
  blind.blind_to_inputs = true;
  const std::string text = mass(force("1000*smooth(t, 0.5, 0.501)*(1-smooth(t, 0.501, 0.502))"), 1e-6);
  const auto table = [&](const char* integrator, double accuracy, std::optional<double> largest_step) {
    BuildOptions options = with(integrator);
    options.accuracy = accuracy;
    options.largest_step = largest_step;
    return table_of(ModelRun(text, options, {"time", "body.m.x"}, builtin_types(), blind));
  };
  const ResultTable first = table("dopri5", 1e-6, {}), second = table("bathe", 5e-7, 2e-3),
                    third = table("bathe", 5e-6, 2e-3);
  const RunResult a{&first, {}}, b{&second, {}}, c{&third, {}};
  const VerificationRules rules{{{"body.m.x"}}, 3e-6, false};
  Verification v = compare_runs(a, b, rules);
  EXPECT_NEAR(v.agree_until, 0.5, 2.1e-3);
  judge(v, a, b, c, rules);
  EXPECT_EQ(v.agreement, Agreement::disagree);
}

// What is prescribed takes the pulse; the drive feels it at its height.
TEST(InputActivity, AStepEndsAtTheHeightOfALoadOnADrivenMechanism) {
  const ModelRun run(mass("drivers: {motor: {joint: guide, kind: position, value: '0.1*sin(3*t)'}}\n" +
                              force("5000*min(max(0, t - 0.5), max(0, 0.502 - t))/1e-3"),
                          1e-6));
  EXPECT_NEAR(run.statistics().driver(0).max_abs, 5000.0, 2.0);
}

TEST(InputActivity, CornersOfLoadsCostFewSteps) {
  const double end = 2.0;
  const ModelRun wave(mass(force("10*abs(sin(2*pi*50*t))"), 1e-6, end));
  EXPECT_LT(wave.outcome().steps, 200 * 8);
  const ModelRun teeth(
      mass("drivers: {d: {joint: guide, kind: force, table: {points: [[0, 0], [1 ms, 10], [2 ms, 0]], "
           "interpolation: linear, outside: repeat}}}",
           1e-6, end));
  EXPECT_LT(teeth.outcome().steps, 2000 * 2);
  EXPECT_LT(teeth.outcome().rejected, 100);
  EXPECT_NEAR(teeth.last("body.m.x"), 10.0, 1e-4);
  // A spline of many points need not be taken point by point.
  std::string points;
  for (int i = 0; i <= 4000; ++i) points += fmt::format("[{:.17g}, {:.17g}], ", i * 5e-4, std::sin(M_PI * i * 5e-4));
  const ModelRun spline(
      mass("drivers: {d: {joint: guide, kind: force, table: {points: [" + points + "[3, 0]]}}}", 1e-6, end));
  EXPECT_LT(spline.outcome().steps, 200);
}

// The force of a joint that leaves a step function behind jumps at a corner that it tells.
TEST(InputActivity, AJumpOfALoadStartsTheIntegratorAgain) {
  const ModelRun run(
      mass("drivers: {d: {joint: guide, kind: force, table: {points: [[0, 0], [0.7, 0], [0.7000001, 1], "
           "[0.8, 1]], interpolation: linear, outside: repeat}}}",
           1e-8, 1.0));
  EXPECT_NEAR(run.last("body.m.x"), 0.5 * 0.01 + 0.1 * 0.2, 1e-7);
  EXPECT_LT(run.outcome().steps, 100);
}

TEST(InputActivity, APulseOfAPrescribedSpeedIsInThePosition) {
  const ModelRun run(
      mass("drivers: {motor: {joint: guide, kind: velocity, value: 'max(0, 1000 - 1e8*abs(t - 0.5))'}}", 1e-6));
  EXPECT_NEAR(run.last("body.m.x"), 1e-2, 1e-9);
}

TEST(InputActivity, FixedStepsThatGoOverAPulseAreWarnedOf) {
  const std::string text = replaced(mass(force("1000*smooth(t, 0.5, 0.501)*(1-smooth(t, 0.501, 0.502))"), 1e-6),
                                    "accuracy: 9.9999999999999995e-07", "step: 5 ms");
  const auto warnings = [](const std::string& model) {
    const auto loaded = load(model);
    System system(*loaded);
    const Start start = assemble(system);
    const Channels channels(*loaded);
    Simulation simulation(system, start, channels, {});
    simulation.run({});
    return std::vector<std::string>(simulation.warnings().begin(), simulation.warnings().end());
  };
  ASSERT_EQ(warnings(text).size(), 1u);
  EXPECT_NE(warnings(text)[0].find("force 'hit': it has corners at 0.5 s and 0.501 s, closer than the step of 0.002 s"),
            std::string::npos)
      << warnings(text)[0];
  EXPECT_TRUE(warnings(replaced(text, "step: 5 ms", "step: 0.1 ms")).empty());
}

/// One pulse along x with where it takes a mass of 1 kg by the end.
struct Pulse {
  std::string section;  ///< of the model
  double way;           ///< [m]
};

// Moments of a pulse that grows on (a, b) and falls on (b, c): integral of (end - t) F(t).
double way_of_triangle(double a, double b, double c, double end) {
  return (b - a) * ((end - a) / 2 - (b - a) / 3) + (c - b) * ((end - b) / 2 - (c - b) / 6);
}
double way_of_smooth(double a, double b, double c, double end) {
  return (b - a) * ((end - a) / 2 - (b - a) * 5 / 14) + (c - b) * ((end - b) / 2 - (c - b) / 7);
}

/// `wanted`: how far it shall go. Four ways to write it.
Pulse pulse(int form, std::mt19937_64& random, double length, double end, double wanted) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const double a = (end - length) * (0.05 + 0.9 * unit(random)), b = a + length * (0.2 + 0.6 * unit(random)),
               c = a + length;
  const bool round = form == 0;
  const double height = wanted / (round ? way_of_smooth(a, b, c, end) : way_of_triangle(a, b, c, end));
  switch (form) {
    case 0:
      return {force(fmt::format("{:.17g}*smooth(t, {:.17g}, {:.17g})*(1 - smooth(t, {:.17g}, {:.17g}))", height, a, b,
                                b, c)),
              wanted};
    case 1:
      return {
          fmt::format("drivers: {{d: {{joint: slide, kind: force, table: {{points: [[0, 0], [{:.17g}, 0], [{:.17g}, "
                      "{:.17g}], [{:.17g}, 0], [{:.17g}, 0]], interpolation: linear}}}}{}}}",
                      a, b, height, c, 2 * end, "@drivers"),
          wanted};
    case 2:
      return {force(fmt::format("{:.17g}*max(0, min((t - {:.17g})/({:.17g}), ({:.17g} - t)/({:.17g})))", height, a,
                                b - a, c, c - b)),
              wanted};
    default: {
      const double square = 2.0 * wanted / (length * (end - a - length / 2));
      const int told = 1 + static_cast<int>(random() % 2);
      return {fmt::format("forces: {{hit: {{type: pulse, between: [ground, m], height: {:.17g}, begin: {:.17g}, "
                          "duration: {:.17g}, told: {}}}}}",
                          square, a, length, told),
              wanted};
    }
  }
}

// In fall: along the guide. Carried: on a slide of a cart that is driven to and fro. Loose: a pin in its bearing, which
// the pulse does not take to the other side.
enum class Where { falling, carried, loose };

std::string model_of(Where where, Pulse p, double accuracy, double end) {
  std::string text = "freeplay: 1\n", drivers;
  if (where == Where::carried) {
    text +=
        "bodies: {m: {mass: 1, inertia: 1}, cart: {mass: 3, inertia: 1}}\n"
        "joints:\n"
        "  guide: {type: prismatic, between: [ground, cart]}\n"
        "  slide: {type: prismatic, between: [cart, m]}\n";
    drivers = "motor: {joint: guide, kind: position, value: '0.2*(1 - cos(3*t))'}";
  } else {
    text +=
        "bodies: {m: {mass: 1, inertia: 1}}\n"
        "joints:\n"
        "  slide: {type: prismatic, between: [ground, m]}\n";
    if (where == Where::falling) text += "gravity: [-9.81, 0]\n";
    if (where == Where::loose) {
      text +=
          "  pin: {type: revolute, bearing: ground, journal: m, clearance: {bearing_radius: 10 mm, radial_clearance: 1 "
          "mm, material: {E: 207 GPa, nu: 0.3}, contact: {law: lankarani-nikravesh, restitution: 0.9}}}\n";
    }
  }
  const std::size_t place = p.section.find("@drivers");
  if (place != std::string::npos) {
    p.section.replace(place, 8, drivers.empty() ? "" : ", " + drivers);
  } else if (!drivers.empty()) {
    p.section += "\ndrivers: {" + drivers + "}";
  }
  return text + p.section +
         fmt::format("\nsimulation: {{end: {:.17g}, accuracy: {:.17g}, output: {{interval: {:.17g}}}}}\n", end,
                     accuracy, end / 10);
}

TEST(InputActivity, FiveHundredRandomPulsesEndWhereTheyShould) {
  std::mt19937_64 random(20);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const double end = 1.0;
  double worst = 0.0;
  for (int i = 0; i < 500; ++i) {
    const Where where = static_cast<Where>(i % 3);
    const int form = i / 3 % 4;
    const double length = end * std::pow(10.0, -5.0 + 4.0 * unit(random));
    const double accuracy = std::pow(10.0, -4.0 - 4.0 * unit(random));
    const double wanted = where == Where::loose ? 4e-4 * (0.1 + unit(random)) : 0.01 + unit(random);
    const std::string text = model_of(where, pulse(form, random, length, end, wanted), accuracy, end);
    const ModelRun run(text, {}, {"time", "body.m.x", "body.m.vx"}, types_with_pulses());
    ASSERT_EQ(run.outcome().status, RunStatus::completed) << run.outcome().reason << "\n" << text;
    const double fall = where == Where::falling ? -0.5 * 9.81 * end * end : 0.0;
    const double exact = run.at(0, "body.m.x") + end * run.at(0, "body.m.vx") + wanted + fall;
    const double error = std::abs(run.last("body.m.x") - exact);
    EXPECT_LE(error, 10.0 * accuracy) << "pulse " << i << ", of " << length << " s\n" << text;
    worst = std::max(worst, error / accuracy);
  }
  record("largest error over accuracy", worst);
}

// A joint that says nothing of its time is looked at for changes as long as an output interval.
TEST(InputActivity, APulseOfASilentJointIsMetIfItLastsAnOutputInterval) {
  for (const double at : {0.03, 0.41234, 0.9}) {
    const double duration = 1.1e-3, height = 2.0 * 0.5 / (duration * (1.0 - at - duration / 2));
    const ModelRun run(mass(fmt::format("forces: {{hit: {{type: pulse, between: [ground, m], height: {:.17g}, begin: "
                                        "{:.17g}, duration: {:.17g}}}}}",
                                        height, at, duration),
                            1e-7, 1.0),
                       {}, {}, types_with_pulses());
    EXPECT_NEAR(run.last("body.m.x"), 0.5, 1e-6) << at;
  }
}

// A pulse that is the same to both sides of its middle moves the mass as if it came at once.
TEST(InputActivity, APeriodicLoadKeepsEachOfItsPulses) {
  const double end = 5.0, w = 2.0 * M_PI * 40.0, level = 0.998, from = std::asin(level);
  const double impulse = 80.0 * (2.0 * std::cos(from) - level * (M_PI - 2.0 * from)) / w;
  double way = 0.0;
  for (int k = 0; k < 200; ++k) way += impulse * (end - (M_PI / 2.0 + 2.0 * M_PI * k) / w);
  for (const char* integrator : {"", "verner7"}) {
    const ModelRun run(mass(force("80*max(0, sin(2*pi*40*t) - 0.998)"), 1e-7, end), with(integrator));
    EXPECT_NEAR(run.last("body.m.x"), way, 1e-6) << integrator;
  }
  const ModelRun driven(
      mass("drivers: {motor: {joint: guide, kind: velocity, value: '80*max(0, sin(2*pi*40*t) - 0.998)'}}", 1e-7, 1.0));
  EXPECT_NEAR(driven.last("body.m.x"), 40.0 * impulse, 1e-12);
}

// Of the side that shows it no parabola is known.
TEST(InputActivity, ALoadInsideMaxIsMetWhateverCurveItIs) {
  const double end = 30.0, at = 21.0301, width = 4e-4;
  const ModelRun quartic(mass(force("1000*max(0, 1 - ((t - 21.0301)/4e-4)^4)"), 1e-6, end));
  EXPECT_NEAR(quartic.last("body.m.x"), 1600.0 * width * (end - at), 1e-5);
  const ModelRun clipped(mass(force("1000*max(0, 1/(1 + ((t - 21.0301)/4e-4)^2) - 0.5)"), 1e-6, end));
  EXPECT_NEAR(clipped.last("body.m.x"), 1000.0 * (M_PI / 2.0 - 1.0) * width * (end - at), 1e-5);
}

TEST(InputActivity, ARepeatedTableKeepsEachOfItsPulses) {
  const ModelRun run(
      mass("drivers: {d: {joint: guide, kind: force, table: {points: [[0, 0], [11 ms, 0], [11.2 ms, 50], "
           "[11.4 ms, 0], [30 ms, 0]], interpolation: linear, outside: repeat}}}",
           1e-6, 3.0));
  double way = 0.0;
  for (int k = 0; k < 100; ++k) way += 50.0 * 2e-4 * (3.0 - 0.0112 - 0.03 * k);
  EXPECT_NEAR(run.last("body.m.x"), way, 1e-5);
}

// The corner at t = 0 is none. Half a wave gives 2 F/w and takes the mass F pi/w^2.
TEST(InputActivity, ALoadThatBeginsWithTheRunIsNoCorner) {
  const ModelRun run(mass(force("30*max(0, sin(pi*t))"), 1e-7, 2.0));
  ASSERT_EQ(run.outcome().status, RunStatus::completed) << run.outcome().reason;
  EXPECT_NEAR(run.last("body.m.x"), 30.0 / M_PI + 60.0 / M_PI, 1e-6);
}

TEST(InputActivity, TheMeanOfAForceThatJumpsIsExact) {
  const ModelRun run(
      mass("drivers: {motor: {joint: guide, kind: velocity, table: {points: [[0, 0], [0.5, 0], [0.53, "
           "0.6], [1.5, 0.6], [1.51, 0], [2, 0]], interpolation: linear}}}",
           1e-6));
  EXPECT_NEAR(run.statistics().driver(0).rms, std::sqrt((20.0 * 20.0 * 0.03 + 60.0 * 60.0 * 0.01) / 2.0), 1e-3);
  const ModelRun wave(mass("drivers: {push: {joint: guide, kind: force, value: '7*sin(3*t)'}}", 1e-4, 2.0 * M_PI));
  EXPECT_NEAR(wave.statistics().driver(0).rms, 7.0 / std::sqrt(2.0), 5e-3);
}

// No error of an integrator shows what a drive alone moves.
TEST(InputActivity, WhatADriveAloneMovesIsResolved) {
  const ModelRun run(mass(
      "drivers: {motor: {joint: guide, kind: position, value: '0.05*sin(2*pi*5*t) + 0.01*sin(2*pi*17*t)'}}", 1e-6));
  const double first = 2.0 * M_PI * 5.0, second = 2.0 * M_PI * 17.0;
  double largest = 0.0;
  for (int i = 0; i < 200000; ++i) {
    const double t = i * 1e-5;
    largest = std::max(
        largest, std::abs(0.05 * first * first * std::sin(first * t) + 0.01 * second * second * std::sin(second * t)));
  }
  const double moved = 0.5 * std::pow(0.05 * first + 0.01 * second, 2);
  EXPECT_NEAR(run.statistics().driver(0).max_abs, largest, 1e-3 * largest);
  EXPECT_NEAR(run.statistics().driver(0).work, 0.0, 1e-3 * moved);
}

// A motion of one form is crossed in parts also where the run begins or ends with it; 10/sqrt(3) is the largest second
// derivative of a ramp of one second.
TEST(InputActivity, AMotionThatTheRunBeginsOrEndsWithIsResolved) {
  for (const auto& [from, to, end] :
       {std::array{0.0, 1.0, 20.0}, {0.0, 1.0, 2000.0}, {19.0, 20.0, 20.0}, {0.0, 1.0, 1.0}}) {
    const std::string value = fmt::format("0.1*smooth(t, {}, {})", from, to);
    const ModelRun run(
        mass("drivers: {motor: {joint: guide, kind: position, value: '" + value + "'}}", 1e-6, end, end / 10.0));
    ASSERT_EQ(run.outcome().status, RunStatus::completed) << value;
    EXPECT_NEAR(run.statistics().driver(0).max_abs, 1.0 / std::sqrt(3.0), 2e-3) << value;
    EXPECT_NEAR(run.last("energy.residual"), 0.0, 1e-3 * 0.5 * 0.1875 * 0.1875) << value;
  }
}

TEST(InputActivity, AJumpOfAnAngleIsPassed) {
  const ModelRun run(mass(force("5*atan2(0, 0.7 - t)"), 1e-7, 1.0));
  ASSERT_EQ(run.outcome().status, RunStatus::completed) << run.outcome().reason;
  EXPECT_NEAR(run.last("body.m.x"), 5.0 * M_PI * 0.5 * 0.3 * 0.3, 1e-6);
}

TEST(InputActivity, FixedStepsThatGoOverAPulseAreDoubted) {
  const auto doubts = [](const char* step) {
    const ModelRun run(replaced(mass(force("60*max(0, 1 - abs(t - 0.7)/1e-4)"), 1e-6),
                                "accuracy: 9.9999999999999995e-07", fmt::format("step: {}", step)));
    return std::ranges::count(run.outcome().doubts, "unresolved-input", &TrustReason::id);
  };
  EXPECT_EQ(doubts("1 ms"), 1);
  EXPECT_EQ(doubts("0.09 ms"), 0);
}

// Pulses without corners between the ends of steps, ripples, and slow loads that steps of this size show.
TEST(InputActivity, FixedStepsThatGoOverASmoothPulseAreDoubted) {
  const auto doubted = [](const char* value, const char* step) {
    const ModelRun run(replaced(mass(force(value), 1e-6), "accuracy: 9.9999999999999995e-07",
                                fmt::format("step: {0}, output: {{interval: {0}}}", step)));
    const auto doubt = std::ranges::find(run.outcome().doubts, "unresolved-input", &TrustReason::id);
    return doubt == run.outcome().doubts.end() ? std::string() : doubt->message;
  };
  EXPECT_EQ(doubted("1000*exp(-((t - 0.70031)/2e-4)^2)", "10 ms"),
            "force 'hit' changes at t = 0.70031 s in a way that steps of 0.01 s do not show");
  EXPECT_NE(doubted("50*sin(3*t) + 1000*exp(-((t - 0.70031)/1e-6)^2)*smooth(t, 0.2, 0.4)", "1 ms"), "");
  EXPECT_NE(doubted("1/(1 + ((t - 0.70031)/2e-4)^2)", "1 ms"), "");
  EXPECT_NE(doubted("5*sin(3000*t)", "1 ms"), "");
  EXPECT_EQ(doubted("1000*exp(-((t - 0.70031)/2e-4)^2)", "0.08 ms"), "");
  EXPECT_EQ(doubted("10/(1 + sin(50*t)^2)", "2 ms"), "");
  EXPECT_EQ(doubted("20*sin(7*t) + 0.01*t^2", "10 ms"), "");
  EXPECT_EQ(doubted("20*max(0, sin(7*t))", "10 ms"), "");
}

// Of motions the accelerations count, whose peaks are in forces.
TEST(InputActivity, FixedStepsThatGoOverAPartOfAMotionAreDoubted) {
  const auto doubted = [](const char* kind, const char* value) {
    const ModelRun run(
        replaced(mass(fmt::format("drivers: {{d: {{joint: guide, kind: {}, value: '{}'}}}}", kind, value), 1e-6),
                 "accuracy: 9.9999999999999995e-07", "step: 1 ms, output: {interval: 1 ms}"));
    const auto doubt = std::ranges::find(run.outcome().doubts, "unresolved-input", &TrustReason::id);
    return doubt == run.outcome().doubts.end() ? std::string() : doubt->element;
  };
  EXPECT_EQ(doubted("position", "1e-3*exp(-((t - 0.70031)/2e-4)^2)"), "driver 'd'");
  EXPECT_EQ(doubted("velocity", "0.1*exp(-((t - 0.70031)/2e-4)^2)"), "driver 'd'");
  EXPECT_EQ(doubted("position", "0.1*sin(3*t) + 1e-4*sin(3000*t)"), "driver 'd'");
  EXPECT_EQ(doubted("position", "0.1*sin(20*t)"), "");
  EXPECT_EQ(doubted("velocity", "0.1*exp(-((t - 0.7)/2e-2)^2)"), "");
}

// Points closer than the steps are no doubt as long as the steps show what they make.
TEST(InputActivity, TablesAreDoubtedByWhatStepsHideOfThem) {
  const auto doubts = [](const char* points) {
    const ModelRun run(replaced(
        mass(fmt::format(
                 "drivers: {{push: {{joint: guide, kind: force, table: {{points: [{}], interpolation: linear}}}}}}",
                 points),
             1e-6),
        "accuracy: 9.9999999999999995e-07", "step: 10 ms, output: {interval: 10 ms}"));
    return std::ranges::count(run.outcome().doubts, "unresolved-input", &TrustReason::id);
  };
  EXPECT_EQ(doubts("[0, 0], [0.999, 0.999], [1.001, 1.001], [2, 2]"), 0);
  EXPECT_EQ(doubts("[0, 0], [0.993, 0], [0.996, 10], [0.999, 0], [2, 0]"), 1);
}

}  // namespace
}  // namespace freeplay::test
