#include "assembly/assembly.h"

#include <cmath>
#include <optional>

#include <gmock/gmock.h>

#include "validation/puck.h"

namespace freeplay {
namespace {

using test::load;
using test::mechanism;
using test::ModelRun;
using test::replaced;
using ::testing::HasSubstr;

/// The error that putting a model together ends with.
std::optional<Error> failure(const std::string& text) {
  const auto model = load(text);
  try {
    System system(*model);
    assemble(system);
  } catch (const Error& error) {
    return error;
  }
  return std::nullopt;
}

TEST(AssemblyFailure, NamesTheWorstJointAndItsGap) {
  // 0.1 + 0.3 + 0.25 m of links cannot span 1 m: 0.35 m are missing, shared by the joints in some way.
  const auto error = failure(replaced(mechanism("four-bar"), "D: [0.4, 0]", "D: [1, 0]"));
  ASSERT_TRUE(error);
  EXPECT_EQ(error->id(), "assembly-failed");
  EXPECT_EQ(error->category(), Error::Category::input);
  EXPECT_EQ(error->exit_code(), 3);
  EXPECT_THAT(error->message(), HasSubstr("joint '"));
  EXPECT_THAT(error->message(), HasSubstr(" m"));
  EXPECT_GT(error->location().line, 0);
  const std::size_t by = error->message().find(" by ");
  ASSERT_NE(by, std::string::npos) << error->message();
  const double gap = std::stod(error->message().substr(by + 4));
  EXPECT_GT(gap, 0.05);
  EXPECT_LT(gap, 0.6);
}

TEST(AssemblyFailure, TwoDriversThatContradictEachOther) {
  const std::string text = replaced(mechanism("four-bar"), "  motor: {joint: A, kind: velocity, value: $speed}",
                                    "  motor: {joint: A, kind: velocity, value: $speed}\n"
                                    "  other: {joint: D, kind: velocity, value: 100 rpm}");
  const auto error = failure(text);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->id(), "assembly-failed");
  EXPECT_THAT(error->message(), HasSubstr("drivers contradict each other: driver 'motor' and driver 'other'"));
}

TEST(AssemblyFailure, AFreeMotionWithoutMass) {
  const auto error = failure("freeplay: 1\nbodies: {point: {mass: 1, inertia: 0}}\n");
  ASSERT_TRUE(error);
  EXPECT_EQ(error->id(), "singular-mass");
  EXPECT_THAT(error->message(), HasSubstr("'point'"));
}

// A point mass on a massless rod carries mass in every motion that its pin leaves.
TEST(Assembly, APointMassOnAPinIsNoSingularMass) {
  const auto error = failure(
      "freeplay: 1\nbodies: {point: {mass: 1, inertia: 0, com: [1, 0]}}\n"
      "joints: {pivot: {type: revolute, between: [ground, point]}}\n");
  EXPECT_FALSE(error) << error->message();
}

TEST(AssemblyFailure, APathOutOfReachNamesTheLegAndTheTime) {
  const auto error = failure(replaced(mechanism("3-rrr"), "R: 50 mm", "R: 300 mm"));
  ASSERT_TRUE(error);
  EXPECT_EQ(error->id(), "ik-unreachable");
  EXPECT_EQ(error->exit_code(), 3);
  EXPECT_THAT(error->message(), HasSubstr("leg"));
  EXPECT_THAT(error->message(), HasSubstr("t = 0"));
}

// Without millimetres.
TEST(AssemblyFailure, APathOfLoopsOutOfReachNamesItsPlace) {
  const auto error =
      failure(replaced(mechanism("five-bar"), "{x: 40 mm*cos(4*pi*t/1 s), y: 250 mm + 40 mm*sin(4*pi*t/1 s)}",
                       "{x: 40*cos(4*pi*t), y: 250 + 40*sin(4*pi*t)}"));
  ASSERT_TRUE(error);
  EXPECT_EQ(error->id(), "ik-unreachable");
  EXPECT_THAT(error->message(), HasSubstr("begins at x = 40 m, y = 250 m: is that within reach?"));
}

// The path leaves the reach of a leg on the way: rows before stay, and the reason names leg and time.
TEST(AssemblyFailure, APathThatLeavesTheReachLaterEndsTheRun) {
  std::string text = replaced(mechanism("3-rrr"), "x: $R*cos(2*pi*t/$T), y: $R*sin(2*pi*t/$T)", "x: 0, y: 10*t");
  text = replaced(text, "{interval: 0.1 ms, discard: $T/5}", "{interval: 1 ms}");
  const ModelRun run(text, {.set = {}, .ideal = {"all"}, .end = 0.1, .step = 1e-3, .integrator = {}});
  EXPECT_EQ(run.outcome().status, RunStatus::failed);
  EXPECT_EQ(run.outcome().exit_code, 4);
  EXPECT_THAT(run.outcome().reason, HasSubstr("leg"));
  EXPECT_THAT(run.outcome().reason, HasSubstr("ik-unreachable"));
  // Leg 1 stands at (-0.346, -0.2), its pin on the platform at (-0.095, -0.055): it reaches 0.48 m, so far as the
  // platform has moved up by y with (0.251, 0.145 + y) of that length.
  const double limit = std::sqrt(0.48 * 0.48 - std::pow(0.29 * std::cos(M_PI / 6.0), 2)) - 0.145;
  EXPECT_NEAR(run.outcome().time, limit / 10.0, 1.1e-3);
  ASSERT_GT(run.rows(), 10u);
  EXPECT_LE(run.last("time"), limit / 10.0);
  EXPECT_NEAR(run.last("body.platform.y"), 10.0 * run.last("time"), 1e-12);
}

TEST(StartValues, AVelocityDriverStartsWhereInitialSays) {
  const ModelRun run(mechanism("four-bar"));
  EXPECT_NEAR(run.at(0, "driver.motor.value"), 2.0 * M_PI, 1e-15);  // what the file prescribes: the speed
  EXPECT_NEAR(run.at(0, "joint.A.angle"), M_PI / 3.0, 1e-12);
  EXPECT_NEAR(run.at(0, "joint.A.speed"), 2.0 * M_PI, 1e-12);
  EXPECT_NEAR(run.last("joint.A.angle"), M_PI / 3.0 + 4.0 * M_PI, 1e-10);
}

TEST(StartValues, AVelocityDriverWithoutInitialStartsWhereTheMechanismWasPutTogether) {
  const ModelRun run(replaced(mechanism("four-bar"), "initial: {joints: {A: 60 deg}}\n", ""));
  const double start = run.at(0, "joint.A.angle");
  EXPECT_NEAR(run.last("joint.A.angle"), start + 4.0 * M_PI, 1e-10);
  EXPECT_LT(run.statistics().position_residual(), 1e-10);
}

TEST(StartValues, InitialSpeedsAreHeldExactly) {
  const ModelRun run(replaced(mechanism("pendulum"), "initial: {joints: {pivot: 0 deg}}",
                              "initial: {joints: {pivot: 30 deg}, speeds: {pivot: 2.5}}"));
  EXPECT_NEAR(run.at(0, "joint.pivot.angle"), M_PI / 6.0, 1e-15);
  EXPECT_NEAR(run.at(0, "joint.pivot.speed"), 2.5, 1e-14);
  EXPECT_NEAR(run.at(0, "body.rod.vx"), -0.5 * std::sin(M_PI / 6.0) * 2.5, 1e-14);
}

TEST(StartValues, AJointMayLeadThroughMoreThanOneTurn) {
  const ModelRun run(replaced(mechanism("pendulum"), "pivot: 0 deg", "pivot: 800 deg"));
  EXPECT_NEAR(run.at(0, "joint.pivot.angle"), 800.0 * M_PI / 180.0, 1e-13);
}

TEST(StartValues, AJournalStandsAndMovesAsTheBlockSays) {
  test::Puck puck;
  puck.x = 3e-5;
  puck.y = -4e-5;
  puck.vx = -0.02;
  puck.vy = 0.01;
  const ModelRun run = puck.run();
  EXPECT_NEAR(run.at(0, "joint.ring.ex"), 3e-5, 1e-19);
  EXPECT_NEAR(run.at(0, "joint.ring.ey"), -4e-5, 1e-19);
  EXPECT_NEAR(run.at(0, "body.puck.vx"), -0.02, 1e-16);
  EXPECT_NEAR(run.at(0, "body.puck.vy"), 0.01, 1e-16);
}

// K delta^1.5 carries the weight; nothing moves.
TEST(StartValues, ALoadedJournalRestsWhereContactCarriesTheReaction) {
  test::Puck puck;
  puck.sections = "gravity: [0, -9.81]\n";
  puck.end = 2e-3;
  puck.step = 2e-6;
  const std::string text = puck.text();
  const std::size_t from = text.find("initial: {eccentricity");
  const ModelRun run(std::string(text).replace(from, text.find("}}", from) + 1 - from, "initial: loaded"));
  const double rest = std::pow(0.2 * 9.81 / 7.50621044644181e10, 2.0 / 3.0);
  EXPECT_NEAR(run.at(0, "joint.ring.ey"), -(1e-4 + rest), 1e-12 * 1e-4);
  EXPECT_NEAR(run.at(0, "joint.ring.fn"), 0.2 * 9.81, 1e-8);
  EXPECT_NEAR(run.at(0, "joint.ring.fy"), 0.2 * 9.81, 1e-8);
  EXPECT_NEAR(run.last("joint.ring.ey"), run.at(0, "joint.ring.ey"), 1e-13);
  EXPECT_NEAR(run.last("body.puck.vy"), 0.0, 1e-9);
}

TEST(ModelFacts, CountRowsAndFreedomsOfTheParallelMechanisms) {
  const struct {
    const char* model;
    int bodies, rows, drivers, redundant_ideal, free_ideal, free;
  } cases[] = {{"3-rrr", 7, 18, 3, 0, 3, 15}, {"4-rrr", 9, 24, 4, 1, 3, 19}};
  for (const auto& c : cases) {
    const auto model = load(mechanism(c.model));
    System system(*model);
    const ModelFacts facts = assemble(system).facts;
    ASSERT_TRUE(facts.ideal);
    EXPECT_EQ(facts.bodies, c.bodies);
    EXPECT_EQ(facts.velocities, 3 * c.bodies);
    EXPECT_EQ(facts.driver_constraints, c.drivers);
    EXPECT_EQ(facts.ideal->constraints, c.rows);
    EXPECT_EQ(facts.ideal->rank, c.rows);
    EXPECT_EQ(facts.ideal->dof, c.free_ideal);
    EXPECT_EQ(facts.ideal->dof_driven, 0);
    EXPECT_EQ(facts.ideal->driver_redundant, c.redundant_ideal);
    EXPECT_EQ(facts.actual.dof, c.free);
    EXPECT_EQ(facts.actual.dof_driven, c.free - c.drivers);
    EXPECT_EQ(facts.actual.driver_redundant, 0);
  }
}

}  // namespace
}  // namespace freeplay
