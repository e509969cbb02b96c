// Accuracy that is kept: on smooth motion positions err by no more than 2 L after a second, by every integrator.
#include <algorithm>
#include <map>

#include "minimal_coordinates.h"
#include "run_model.h"

namespace freeplay::test {
namespace {

constexpr double allowed = 2.0;  // error over accuracy and simulated time
constexpr int intervals = 47;    // of rows, which lie inside steps but for the last

BuildOptions accurate(double accuracy, const std::string& integrator) {
  BuildOptions options;
  options.accuracy = accuracy;
  options.integrator = integrator;
  return options;
}

struct Smooth {
  const char* name;
  std::string text;
  double end;   ///< [s]
  double size;  ///< by which angles count [m]
};
void PrintTo(const Smooth& model, std::ostream* out) { *out << model.name; }

/// `text` with another end of its simulation section and rows at every 47th part of it.
std::string with_rows(const std::string& text, double end) {
  const std::size_t from = text.rfind("simulation: {");
  return text.substr(0, from) + "simulation: {end: " + number(end) +
         ", accuracy: 1 um, output: {interval: " + number(end / intervals) + "}}" + text.substr(text.find('\n', from));
}

// The crank is let go: at a constant speed nothing in it could err.
std::string free_four_bar() {
  std::string text = replaced(mechanism("four-bar"), "drivers:", "gravity: [0, -9.81]\n#");
  text = replaced(text, "  motor: {joint: A, kind: velocity, value: $speed}\n", "");
  return replaced(text, "{joints: {A: 60 deg}}", "{joints: {A: 60 deg}, speeds: {A: $speed}}");
}

const Smooth models[] = {
    {"Pendulum", mechanism("pendulum"), 1.0, 1.0},
    {"DoublePendulum", mechanism("validation/double-pendulum"), 1.0, 2.0},
    {"FourBar", free_four_bar(), 0.5, 0.4},
    {"HeavyTop", mechanism("spatial/heavy-top"), 0.1, 0.04},
    {"NutatingTop", replaced(mechanism("spatial/heavy-top"), "$own*cos($tilt) + $W]", "$own*cos($tilt)]"), 0.1, 0.04},
    {"Squeezer", mechanism("validation/squeezer"), 0.01, 0.1}};

/// Largest difference of positions, and of turns times `size`, between two runs with the same rows [m].
double largest_difference(const ModelRun& run, const ModelRun& reference, double size) {
  double largest = 0.0;
  for (const std::string& name : run.kept().names()) {
    if (!name.starts_with("body.")) continue;
    const std::string part = name.substr(name.rfind('.') + 1);
    const bool quaternion = part.size() == 2 && part[0] == 'q';
    if (part != "x" && part != "y" && part != "z" && part != "angle" && !quaternion) continue;
    const double unit = part == "angle" ? size : quaternion ? 2.0 * size : 1.0;
    for (std::size_t row = 1; row < run.rows(); ++row) {
      largest = std::max(largest, unit * std::abs(run.at(row, name) - reference.at(row, name)));
    }
  }
  return largest;
}

using Case = std::tuple<Smooth, const char*>;
class KeptAccuracy : public ::testing::TestWithParam<Case> {};

TEST_P(KeptAccuracy, IsNoMoreThanTwiceTheAccuracyPerSecond) {
  const auto& [model, integrator] = GetParam();
  static std::map<std::string, std::unique_ptr<ModelRun>> references;
  const std::string text = with_rows(model.text, model.end);
  std::unique_ptr<ModelRun>& reference = references[model.name];
  if (!reference) reference = std::make_unique<ModelRun>(text, accurate(3e-13, "verner7"));
  ASSERT_EQ(reference->outcome().status, RunStatus::completed) << reference->outcome().reason;
  for (const double accuracy : {1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9}) {
    const ModelRun run(text, accurate(accuracy, integrator));
    ASSERT_EQ(run.outcome().status, RunStatus::completed) << run.outcome().reason;
    ASSERT_EQ(run.rows(), intervals + 1u);
    const double part = largest_difference(run, *reference, model.size) / (accuracy * model.end);
    record("part_at_" + number(accuracy), part);
    EXPECT_LE(part, allowed) << accuracy << " m";
  }
}

INSTANTIATE_TEST_SUITE_P(Smooth, KeptAccuracy,
                         ::testing::Combine(::testing::ValuesIn(models),
                                            ::testing::Values("dopri5", "verner6", "verner7", "bathe",
                                                              "generalized-alpha", "hht", "newmark")),
                         [](const auto& made) {
                           std::string name = std::get<0>(made.param).name + std::string("_") + std::get<1>(made.param);
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

// The reference of the others, against one that shares nothing with the program.
struct RodErrors {
  double position = 0.0, force = 0.0;
};
RodErrors rod_errors(const char* integrator, double accuracy, double end, int count, std::size_t first) {
  static const auto known = RodChain<1>::integrate({0.0L}, 0.01, 100);
  const ModelRun run(
      replaced(mechanism("pendulum"), "{end: 2 s, step: 1 ms}",
               "{end: " + number(end) + ", accuracy: 1 um, output: {interval: " + number(end / count) + "}}"),
      accurate(accuracy, integrator));
  EXPECT_EQ(run.outcome().status, RunStatus::completed) << run.outcome().reason;
  RodErrors errors;
  for (std::size_t row = first; row < run.rows(); ++row) {
    const auto& [angle, rate, acceleration] =
        known.at(static_cast<std::size_t>(std::lround(100.0 * run.at(row, "time"))));
    const long double q = angle[0], w = rate[0], a = acceleration[0], c = std::cos(q), s = std::sin(q);
    const auto off = [&](const char* name, long double value) {
      return std::abs(run.at(row, name) - static_cast<double>(value));
    };
    errors.position =
        std::max({errors.position, off("body.rod.x", 0.5L * c), off("body.rod.y", 0.5L * s), off("body.rod.angle", q)});
    errors.force = std::max({errors.force, off("joint.pivot.fx", 0.5L * (-s * a - c * w * w)),
                             off("joint.pivot.fy", 0.5L * (c * a - s * w * w) + 9.81L)});
  }
  return errors;
}

TEST(RowsInsideSteps, ErrNoMoreThanStepsDo) {
  for (const char* integrator : {"dopri5", "verner6", "verner7", "bathe"}) {
    for (const double accuracy : {1e-5, 1e-7, 1e-9}) {
      RodErrors at_steps;
      for (int k = 1; k <= 20; ++k) {  // the last row of a run is the end of its last step
        const RodErrors last = rod_errors(integrator, accuracy, 0.05 * k, 1, 1);
        at_steps.position = std::max(at_steps.position, last.position);
        at_steps.force = std::max(at_steps.force, last.force);
      }
      const RodErrors inside = rod_errors(integrator, accuracy, 1.0, 100, 1);
      record(std::string(integrator) + "_inside_over_steps_" + number(accuracy), inside.position / at_steps.position);
      EXPECT_LE(inside.position, 2.0 * at_steps.position + 2e-13) << integrator << " " << accuracy;
      // What an end errs by, a row's velocity makes up for within the step: 0.1 L/s on 1 kg at 4 m/s.
      EXPECT_LE(inside.force, 2.0 * at_steps.force + 0.8 * accuracy) << integrator << " " << accuracy;
    }
  }
}

// The swing loses no energy, and the books of a row inside a step say so as well as those of its end.
TEST(RowsInsideSteps, KnowTheirEnergy) {
  for (const double end : {0.3, 0.4, 0.5, 0.6, 0.7}) {
    const ModelRun run(with_rows(free_four_bar(), end), accurate(1e-7, "verner7"));
    for (std::size_t row = 1; row < run.rows(); ++row) EXPECT_NEAR(run.at(row, "energy.residual"), 0.0, 1e-8) << row;
  }
}

}  // namespace
}  // namespace freeplay::test
