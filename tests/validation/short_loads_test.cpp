// Short loads and their corners on a free mass: where it is at the end is the moment of the load, the integral of
// (end - t) F(t), by Gauss' rule between the corners that the test knows.
#include <functional>
#include <random>

#include <fmt/format.h>

#include "run_model.h"

namespace freeplay::test {
namespace {

using Force = std::function<double(double)>;

struct Load {
  std::string text;
  Force force;
  std::vector<double> corners;
};

// Abscissas x and weights of Legendre's polynomial of degree 24 on (-1, 1).
const std::vector<std::pair<double, double>>& gauss() {
  static const auto points = [] {
    constexpr int n = 24;
    std::vector<std::pair<double, double>> out;
    for (int i = 1; i <= n; ++i) {
      double x = std::cos(M_PI * (i - 0.25) / (n + 0.5)), slope = 1.0;
      for (int k = 0; k < 50; ++k) {
        double before = 1.0, here = x;
        for (int d = 2; d <= n; ++d)
          before = std::exchange(here, ((2.0 * d - 1.0) * x * here - (d - 1.0) * before) / d);
        slope = n * (x * here - before) / (x * x - 1.0);
        x -= here / slope;
      }
      out.emplace_back(x, 2.0 / ((1.0 - x * x) * slope * slope));
    }
    return out;
  }();
  return points;
}

// Instants are crowded at both ends of a piece, where slopes may be infinite: by u^4 (35 - 84 u + 70 u^2 - 20 u^3).
double way_of(const Load& load, double end) {
  std::vector<double> ends{0.0, end};
  for (const double corner : load.corners) {
    if (corner > 0.0 && corner < end) ends.push_back(corner);
  }
  std::ranges::sort(ends);
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const double length = ends[i + 1] - ends[i];
    for (const auto& [x, weight] : gauss()) {
      const double u = 0.5 * (x + 1.0), v = 1.0 - u;
      const double t = ends[i] + length * u * u * u * u * (35.0 + u * (-84.0 + u * (70.0 - 20.0 * u)));
      sum += 0.5 * weight * length * 140.0 * u * u * u * v * v * v * (end - t) * load.force(t);
    }
  }
  return sum;
}

// `error` in accuracies of where a mass of 1 kg is at the end.
struct Way {
  double error;
  long steps;
};
Way run(const Load& load, double end, double accuracy, const char* integrator = "") {
  BuildOptions options;
  if (*integrator != '\0') options.integrator = integrator;
  const ModelRun run(fmt::format("freeplay: 1\n"
                                 "bodies: {{m: {{mass: 1, inertia: 1}}}}\n"
                                 "joints: {{guide: {{type: prismatic, between: [ground, m]}}}}\n"
                                 "forces: {{hit: {{type: force, at: m, value: ['{}', 0]}}}}\n"
                                 "simulation: {{end: {:.17g}, accuracy: {:.17g}, output: {{interval: {:.17g}}}}}\n",
                                 load.text, end, accuracy, end / 10.0),
                     options, {"body.m.x"});
  EXPECT_EQ(run.outcome().status, RunStatus::completed) << run.outcome().reason << "\n" << load.text;
  return {std::abs(run.last("body.m.x") - way_of(load, end)) / accuracy, run.outcome().steps};
}

double smooth(double x, double a, double b) {
  const double s = std::clamp((x - a) / (b - a), 0.0, 1.0);
  return s * s * s * (s * (6.0 * s - 15.0) + 10.0);
}

// Of a sine of the angular frequency w: where it passes `levels`, and its zeros and turns.
std::vector<double> corners_of_sine(double w, double end, const std::vector<double>& levels) {
  std::vector<double> out;
  for (int k = 0; k * 0.5 * M_PI < w * end; ++k) out.push_back(0.5 * M_PI * k / w);
  for (const double level : levels) {
    for (int k = 0; k * 2.0 * M_PI < w * end; ++k) {
      for (const double angle : {std::asin(level), M_PI - std::asin(level)})
        out.push_back((angle + 2.0 * M_PI * k) / w);
    }
  }
  return out;
}

// An error of velocity in the pulse grows for the 80 s that follow.
TEST(ShortLoads, OnePulseInALongRunIsRightAtItsEnd) {
  const Load pulse{"1.04*(1-smooth(((t-20.58)/0.0288)^2,0,1))",
                   [](double t) { return 1.04 * (1.0 - smooth(std::pow((t - 20.58) / 0.0288, 2), 0.0, 1.0)); },
                   {20.58 - 0.0288, 20.58, 20.58 + 0.0288}};
  for (const double accuracy : {1e-4, 1e-6, 1e-8}) EXPECT_LE(run(pulse, 100.0, accuracy).error, 2.0) << accuracy;
}

TEST(ShortLoads, ErrorsOfRepeatedPulsesDoNotAddUp) {
  const double w = 2.0 * M_PI * 50.0, end = 20.0;
  const Load pulses{"10*smooth(sin(2*pi*50*t),0.99,0.999)",
                    [w](double t) { return 10.0 * smooth(std::sin(w * t), 0.99, 0.999); },
                    corners_of_sine(w, end, {0.99, 0.999})};
  for (const char* integrator : {"", "verner7", "bathe"}) {
    EXPECT_LE(run(pulses, end, 1e-6, integrator).error, end) << "with " << integrator;
  }
}

TEST(ShortLoads, CornersThatAreTouchedAreMet) {
  const double w = 2.0 * M_PI * 3.0, end = 10.0;
  const auto corners = corners_of_sine(w, end, {});
  const Force rectified = [w](double t) { return 10.0 * std::abs(std::sin(w * t)); };
  EXPECT_LE(run({"10*sqrt(sin(6*pi*t)^2)", rectified, corners}, end, 1e-6).error, end);
  EXPECT_LE(run({"10*(sin(6*pi*t)*sin(6*pi*t))^0.5", rectified, corners}, end, 1e-6).error, end);
  EXPECT_LE(run({"10*sqrt(1 - cos(6*pi*t)^2)", rectified, corners}, end, 1e-6).error, end);
  const Way triangle =
      run({"10*asin(sin(6*pi*t))", [w](double t) { return 10.0 * std::asin(std::sin(w * t)); }, corners}, end, 1e-6);
  EXPECT_LE(triangle.error, 0.1);
  EXPECT_LE(triangle.steps, 6 * 60);
  EXPECT_LE(
      run({"10*acos(cos(6*pi*t))", [w](double t) { return 10.0 * std::acos(std::cos(w * t)); }, corners}, end, 1e-6)
          .error,
      0.1);
}

// The same corner is found twice, an ulp apart.
TEST(ShortLoads, CornersThatRoundingKeepsApartArePassed) {
  const double a = 0.02896678534394961, b = 0.028972881082271626, top = 63000.38456021905, width = b - a;
  const std::string squared = "6.095738322015371e-06^2";
  const Load arch{fmt::format("{:.17g}*max(0, (t-{:.17g})*({:.17g}-t))/{}", top, a, b, squared),
                  [=](double t) { return top * std::max(0.0, (t - a) * (b - t)) / (width * width); },
                  {a, b}};
  for (const char* integrator : {"", "verner6", "verner7", "arkode"})
    EXPECT_LE(run(arch, 0.5, 1e-6, integrator).error, 2.0) << "with " << integrator;
}

TEST(ShortLoads, StepsBesideInfiniteSlopesAreShort) {
  const Load root{"100*sqrt(max(t-1,0))", [](double t) { return 100.0 * std::sqrt(std::max(t - 1.0, 0.0)); }, {1.0}};
  const Load fifth{"100*max(t-1,0)^0.2", [](double t) { return 100.0 * std::pow(std::max(t - 1.0, 0.0), 0.2); }, {1.0}};
  const Load arc{"10*asin(min(1,2*t))", [](double t) { return 10.0 * std::asin(std::min(1.0, 2.0 * t)); }, {0.5}};
  const Load begin{"100*sqrt(t)", [](double t) { return 100.0 * std::sqrt(t); }, {}};
  for (const char* integrator : {"", "verner7", "bathe"}) {
    for (const double accuracy : {1e-4, 1e-6, 1e-8}) {
      if (*integrator == 'b' && accuracy < 1e-7) continue;
      for (const Load* load : {&root, &fifth, &arc, &begin}) {
        EXPECT_LE(run(*load, 3.0, accuracy, integrator).error, 2.0) << load->text << " " << integrator << accuracy;
      }
    }
  }
}

// Pulses of a length from 1e-5 to 1e-1 of the run, with roots, powers and arcs.
Load random_pulse(std::mt19937_64& random, double end) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const double length = end * std::pow(10.0, -5.0 + 4.0 * unit(random));
  const double a = (0.02 + 0.9 * unit(random)) * (end - length), half = length / 2.0, c = a + half, z = a + length;
  const double height = std::pow(10.0, -1.0 + 2.0 * unit(random)) / (length * std::max(end - c, 0.1));
  const std::string u = fmt::format("((t - {:.17g})/{:.17g})", c, half), h = fmt::format("{:.17g}", height);
  const auto at = [c, half](double t) { return (t - c) / half; };
  const auto load = [&](const std::string& text, const std::function<double(double)>& shape) {
    return Load{h + "*" + text, [=](double t) { return height * shape(at(t)); }, {a, c, z}};
  };
  const double power = 0.1 + 2.8 * unit(random);
  switch (random() % 8) {
    case 0:
      return load("(1 - smooth(" + u + "^2, 0, 1))", [](double x) { return 1.0 - smooth(x * x, 0.0, 1.0); });
    case 1:
      return load("sqrt(max(0, 1 - " + u + "^2))", [](double x) { return std::sqrt(std::max(0.0, 1.0 - x * x)); });
    case 2:
      return load(fmt::format("max(0, 1 - abs({}))^{:.17g}", u, power),
                  [power](double x) { return std::pow(std::max(0.0, 1.0 - std::abs(x)), power); });
    case 3:
      return load("max(0, 1 - sqrt(" + u + "^2))", [](double x) { return std::max(0.0, 1.0 - std::abs(x)); });
    case 4:
      return load("max(0, 1 - (" + u + "^2)^0.5)*(1 + " + u + ")",
                  [](double x) { return std::max(0.0, 1.0 - std::abs(x)) * (1.0 + x); });
    case 5:
      return load(fmt::format("acos(max(-1, min(1, {})))*asin(max(-1, min(1, {})))", u, u), [](double x) {
        const double y = std::clamp(x, -1.0, 1.0);
        return std::acos(y) * std::asin(y);
      });
    case 6:
      return load("max(0, 1 - acos(cos(pi*max(-1, min(1, " + u + "))))/pi)",
                  [](double x) { return 1.0 - std::min(1.0, std::abs(x)); });
    default:
      return load("sqrt(abs(" + u + "))*max(0, 1 - abs(" + u + "))",
                  [](double x) { return std::sqrt(std::abs(x)) * std::max(0.0, 1.0 - std::abs(x)); });
  }
}

// Ten to a hundred a run, or three a second.
Load random_train(std::mt19937_64& random, double end) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const double w = 2.0 * M_PI * std::pow(10.0, 1.0 + unit(random)) * std::max(1.0, end / 30.0) / end;
  const double height = std::pow(10.0, -1.0 + 2.0 * unit(random)), level = 0.5 + 0.499 * unit(random);
  const std::string h = fmt::format("{:.17g}", height), sine = fmt::format("sin({:.17g}*t)", w);
  const auto train = [&](const std::string& text, const std::function<double(double)>& shape, bool at_level) {
    return Load{h + "*" + text, [=](double t) { return height * shape(w * t); },
                corners_of_sine(w, end, at_level ? std::vector<double>{level} : std::vector<double>{})};
  };
  const std::string l = fmt::format("{:.17g}", level);
  const double power = 0.2 + 1.6 * unit(random);
  switch (random() % 6) {
    case 0:
      return train(
          "max(0, " + sine + " - " + l + ")", [level](double x) { return std::max(0.0, std::sin(x) - level); }, true);
    case 1:
      return train(
          "smooth(" + sine + ", " + l + ", 1)", [level](double x) { return smooth(std::sin(x), level, 1.0); }, true);
    case 2:
      return train(
          "sqrt(" + sine + "^2)", [](double x) { return std::abs(std::sin(x)); }, false);
    case 3:
      return train(
          fmt::format("abs({})^{:.17g}", sine, power),
          [power](double x) { return std::pow(std::abs(std::sin(x)), power); }, false);
    case 4:
      return train(
          "asin(" + sine + ")*" + sine, [](double x) { return std::asin(std::sin(x)) * std::sin(x); }, false);
    default:
      return train(
          "sqrt(max(0, " + sine + " - " + l + "))",
          [level](double x) { return std::sqrt(std::max(0.0, std::sin(x) - level)); }, true);
  }
}

TEST(ShortLoads, TwoHundredRandomPulsesWithRootsPowersAndArcsEndWhereTheyShould) {
  std::mt19937_64 random(24);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  double worst = 0.0;
  for (int i = 0; i < 200; ++i) {
    const double end = std::pow(10.0, -1.0 + 3.0 * unit(random)), accuracy = std::pow(10.0, -8.0 + 4.0 * unit(random));
    const Load load = random_pulse(random, end);
    const double error = run(load, end, accuracy).error;
    EXPECT_LE(error, 10.0) << i << ": " << load.text << " end " << end << " accuracy " << accuracy;
    worst = std::max(worst, error);
  }
  record("largest error over accuracy", worst);
}

TEST(ShortLoads, AHundredRandomTrainsOfPulsesErrByTwoAccuraciesASecond) {
  std::mt19937_64 random(25);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  double worst = 0.0;
  for (int i = 0; i < 100; ++i) {
    const double end = std::pow(10.0, -1.0 + 3.0 * unit(random)), accuracy = std::pow(10.0, -7.0 + 3.0 * unit(random));
    const Load load = random_train(random, end);
    const double error = run(load, end, accuracy).error / std::max(end, 1.0);
    EXPECT_LE(error, 2.0) << i << ": " << load.text << " end " << end << " accuracy " << accuracy;
    worst = std::max(worst, error);
  }
  record("largest error over accuracy and time", worst);
}

// What an accuracy promises without short loads costs what it did: no step of these is over one.
TEST(ShortLoads, SmoothLoadsTakeTheStepsOfTheirMotion) {
  const Load wave{"10*sin(2*pi*t)", [](double t) { return 10.0 * std::sin(2.0 * M_PI * t); }, {}};
  EXPECT_LE(run(wave, 5.0, 1e-6).steps, 101);
}

// At a corner of a prescribed motion its force jumps; a step of fixed size ends before it, or has it inside.
TEST(ShortLoads, WorkOfAForceThatJumpsIsBookedInFixedStepsToo) {
  for (const char* step : {"1 ms", "3 ms", "0.9 ms"}) {
    for (const char* integrator : {"bathe", "newmark", "hht"}) {
      const auto text = [&](const char* motion) {
        return fmt::format(
            "freeplay: 1\n"
            "bodies: {{m: {{mass: 2, inertia: 1}}}}\n"
            "joints: {{guide: {{type: prismatic, between: [ground, m]}}}}\n"
            "drivers: {{motor: {{joint: guide, kind: velocity, table: {{points: {}}}}}}}\n"
            "simulation: {{end: 3, step: {}, integrator: {}, output: {{interval: 9 ms}}}}\n",
            motion, step, integrator);
      };
      const ModelRun once(text("[[0, 0], [1, 0], [1.01, 1], [3, 1]], interpolation: linear"));
      EXPECT_NEAR(once.last("energy.work"), 1.0, 1e-6) << step << " " << integrator;
      EXPECT_NEAR(once.last("energy.residual"), 0.0, 1e-6) << step << " " << integrator;
      const ModelRun again(text("[[0, 0], [0.01, 1], [0.02, 0]], interpolation: linear, outside: repeat"));
      EXPECT_NEAR(again.last("energy.residual"), 0.0, 1e-6) << step << " " << integrator;
    }
  }
}

// A force that is switched off at the end of a step acts to its end: F t^2/2m, and F t on from there.
TEST(ShortLoads, AStepOfFixedSizeThatEndsAtAJumpHasTheForceBeforeIt) {
  for (const char* integrator : {"bathe", "newmark", "generalized-alpha"}) {
    BuildOptions options;
    options.integrator = integrator;
    const ModelRun run(
        "freeplay: 1\n"
        "bodies: {m: {mass: 1, inertia: 1}}\n"
        "joints: {guide: {type: prismatic, between: [ground, m]}}\n"
        "forces: {hit: {type: force, at: m, value: ['atan2(0, t - 0.7)/pi', 0]}}\n"
        "simulation: {end: 1, step: 10 ms, output: {interval: 0.1}}\n",
        options);
    EXPECT_NEAR(run.last("body.m.x"), 0.5 * 0.7 * 0.7 + 0.7 * 0.3, 1e-9) << integrator;
    EXPECT_NEAR(run.last("energy.residual"), 0.0, 1e-9) << integrator;
  }
}

}  // namespace
}  // namespace freeplay::test
