// Runs that cannot go on: formulas that lose their value, joints that ask for steps too short.
#include <atomic>
#include <cmath>
#include <cstdio>
#include <limits>

#include <gmock/gmock.h>

#include "validation/run_model.h"

namespace freeplay {
namespace {

using test::ModelRun;

/// A rod on a pin that falls from rest, with further sections.
std::string falling_rod(const std::string& sections, const std::string& simulation) {
  return "freeplay: 1\n"
         "gravity: [0, -10]\n"
         "bodies: {rod: {mass: 1, inertia: 0.1, com: [0.5, 0], frames: {tip: [1, 0]}}, cart: {mass: 1, inertia: 1}}\n"
         "joints: {A: {type: revolute, between: [ground, rod]}, B: {type: prismatic, between: [ground, cart]}}\n" +
         sections + "\nsimulation: {end: 0.4, " + simulation + "}\n";
}

struct LostValue {
  const char *sections, *said;
  double time;  ///< [s]; NaN: when the motion comes there
};
constexpr double by_motion = std::numeric_limits<double>::quiet_NaN();

constexpr LostValue lost_values[] = {
    {"forces: {w: {type: force, at: rod/tip, value: [sqrt(0.25 - t), 0]}}",
     "force 'w': square root of a negative number [bad-expression]", 0.25},
    {"forces: {w: {type: force, at: rod/tip, value: [abs(t - 0.25) + sqrt(0.25 - t), 0]}}",
     "force 'w': square root of a negative number [bad-expression]", 0.25},
    {"forces: {w: {type: torque, on: rod, value: 'sqrt(joint.A.angle + 0.3)*1 N*m'}}",
     "force 'w': square root of a negative number [bad-expression]", by_motion},
    {"forces: {w: {type: force, at: rod/tip, value: ['log(frame.rod/tip.x/(0.9 m) - 1)*1 N', 0]}}",
     "force 'w': logarithm of a number that is not positive [bad-expression]", by_motion},
    {"drivers: {m: {joint: A, kind: torque, value: sqrt(0.25 - t)}}",
     "driver 'm': square root of a negative number [bad-expression]", 0.25},
    {"drivers: {m: {joint: A, kind: torque, value: abs(t - 0.25) + sqrt(0.25 - t)}}",
     "driver 'm': square root of a negative number [bad-expression]", 0.25},
    {"drivers: {m: {joint: A, kind: torque, value: 'sqrt(joint.A.angle + 0.3)*1 N*m'}}",
     "driver 'm': square root of a negative number [bad-expression]", by_motion},
    {"drivers: {m: {joint: A, kind: torque, value: 'abs(t - 0.25)*1 N*m + sqrt(0.25 - t)*joint.A.angle*1 N*m'}}",
     "driver 'm': square root of a negative number [bad-expression]", 0.25},
    {"drivers: {m: {joint: A, kind: angle, value: sqrt(0.25 - t)}}",
     "driver 'm': a time derivative is not finite [bad-expression]", 0.25},
    {"drivers: {m: {joint: A, kind: angle, value: abs(t - 0.25) + log(0.3 - t)}}",
     "driver 'm': logarithm of a number that is not positive [bad-expression]", 0.3},
    {"drivers: {m: {joint: A, kind: angle, table: {points: [[0, 0], [0.1, 1], [0.25, 1]], outside: error}}}",
     "driver 'm': the time is outside of the table [bad-table]", 0.25},
    {"drivers: {m: {joint: B, kind: force, table: {points: [[0, 0], [0.1, 1], [0.25, 1]], outside: error}}}",
     "driver 'm': the time is outside of the table [bad-table]", 0.25},
    {"forces: {s: {type: spring-damper, between: [ground, cart], spring: 'sqrt(0.001 - x/(1 m))*1 N'}, w: {type: "
     "force, at: cart, value: [1, 0]}}",
     "joint 's': model.yaml:5:69: square root of a negative number [bad-expression]", by_motion},
    {"forces: {s: {type: spring-damper, between: [ground, cart], stiffness: 'sqrt(0.25 - t)*1 N/m'}}",
     "joint 's': model.yaml:5:72: square root of a negative number [bad-expression]", 0.25},
};

// A force is asked at the stages of a step, of which one that has no value is named; a driver is looked for.
TEST(FailedRun, AFormulaThatLosesItsValueIsNamedWithTheTime) {
  for (const LostValue& loss : lost_values) {
    for (const char* simulation : {"step: 1 ms", "accuracy: 1 um", "step: 1 ms, integrator: dopri5"}) {
      SCOPED_TRACE(std::string(loss.sections) + "; " + simulation);
      const ModelRun run(falling_rod(loss.sections, simulation));
      EXPECT_EQ(run.outcome().exit_code, 4);
      const std::string& reason = run.outcome().reason;
      double time = 0.0;
      EXPECT_EQ(std::sscanf(reason.c_str(), "t = %lf s: ", &time), 1) << reason;
      EXPECT_EQ(reason.substr(std::min(reason.size(), reason.find(" s: ") + 4)), loss.said);
      if (!std::isnan(loss.time)) {
        EXPECT_NEAR(time, loss.time, 3e-3);
      }
      EXPECT_LE(run.last("time"), time + 1e-6);
    }
  }
}

/// Allows steps of one length alone.
class Sticky final : public Joint {
 public:
  explicit Sticky(const Parameters& p) : longest_(p.number("longest")) {}
  void declare(JointLayout& layout) const override { layout.forces = 1; }
  void apply(const JointInput&, JointForces& out) const override { out.wrench_b[0] = 1.0; }
  double step_limit(const JointInput&) const override { return longest_; }

 private:
  double longest_;
};

const Registry& types_with_sticky() {
  static constexpr Parameter parameters[] = {{.name = "longest", .unit = "s"}};
  static const Component components[] = {
      joint<Sticky>({.name = "sticky", .space = Space::planar, .parameters = parameters})};
  static const Registry registry = [] {
    Registry all = Registry::with_builtins();
    all.add([](const Host* host,
               Manifest* manifest) noexcept { return publish(*host, *manifest, "sticky", "1", components); },
            "test");
    return all;
  }();
  return registry;
}

ModelRun run_sticky(const std::string& longest, const RunHooks& hooks) {
  return ModelRun(
      falling_rod("forces: {s: {type: sticky, between: [ground, cart], longest: " + longest + "}}", "accuracy: 1 um"),
      {}, {}, types_with_sticky(), hooks);
}

TEST(ShortSteps, OfAJointBelowTheShortestEndTheRun) {
  const ModelRun run = run_sticky("1e-15", {});
  EXPECT_EQ(run.outcome().exit_code, 4);
  EXPECT_EQ(run.outcome().reason,
            "t = 0 s: a step below 4e-15 s is needed, the smallest allowed; joint 's' asks for it");
}

// 0.4 s in steps of 20 ns are 2e7, more than the 1e7 that are many: said while the run goes on.
TEST(ShortSteps, OfAJointAreBlamedOnIt) {
  std::atomic<int> interrupt{0};
  std::string said;
  RunHooks hooks;
  hooks.interrupt = &interrupt;
  hooks.notice = [&](const std::string& notice) { said = notice, interrupt = 2; };
  const ModelRun run = run_sticky("20 ns", hooks);
  EXPECT_EQ(run.outcome().status, RunStatus::interrupted);
  EXPECT_TRUE(said.starts_with("steps of 2e-08 s at t = ")) << said;
  EXPECT_TRUE(said.ends_with("; force 's' asks for steps no longer")) << said;
}

// 1e-12 s: more than 1e11, which no one waits for.
TEST(ShortSteps, StopARunThatWouldTakeMoreThanADay) {
  const ModelRun run = run_sticky("1e-12", {});
  EXPECT_EQ(run.outcome().exit_code, 4);
  EXPECT_THAT(run.outcome().reason, ::testing::HasSubstr("the run does not come to its end: steps of 1e-12 s"));
}

}  // namespace
}  // namespace freeplay
