// Runs with error control: located events, orders through impacts, accuracy that is asked for.
#include "puck.h"

namespace freeplay::test {
namespace {

/// `text` with the steps of its simulation section replaced.
std::string with_steps(const std::string& text, double step, const std::string& steps) {
  return replaced(text, ", step: " + number(step) + ",", ", " + steps + ",");
}

BuildOptions accurate(double accuracy, double end, const std::optional<std::string>& integrator = std::nullopt) {
  BuildOptions options;
  options.accuracy = accuracy;
  options.end = end;
  options.integrator = integrator;
  return options;
}

struct Flight {
  double r0[2], v0[2];
  const char* gravity;
  double time, normal, tangential;
};

// Roots of the quartic |e(t)| = c in 34 digits.
TEST(LocatedEvent, FirstContactIsTheRootOfTheParabola) {
  const Flight flights[] = {
      {{0.0, 0.0}, {0.05, 0.0}, "[0, -9.81]", 0.00196388550299565, 0.0527417933072436, -0.00945891547441952},
      {{3e-05, -4e-05}, {-0.02, 0.01}, "[12, -9.81]", 0.00421981293940259, 0.042800093435473, 0.00962059152226299},
      {{0.0, 9e-05}, {0.1, 0.3}, "[0, 0]", 3.31501278244824e-05, 0.303150127824482, -0.09}};
  for (const Flight& want : flights) {
    Puck puck;
    puck.x = want.r0[0];
    puck.y = want.r0[1];
    puck.vx = want.v0[0];
    puck.vy = want.v0[1];
    puck.sections = std::string("gravity: ") + want.gravity + "\n";
    for (const char* integrator : {"dopri5", "bathe"}) {
      const ModelRun run(puck.text(), accurate(1e-9, want.time + 1e-4, integrator));
      ASSERT_EQ(run.outcome().status, RunStatus::completed) << run.outcome().reason;
      ASSERT_FALSE(run.events().empty()) << integrator;
      const Event& begin = run.events().front();
      // Flight under constant acceleration is a parabola for every integrator; the event is as sharp as 1e-11 s.
      EXPECT_NEAR(begin.time, want.time, 2e-11) << integrator;
      EXPECT_NEAR(begin.fields[speed], want.normal, 1e-9 * want.normal) << integrator;
      EXPECT_NEAR(begin.fields[tangential_speed], want.tangential, 1e-8 * want.normal) << integrator;
    }
  }
}

// Closed form of the duration and of the rebound (contact.json, Hertz and Lankarani-Nikravesh).
TEST(LocatedEvent, ImpactTakesTheStepsThatAreAskedFor) {
  for (const double per_contact : {20.0, 50.0}) {
    Puck puck;
    puck.y = -0.099e-3;
    puck.vy = -0.1;
    puck.end = 1e-5 + 1.4 * 0.000119629579928;
    const ModelRun run(with_steps(
        puck.text(), puck.step,
        "step: {size: 1e-6, max: 1e-3, adaptive: true, tolerance: 0.01, per_contact: " + number(per_contact) + "}"));
    const auto all = contacts(run);
    ASSERT_EQ(all.size(), 1u);
    EXPECT_GE(all[0].end.fields[steps], per_contact);
    EXPECT_LE(all[0].end.fields[steps], 1.5 * per_contact);
    EXPECT_NEAR(all[0].end.fields[duration], 0.000119629579928, 3e-3 * 0.00012);  // of 20 steps and order 2
  }
}

TEST(LocatedEvent, EnergyOfAnElasticImpactIsNotLost) {
  Puck puck;
  puck.y = -0.099e-3;
  puck.vy = -0.1;
  puck.end = 1e-5 + 1.4 * 0.000119629579928;
  const ModelRun run(puck.text(), accurate(1e-10, puck.end));
  const auto all = contacts(run);
  ASSERT_EQ(all.size(), 1u);
  const double energy = 0.5 * 0.2 * 0.1 * 0.1;
  EXPECT_NEAR(all[0].end.fields[speed], 0.1, 1e-9);
  EXPECT_NEAR(run.last("energy.dissipated"), 0.0, 1e-8 * energy);
  EXPECT_NEAR(run.last("energy.residual"), 0.0, 1e-8 * energy);
}

/// The drop with unit mass, stiffness and speed, restitution 0.9, and a constant push of 0.05 toward the ring, in steps
/// of one size but for those that end at the events. Rebound speed.
double unit_rebound(const std::string& integrator, double step, double phase) {
  constexpr double push = 0.05;
  Puck puck;
  puck.mass = 1.0;
  puck.ring = "radial_clearance: 100";
  puck.contact = "{law: lankarani-nikravesh, K: 1, restitution: 0.9}";
  const double wait = phase * step;
  puck.vy = -(1.0 - push * wait);
  puck.y = -(100.0 - (wait - 0.5 * push * wait * wait));
  puck.sections = "forces: {push: {type: force, at: puck, value: [0, " + number(-push) + "]}}\n";
  puck.step = step;
  puck.end = 5.0;
  puck.integrator = integrator;
  const std::string h = number(step);
  const ModelRun run(with_steps(
      puck.text(), step, "step: {size: " + h + ", max: " + h + ", adaptive: true, tolerance: 0.1, per_contact: 2}"));
  EXPECT_EQ(run.outcome().status, RunStatus::completed) << run.outcome().reason;
  const auto all = contacts(run);
  EXPECT_EQ(all.size(), 1u);
  return all.empty() ? 0.0 : all[0].end.fields.at(speed);
}

// The rebound of the known study, 0.901222060959, with a push that a wrong approach speed would show. The error of
// every step is taken off, which makes the order one more than that of the method; the force law bends like x^1.5.
TEST(LocatedEvent, MethodsOfOrderTwoHaveOneMoreThroughAnImpact) {
  for (const char* integrator : {"bathe", "hht", "generalized-alpha", "newmark"}) {
    std::vector<double> errors;
    for (const int steps : {40, 160, 640}) {
      double worst = 0.0;
      for (int phase = 0; phase < 6; ++phase) {
        const double rebound = unit_rebound(integrator, 3.21806545971904 / steps, (phase + 0.5) / 6.0);
        worst = std::max(worst, std::abs(rebound / 0.901222060959 - 1.0));
      }
      errors.push_back(worst);
      record(std::string(integrator) + "_error_at_" + std::to_string(steps), worst);
    }
    const double mean_order = order(errors[0], errors[2]) / 4.0;
    record(std::string(integrator) + "_order", mean_order);
    EXPECT_GE(mean_order, 2.7) << integrator;
    EXPECT_LE(mean_order, 3.4) << integrator;
  }
}

// Quadruple precision, every contact located.
TEST(Accuracy, ThreeRrrAtOneNanometreFollowsTheReferenceForTwentyMilliseconds) {
  const std::string text = replaced(mechanism("3-rrr"), "{interval: 0.1 ms, discard: $T/5}", "{interval: 1 ms}");
  const ModelRun run(text, accurate(1e-9, 20e-3));
  ASSERT_EQ(run.outcome().status, RunStatus::completed) << run.outcome().reason;
  const double worst = largest_distance(run, read_table("rrr3_friction_trajectory.csv"));
  record("worst_distance", worst);
  EXPECT_LE(worst, 1e-8);
  EXPECT_LT(run.statistics().position_residual(), 1e-12);
  const std::pair<const char*, double> known[] = {{"leg1.B", 0.00548333785509636}, {"leg3.B", 0.00590306015414261},
                                                  {"leg1.C", 0.0067390359026056},  {"leg3.C", 0.00744866421410308},
                                                  {"leg2.B", 0.00844143722135433}, {"leg2.C", 0.00851851940436134}};
  for (const auto& [joint, time] : known) {
    const auto first =
        std::ranges::find_if(run.events(), [&joint = joint](const Event& e) { return e.joint == joint; });
    ASSERT_NE(first, run.events().end()) << joint;
    EXPECT_NEAR(first->time, time, 1e-9) << joint;
  }
}

TEST(Accuracy, SliderCrankAtOneNanometreFollowsTheReferenceForThirtyMilliseconds) {
  std::string text = replaced(mechanism("slider-crank"), "contact: {law: lankarani-nikravesh, restitution: 0.9}",
                              "contact: {law: lankarani-nikravesh, restitution: 0.9}\n"
                              "      friction: {law: ambrosio, mu: 0.1, v0: 1e-4, v1: 1e-3}");
  text = replaced(text, "output: {interval: 20 us, discard: 12 ms}", "output: {interval: 1 ms}");
  const ModelRun run(text, accurate(1e-9, 30e-3));
  ASSERT_EQ(run.outcome().status, RunStatus::completed) << run.outcome().reason;
  const double worst = largest_distance(run, read_table("slider_crank_friction_trajectory.csv"));
  record("worst_distance", worst);
  EXPECT_LE(worst, 1e-8);
}

// Time integral of |driver power| of the 3-RRR over 20 ms, from its own rows: the unit of the residual.
TEST(Accuracy, EnergyResidualFallsWithTheAccuracy) {
  std::vector<double> residuals;
  for (const double accuracy : {1e-6, 1e-8, 1e-9}) {
    const ModelRun run(mechanism("3-rrr"), accurate(accuracy, 20e-3));
    double worst = 0.0, work = 0.0;
    for (std::size_t row = 0; row < run.rows(); ++row) {
      worst = std::max(worst, std::abs(run.at(row, "energy.residual")));
      for (const char* driver : {"driver.leg1.A.power", "driver.leg2.A.power", "driver.leg3.A.power"}) {
        work += 1e-4 * std::abs(run.at(row, driver));
      }
    }
    residuals.push_back(worst / work);
    record("residual_at_" + number(accuracy), worst / work);
  }
  EXPECT_LE(residuals[2], 1e-6);
  EXPECT_LT(residuals[1], residuals[0] / 10.0);
  EXPECT_LT(residuals[2], residuals[1]);
}

// Free flight, contact and lasting contact: rows come from inside the steps and are states of the same motion.
TEST(Accuracy, OutputDoesNotChangeTheMotion) {
  const std::string text = mechanism("3-rrr");
  const ModelRun many(text, accurate(1e-8, 10e-3));
  const ModelRun few(replaced(text, "interval: 0.1 ms", "interval: 5 ms"), accurate(1e-8, 10e-3));
  ASSERT_EQ(few.rows(), 3u);
  ASSERT_EQ(many.rows(), 101u);
  EXPECT_EQ(many.outcome().steps, few.outcome().steps);
  EXPECT_NEAR(many.last("body.platform.x"), few.last("body.platform.x"), 1e-13);
  EXPECT_NEAR(many.at(50, "body.platform.x"), few.at(1, "body.platform.x"), 1e-13);
  EXPECT_NEAR(many.at(50, "driver.leg1.A.torque"), few.at(1, "driver.leg1.A.torque"), 1e-8);
}

TEST(Accuracy, RowsInsideLongStepsSatisfyTheEquations) {
  // A pendulum of 1 m: period 1.6 s, steps of tens of milliseconds, rows at every millisecond.
  const ModelRun run(mechanism("pendulum"), accurate(1e-9, 2.0));
  ASSERT_GT(run.rows(), 10u * static_cast<std::size_t>(run.outcome().steps) / 10u);
  for (std::size_t row = 0; row < run.rows(); ++row) {
    const double angle = run.at(row, "body.rod.angle"), omega = run.at(row, "body.rod.omega");
    EXPECT_NEAR(run.at(row, "body.rod.x"), 0.5 * std::cos(angle), 1e-13);
    EXPECT_NEAR(run.at(row, "body.rod.vy"), 0.5 * std::cos(angle) * omega, 1e-12);
    // m g l/2 sin(angle) + (m l^2/3) omega^2/2 = 0 from rest at the horizontal; energy shared by no other term.
    EXPECT_NEAR(9.81 * 0.5 * std::sin(angle) + omega * omega / 6.0, 0.0, 1e-8);
  }
}

TEST(StepBound, FailureNamesTheJointThatForcesTheSmallStep) {
  Puck puck;
  puck.y = -0.099e-3;
  puck.vy = -0.1;
  puck.end = 3e-4;
  const ModelRun run(
      with_steps(puck.text(), puck.step, "step: {size: 1e-5, min: 9e-6, max: 1e-3, adaptive: true, tolerance: 1e-6}"));
  EXPECT_EQ(run.outcome().exit_code, 4);
  EXPECT_NE(run.outcome().reason.find("joint 'ring'"), std::string::npos) << run.outcome().reason;
}

// The impulse of the push is that between the middles of its ramps, 0.3 N s; the accuracy is one per second.
TEST(StepBound, BodyAtRestIsNotLeftAloneWhileSomethingPushesIt) {
  for (const double begin : {1.3, 3.1, 5.0, 7.7}) {
    const auto ramp = [&](double after) {
      return "smooth(t, " + number(begin + after) + ", " + number(begin + after + 0.1) + ")";
    };
    const std::string push = ramp(0.0) + " - " + ramp(0.3);
    const ModelRun run(
        "freeplay: 1\nbodies: {sled: {mass: 2, inertia: 1}}\n"
        "joints: {rail: {type: prismatic, between: [ground, sled]}}\n"
        "forces: {push: {type: force, at: sled, value: ['" +
        push +
        "', 0]}}\n"
        "simulation: {end: 10, accuracy: 1e-6, output: {interval: 10}}\n");
    EXPECT_NEAR(run.last("body.sled.vx"), 0.15, 1e-5) << begin;
  }
}

TEST(LawOutsideItsRange, IsToldOnceForEachJointWithNumbers) {
  const std::unique_ptr<Model> model = load(mechanism("slider-crank"), accurate(1e-6, 2e-3));
  System system(*model);
  const Start start = assemble(system);
  const Channels channels(*model);
  Simulation simulation(system, start, channels, {});
  simulation.run({});
  ASSERT_EQ(simulation.warnings().size(), 1u);
  EXPECT_NE(simulation.warnings()[0].find("joint 'wrist'"), std::string::npos) << simulation.warnings()[0];
  EXPECT_NE(simulation.warnings()[0].find("delta = 5."), std::string::npos) << simulation.warnings()[0];
}

// A drum in a tub on rubber, with a size of 10 mm: its angle of 120 rad rounds to 1e-14 and is shared by both.
TEST(AdaptiveRun, GoesOnAfterManyTurnsOnABodyThatMoves) {
  for (const char* integrator : {"dopri5", "verner7", "bathe"}) {
    const ModelRun run(
        "freeplay: 1\nbodies: {tub: {mass: 20, inertia: 0.8}, drum: {mass: 6, inertia: 0.2, com: [10 mm, 0]}}\n"
        "joints: {axle: {type: revolute, between: [tub, drum]}}\n"
        "drivers: {motor: {joint: axle, kind: velocity, value: \"80*smooth(t, 0, 1)\"}}\n"
        "forces: {mount: {type: bushing, between: [ground, tub], stiffness: {x: 5e3, y: 5e3, turn_z: 400}, "
        "damping: {x: 100, y: 100, turn_z: 5}}}\n"
        "simulation: {end: 2, accuracy: 1 um, output: {interval: 0.5}, integrator: " +
        std::string(integrator) + "}\n");
    EXPECT_EQ(run.outcome().status, RunStatus::completed) << integrator << ": " << run.outcome().reason;
    EXPECT_NEAR(run.last("joint.axle.angle"), 120.0, 1e-10) << integrator;
  }
}

// Rounding moves the fan to and fro in steps far beyond the period of the belt.
TEST(AdaptiveRun, WhatStandsStillOnAStiffBeltGoesOn) {
  const std::string driven = mechanism("gallery/belt-drive");
  const std::size_t drivers = driven.find("\ndrivers:");
  ASSERT_NE(drivers, std::string::npos);
  const std::string text = driven.substr(0, drivers) + driven.substr(driven.find("\nsimulation:"));
  const ModelRun run(text);
  EXPECT_EQ(run.outcome().status, RunStatus::completed) << run.outcome().reason;
  EXPECT_NEAR(run.last("body.fan.angle"), 0.0, 1e-9);
}

// Teeth with play have no constraint equation, wherever it would stand.
TEST(AdaptiveRun, TeethWithPlayMeshBetweenAnIdealPinAndALooseOne) {
  for (const char* order : {"A, B", "B, A"}) {
    for (const char* integrator : {"bathe", "dopri5"}) {
      const ModelRun run(
          "freeplay: 1\nbodies: {a: {mass: 0.5, inertia: 1e-4}, b: {mass: 1.5, inertia: 1.5e-3}}\n"
          "frames: {ground/b: [60 mm, 0]}\njoints: {A: {type: revolute, between: [ground, a]}, "
          "B: {type: revolute, between: [ground/b, b], clearance: {radial_clearance: 30 um, bearing_radius: 8 mm, "
          "contact: {law: hertz, K: 3e9}}}, "
          "mesh: {type: gear, of: [" +
          std::string(order) + "], ratio: " + (order[0] == 'A' ? "-0.5" : "-2") +
          ", clearance: {pitch_radius: " + (order[0] == 'A' ? "40 mm" : "20 mm") +
          ", gap: 40 um, contact: {law: hertz, K: 1e9}}}}\n"
          "drivers: {motor: {joint: A, kind: velocity, value: 20}}\nsimulation: {end: 50 ms, " +
          (integrator[0] == 'b' ? "step: 10 us" : "accuracy: 1 um") + ", integrator: " + integrator + "}\n");
      EXPECT_EQ(run.outcome().status, RunStatus::completed)
          << order << ' ' << integrator << ": " << run.outcome().reason;
      EXPECT_NEAR(run.last("body.b.angle"), -0.5, 2e-3) << order << ' ' << integrator;
    }
  }
}

}  // namespace
}  // namespace freeplay::test
