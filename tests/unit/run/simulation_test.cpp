#include "run/simulation.h"

#include <atomic>
#include <cmath>

#include <gmock/gmock.h>

#include "faulty_joints.h"
#include "validation/run_model.h"

namespace freeplay {
namespace {

using test::mechanism;
using test::ModelRun;
using test::replaced;
using ::testing::HasSubstr;

std::string pendulum(const std::string& simulation) {
  return replaced(mechanism("pendulum"), "simulation: {end: 2 s, step: 1 ms}", "simulation: " + simulation);
}

TEST(Simulation, RowsStandAtTheOutputInstants) {
  const ModelRun run(pendulum("{start: 0.1 s, end: 0.15 s, step: 1 ms, output: {interval: 3.7 ms}}"));
  ASSERT_EQ(run.rows(), 15u);  // 0.1 s, thirteen instants, the end
  for (std::size_t k = 0; k + 1 < run.rows(); ++k) {
    EXPECT_EQ(run.at(k, "time"), 0.1 + static_cast<double>(k) * 0.0037);
  }
  EXPECT_EQ(run.last("time"), 0.15);
  EXPECT_EQ(run.outcome().rows, 15);
  EXPECT_EQ(run.outcome().steps, 13 * 4 + 2);
}

TEST(Simulation, AnIntervalOfManyStepsCutsNone) {
  const ModelRun run(pendulum("{end: 0.5 s, step: 0.1 ms, output: {interval: 1 ms}}"));
  EXPECT_EQ(run.outcome().steps, 5000);
  EXPECT_EQ(run.rows(), 501u);
}

TEST(Simulation, AStepLongerThanTheIntervalIsShortened) {
  const ModelRun run(pendulum("{end: 10 ms, step: 1 s, output: {interval: 1 ms}}"));
  EXPECT_EQ(run.outcome().steps, 10);
}

// A condition is met after the first accepted step past it; that row is the last.
TEST(StopCondition, EndsTheRunPastALimit) {
  const ModelRun run(pendulum("{end: 2 s, step: 1 ms, stop: [{channel: body.rod.omega, below: -3}]}"));
  EXPECT_EQ(run.outcome().status, RunStatus::stopped);
  EXPECT_EQ(run.outcome().exit_code, 0);
  EXPECT_THAT(run.outcome().reason, HasSubstr("body.rod.omega"));
  EXPECT_LT(run.last("body.rod.omega"), -3.0);
  EXPECT_GT(run.last("body.rod.omega"), -3.0 - 0.02);  // one step of 15 rad/s^2
  EXPECT_EQ(run.last("time"), run.outcome().time);
}

TEST(StopCondition, TakesNoNoticeBeforeItsTime) {
  const ModelRun run(pendulum("{end: 2 s, step: 1 ms, stop: [{channel: energy.kinetic, above: -1, after: 0.25 s}]}"));
  EXPECT_EQ(run.outcome().status, RunStatus::stopped);
  EXPECT_NEAR(run.outcome().time, 0.25, 1.001e-3);
  EXPECT_GE(run.outcome().time, 0.25);
}

TEST(StopCondition, ThatIsNeverMetLetsTheRunComplete) {
  const ModelRun run(pendulum("{end: 0.1 s, step: 1 ms, stop: [{channel: body.rod.omega, above: 100}]}"));
  EXPECT_EQ(run.outcome().status, RunStatus::completed);
  EXPECT_EQ(run.outcome().time, 0.1);
  EXPECT_EQ(run.outcome().reason, "");
}

TEST(Simulation, AnInterruptEndsAfterTheStepAndLeavesTheRowsOfTheWholeRun) {
  const std::atomic<int> interrupt{2};
  RunHooks hooks;
  hooks.interrupt = &interrupt;
  const ModelRun run(pendulum("{end: 2 s, step: 1 ms}"), {}, {}, test::builtin_types(), hooks);
  EXPECT_EQ(run.outcome().status, RunStatus::interrupted);
  EXPECT_EQ(run.outcome().exit_code, 130);
  EXPECT_EQ(run.outcome().steps, 1);
  EXPECT_EQ(run.outcome().time, 1e-3);
  EXPECT_EQ(run.rows(), 1u);
  EXPECT_EQ(run.last("time"), 0.0);
}

void expect_sound_rows(const ModelRun& run, double last_time) {
  ASSERT_GT(run.rows(), 10u);
  EXPECT_LE(run.last("time"), last_time);
  EXPECT_GT(run.last("time"), last_time - 2.001e-3);
  for (const double number : run.kept().numbers()) EXPECT_TRUE(std::isfinite(number));
}

TEST(FailedRun, AForceWithoutValueEndsItAndKeepsEarlierRows) {
  const ModelRun run(replaced(pendulum("{end: 1 s, step: 1 ms, output: {interval: 1 ms}}"), "initial:",
                              "forces: {wind: {type: force, at: rod, value: [\"sqrt(0.5 - t)\", 0]}}\ninitial:"));
  EXPECT_EQ(run.outcome().status, RunStatus::failed);
  EXPECT_EQ(run.outcome().exit_code, 4);
  EXPECT_THAT(run.outcome().reason, HasSubstr("t = 0.5"));
  EXPECT_THAT(run.outcome().reason, HasSubstr("wind"));
  expect_sound_rows(run, 0.5);
}

ModelRun run_faulty(const std::string& fault) {
  return ModelRun(replaced(pendulum("{end: 1 s, step: 1 ms, output: {interval: 1 ms}}"), "joints:\n",
                           "joints:\n  bad: {type: faulty, between: [ground, rod], at: 0.25, fault: " + fault + "}\n"),
                  {}, {}, types_with_faulty_joint());
}

TEST(FailedRun, ANaNEndsItAndKeepsEarlierRows) {
  const ModelRun run = run_faulty("nan");
  EXPECT_EQ(run.outcome().status, RunStatus::failed);
  EXPECT_EQ(run.outcome().exit_code, 5);  // the joint is to blame: its markers were finite
  EXPECT_THAT(run.outcome().reason, HasSubstr("'bad'"));
  EXPECT_THAT(run.outcome().reason, HasSubstr("not a finite number"));
  EXPECT_GT(run.outcome().rejected, 0);
  expect_sound_rows(run, 0.25);
}

TEST(FailedRun, AJointThatThrowsEndsItAndIsNamed) {
  const ModelRun run = run_faulty("throw");
  EXPECT_EQ(run.outcome().exit_code, 5);
  EXPECT_THAT(run.outcome().reason, HasSubstr("'bad'"));
  EXPECT_THAT(run.outcome().reason, HasSubstr("out of order"));
  expect_sound_rows(run, 0.25);
}

// Whatever a joint leaves behind: the run ends, the joint and the number are named, and no such number is written.
TEST(FailedRun, NumbersOfAJointThatAreNotFiniteEndItAndAreNamed) {
  const struct {
    const char *fault, *words;
  } cases[] = {{"step", "number 2 of its history is not finite after begin_step()"},
               {"commit", "number 1 of its history is not finite after commit()"},
               {"event-rate", "its event 'alarm' has a rate that is not a finite number"},
               {"event-value", "its event 'alarm' has a value that is not a finite number"},
               {"internal", "number 1 of its internal variables is not finite after on_event()"},
               {"field", "the field 'size' of its event 'alarm' is not a finite number"},
               {"channel", "its channel 'heat' is not a finite number"}};
  for (const auto& c : cases) {
    const ModelRun run = run_faulty(c.fault);
    EXPECT_EQ(run.outcome().status, RunStatus::failed) << c.fault;
    EXPECT_EQ(run.outcome().exit_code, 5) << c.fault;
    EXPECT_THAT(run.outcome().reason, HasSubstr("joint 'bad'"));
    EXPECT_THAT(run.outcome().reason, HasSubstr(c.words));
    expect_sound_rows(run, 0.251);
  }
}

ModelRun run_puck(const std::string& joint, const std::string& settings) {
  return ModelRun(
      "freeplay: 1\nbodies: {puck: {mass: 1, inertia: 0.01, velocity: {linear: [1, 0]}}}\n"
      "joints: {odd: {between: [ground, puck], at: 0.25, " +
          joint + "}}\nsimulation: {end: 1 s, " + settings + "}\n",
      {}, {}, types_with_faulty_joint());
}

// There are no constraints that could have lost rank.
TEST(FailedRun, OfABodyWithoutConstraintsSaysWhyAsAnyOther) {
  for (const char* settings : {"step: 1 ms", "accuracy: 1 um"}) {
    const ModelRun run = run_puck("type: faulty, fault: leap", settings);
    EXPECT_EQ(run.outcome().exit_code, 4);
    EXPECT_THAT(run.outcome().reason, HasSubstr("energy would grow by 1e+06 J"));
    EXPECT_EQ(run.outcome().reason.ends_with("accuracy in place of a step"), std::string(settings) == "step: 1 ms");
  }
}

// Squares of the first speeds of such a motion are below the smallest number.
TEST(Recovery, AMotionThatBeginsFromNextToNothingIsFollowed) {
  for (const char* settings : {"step: 0.1 ms", "accuracy: 1 um"}) {
    const ModelRun run(
        std::string("freeplay: 1\nbodies: {arm: {mass: 3, inertia: 0.1, com: [0.2, 0]}}\n"
                    "joints: {pin: {type: revolute, between: [ground, arm]}}\n"
                    "drivers: {motor: {joint: pin, kind: angle, value: \"0.5*exp(-((t - 1.2)/0.025)^2)\"}}\n"
                    "simulation: {end: 1.4 s, ") +
        settings + "}\n");
    EXPECT_EQ(run.outcome().status, RunStatus::completed) << run.outcome().reason;
  }
}

TEST(FailedRun, AJointThatAllowsNoLengthOfTimeEndsIt) {
  const ModelRun run = run_puck("type: faulty, fault: limit", "accuracy: 1 um");
  EXPECT_EQ(run.outcome().exit_code, 5);
  EXPECT_THAT(run.outcome().reason, HasSubstr("joint 'odd' of type 'faulty'"));
  EXPECT_THAT(run.outcome().reason, HasSubstr("the longest step that it allows is no length of time"));
}

// In steps that suit the body such a variable grows a thousandfold in each with a method that is not stable, and in
// 0.25 s beyond all numbers.
TEST(ErrorControl, KeepsAnInternalVariableThatMovesNothingYet) {
  for (const char* integrator : {"dopri5", "verner7", "bathe", "generalized-alpha"}) {
    const ModelRun run = run_puck("type: fading", std::string("accuracy: 1 um, integrator: ") + integrator);
    EXPECT_EQ(run.outcome().status, RunStatus::completed) << integrator << ": " << run.outcome().reason;
    EXPECT_NEAR(run.last("body.puck.vx"), 1.0 + 0.75 * 1e-2, 1e-5) << integrator;  // 1e3 N/m times z = 1e-5 m
  }
}

// Four iterations for a stage are too few for long steps: they are halved until they converge, and counted.
TEST(Recovery, StepsThatDoNotConvergeAreHalvedAndCounted) {
  const std::string text = pendulum(
      "{end: 1 s, step: 0.1 s, output: {interval: 0.1 s}, integrator: {type: bathe, newton: {max_iterations: 4}}}");
  const ModelRun run(text);
  EXPECT_EQ(run.outcome().status, RunStatus::completed) << run.outcome().reason;
  EXPECT_GT(run.outcome().rejected, 0);
  EXPECT_GT(run.outcome().steps, 10);
  EXPECT_EQ(run.rows(), 11u);
  for (std::size_t k = 0; k < run.rows(); ++k) EXPECT_NEAR(run.at(k, "time"), 0.1 * static_cast<double>(k), 1e-15);
  EXPECT_LT(run.statistics().position_residual(), 1e-10);
}

/// Cannot write from its third row on.
class FullSink final : public Sink {
 public:
  void row(std::span<const double>) override { ++rows_; }
  void event(const EventRecord&) override {}
  bool ok() const override { return rows_ < 3; }

 private:
  int rows_ = 0;
};

TEST(FailedRun, ASinkThatCannotWriteEndsIt) {
  const auto model = test::load(pendulum("{end: 1 s, step: 1 ms, output: {interval: 1 ms}}"));
  System system(*model);
  const Start start = assemble(system);
  const Channels channels(*model);
  FullSink sink;
  Sink* const sinks[] = {&sink};
  Simulation simulation(system, start, channels, sinks);
  const Outcome outcome = simulation.run({});
  EXPECT_EQ(outcome.status, RunStatus::failed);
  EXPECT_EQ(outcome.exit_code, 6);
  EXPECT_LT(outcome.time, 5e-3);
}

// Roundings of positions, divided by the square of a short step, are accelerations that no guess could know.
TEST(Simulation, ShortStepsFollowTheirPredictionInSpiteOfRounding) {
  const std::string text = test::replaced(test::mechanism("slider-crank"), "end: 24 ms, step: 1 us",
                                          "end: 0.2 ms, step: 0.1 us, integrator: bathe");
  const ModelRun run(test::replaced(text, "discard: 12 ms", "discard: 0 ms"));
  ASSERT_EQ(run.outcome().steps, 2000);
  EXPECT_LT(run.outcome().iterations, 2000 * 0.45);  // both stages of one step in sixteen, and of contacts
  EXPECT_LT(run.statistics().position_residual(), 1e-14);
}

// A row of angles of a hundred turns rounds a hundred times as coarsely as one of the first turn.
TEST(Simulation, AnglesOfManyTurnsAreNoTroubleForShortSteps) {
  const std::string gear = R"(
freeplay: 1
space: spatial
bodies:
  a: {mass: 1, inertia: [0.01, 0.01, 0.01]}
  b: {mass: 1, inertia: [0.01, 0.01, 0.01]}
joints:
  A: {type: revolute, between: [ground, a]}
  B: {type: revolute, between: [ground, b]}
  g: {type: gear, of: [A, B], ratio: -2}
initial: {speeds: {A: 1500 rad/s}}
simulation: {end: 0.2 s, step: 20 us, integrator: bathe}
)";
  const std::string planet = R"(
freeplay: 1
bodies:
  crank: {mass: 0.3 kg, inertia: 1.0e-3, frames: {tip: [0.1, 0]}}
  wheel: {mass: 1, inertia: 0.01}
joints:
  A: {type: revolute, between: [ground, crank]}
  W: {type: revolute, between: [crank/tip, wheel]}
  g: {type: gear, of: [A, W], ratio: -7.3}
drivers: {m: {joint: A, kind: velocity, value: 300 rad/s}}
simulation: {end: 0.1 s, step: 5 us, integrator: bathe}
)";
  const std::string spin = R"(
freeplay: 1
gravity: [0, -9.81]
bodies:
  crank: {mass: 0.3 kg, inertia: 1.0e-3, com: [0.05, 0], frames: {tip: [0.1, 0]}}
  p: {mass: 0.3 kg, inertia: 1.0e-3, com: [0.05, 0]}
joints:
  A: {type: revolute, between: [ground, crank]}
  B: {type: revolute, between: [crank/tip, p]}
drivers: {m: {joint: B, kind: velocity, value: 1500 rad/s}}
simulation: {end: 0.1 s, step: 5 us, integrator: bathe}
)";
  for (const std::string& text : {gear, planet, spin}) {
    for (const std::string name : {"bathe", "newmark", "hht", "generalized-alpha"}) {
      const ModelRun run(test::replaced(text, "integrator: bathe", "integrator: " + name));
      EXPECT_EQ(run.outcome().status, RunStatus::completed) << name << text << run.outcome().reason;
      EXPECT_EQ(run.outcome().rejected, 0) << name << text;
    }
  }
}

TEST(Simulation, CountsItsWork) {
  const ModelRun run(pendulum("{end: 0.1 s, step: 1 ms, output: {interval: 1 ms}}"));
  EXPECT_EQ(run.outcome().steps, 100);
  EXPECT_EQ(run.outcome().rejected, 0);
  EXPECT_GE(run.outcome().iterations, 400);  // two stages, two iterations at least
  EXPECT_GE(run.outcome().factorizations, 1);
}

}  // namespace
}  // namespace freeplay
