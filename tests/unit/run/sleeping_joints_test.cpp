#include "run/sleeping_joints.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "freeplay/eigen.h"
#include "freeplay/plugin.h"
#include "validation/run_model.h"

namespace freeplay {
namespace {

using test::ModelRun;
using test::replaced;

long asked = 0;    // for forces, by all cages since a test began
long derived = 0;  // with their derivatives

/// A ball in a cage, in the plane, e = P_b - P_a: F_b = -k (|e| - r) e/|e| where |e| > r, and twice as much in a step
/// for which begin_step() was not called. Remembers its contacts, the deepest, and when the step ends.
class Cage final : public Joint {
 public:
  explicit Cage(const Parameters& p) : radius_(p.number("radius")), tells_(p.word("promise") == 0) {}
  void declare(JointLayout& layout) const override {
    layout.forces = layout.analytic_derivatives = 1;
    layout.history = 3;
    layout.time_scale = std::numeric_limits<double>::infinity();  // nothing of it comes with time alone
    layout.channels = channels;
    layout.events = events_;
  }
  void apply(const JointInput& in, JointForces& out) const override {
    ++asked;
    if (!out.derivatives.empty()) ++derived;
    out.potential_rate = 0.0;
    const double distance = eccentricity(in), delta = distance - radius_;
    if (!(delta > 0.0)) return;
    const double k = in.t > in.history[2] + 1e-12 ? 2.0 * stiffness : stiffness;
    out.potential = 0.5 * k * delta * delta;
    out.potential_rate = k * delta * rate(in);
    for (int i = 0; i < 2; ++i) {
      out.wrench_b[i] = -k * delta * (in.b->position[i] - in.a->position[i]) / distance;
      out.wrench_a[i] = -out.wrench_b[i];
    }
    for (std::size_t i = 0; i < 4 && !out.derivatives.empty(); ++i) {
      const std::size_t row = i / 2, column = i % 2;
      const double n_n = (in.b->position[row] - in.a->position[row]) *
                         (in.b->position[column] - in.a->position[column]) / (distance * distance);
      const double slope = k * ((row == column ? delta / distance : 0.0) + radius_ / distance * n_n);
      out.derivatives[24 * row + column] = out.derivatives[24 * (6 + row) + 6 + column] = -slope;
      out.derivatives[24 * row + 6 + column] = out.derivatives[24 * (6 + row) + column] = slope;
    }
  }
  void begin_step(const JointInput& in, const MarkerAccelerations&, double dt, Span<double> history) const override {
    history[2] = in.t + dt;
  }
  void events(const JointInput& in, Span<double> g, Span<double> r) const override {
    g[0] = eccentricity(in) - radius_;
    r[0] = rate(in);
  }
  void on_event(int, const JointInput& in, Span<double>, Span<double> history, Span<double> fields) const override {
    history[0] += 1.0;
    fields[0] = history[0];
    fields[1] = history[2] - in.t;
  }
  void commit(const JointInput& in, Span<const double>, Span<double> history) const override {
    history[1] = std::max(history[1], eccentricity(in) - radius_);
  }
  void observe(const JointInput& in, Span<const double>, Span<double> values) const override {
    values[0] = in.history[1];
    values[1] = eccentricity(in);
  }
  double free_distance(const JointInput& in) const override {
    return tells_ ? std::max(0.0, radius_ - eccentricity(in)) : 0.0;
  }

 private:
  static constexpr double stiffness = 1e5;
  static constexpr Channel channels[] = {{"deepest", "m"}, {"out", "m"}}, fields_[] = {{"count", "1"}, {"left", "s"}};
  static constexpr Event events_[] = {{"touch", Crossing::rising, 0, fields_}};
  static double eccentricity(const JointInput& in) {
    return std::hypot(in.b->position[0] - in.a->position[0], in.b->position[1] - in.a->position[1]);
  }
  static double rate(const JointInput& in) {
    double sum = 0.0;
    for (int i = 0; i < 2; ++i) {
      sum += (in.b->position[i] - in.a->position[i]) * (in.b->velocity[i] - in.a->velocity[i]);
    }
    return eccentricity(in) > 0.0 ? sum / eccentricity(in) : 0.0;
  }
  double radius_;
  bool tells_;
};

/// A beam between two walls along the x axis of a: its tip, 0.1 m from b along its own x axis, is pushed back by
/// k (|y| - r) beyond the distance r, at the tip.
class Corridor final : public Joint {
 public:
  explicit Corridor(const Parameters& p) : room_(p.number("radius")), tells_(p.word("promise") == 0) {}
  void declare(JointLayout& layout) const override {
    layout.forces = 1;
    layout.time_scale = std::numeric_limits<double>::infinity();
    layout.clearance = room_;
    layout.play_shape = PlayShape::walls;
    layout.contact_reach = arm;
    layout.channels = channels;
  }
  void apply(const JointInput& in, JointForces& out) const override {
    ++asked;
    out.potential_rate = std::numeric_limits<double>::quiet_NaN();
    const double y = tip(in), depth = std::abs(y) - room_;
    if (!(depth > 0.0)) return;
    const double force = -std::copysign(stiffness * depth, y), *h = in.a->rotation, *x = in.b->rotation;
    const double f[2] = {-h[3] * force, h[0] * force}, to_tip[2] = {arm * x[0], arm * x[3]};
    out.potential = 0.5 * stiffness * depth * depth;
    double from_a[2];
    for (int i = 0; i < 2; ++i) {
      out.wrench_b[i] = f[i];
      out.wrench_a[i] = -f[i];
      from_a[i] = in.b->position[i] - in.a->position[i] + to_tip[i];
    }
    out.wrench_b[5] = to_tip[0] * f[1] - to_tip[1] * f[0];
    out.wrench_a[5] = from_a[1] * f[0] - from_a[0] * f[1];
  }
  void observe(const JointInput& in, Span<const double>, Span<double> values) const override { values[0] = tip(in); }
  double free_distance(const JointInput& in) const override {
    return tells_ ? std::max(0.0, room_ - std::abs(tip(in))) : 0.0;
  }

 private:
  static constexpr double stiffness = 1e5, arm = 0.1;
  static constexpr Channel channels[] = {{"across", "m"}};
  static double tip(const JointInput& in) {
    const double *h = in.a->rotation, *x = in.b->rotation;
    const double d[2] = {in.b->position[0] - in.a->position[0] + arm * x[0],
                         in.b->position[1] - in.a->position[1] + arm * x[3]};
    return h[0] * d[1] - h[3] * d[0];
  }
  double room_;
  bool tells_;
};

/// A beam in space whose tip, 0.1 m from b along its own x axis, is pushed back by k (rho - r) where it is farther than
/// r from the x axis of a; seen from a.
class Tube final : public Joint {
 public:
  explicit Tube(const Parameters& p) : room_(p.number("radius")), tells_(p.word("promise") == 0) {}
  void declare(JointLayout& layout) const override {
    layout.forces = 1;
    layout.time_scale = std::numeric_limits<double>::infinity();
    layout.clearance = room_;
    layout.free_turns = 1;
    layout.channels = channels;
  }
  void apply(const JointInput& in, JointForces& out) const override {
    ++asked;
    out.potential_rate = std::numeric_limits<double>::quiet_NaN();
    const Vector3d across = across_of(in), arm_b = to_tip(in);
    const double depth = across.norm() - room_;
    if (!(depth > 0.0)) return;
    const Vector3d f = -stiffness * depth * across.normalized(),
                   arm_a = vector3(in.b->position) - vector3(in.a->position) + arm_b;
    out.potential = 0.5 * stiffness * depth * depth;
    Eigen::Map<Eigen::Matrix<double, 6, 1>>(out.wrench_b) << f, arm_b.cross(f);
    Eigen::Map<Eigen::Matrix<double, 6, 1>>(out.wrench_a) << -f, -arm_a.cross(f);
  }
  void observe(const JointInput& in, Span<const double>, Span<double> values) const override {
    values[0] = across_of(in).norm();
  }
  double free_distance(const JointInput& in) const override {
    return tells_ ? std::max(0.0, room_ - across_of(in).norm()) : 0.0;
  }
  void free_levers(const JointInput&, Span<double> levers) const override { levers[0] = arm; }

 private:
  using Vector3d = Eigen::Vector3d;
  static constexpr double stiffness = 1e5, arm = 0.1;
  static constexpr Channel channels[] = {{"across", "m"}};
  static Vector3d to_tip(const JointInput& in) { return arm * rotation(*in.b).col(0); }
  /// From the x axis of a to the tip, world axes.
  static Vector3d across_of(const JointInput& in) {
    const Vector3d tip = vector3(in.b->position) + to_tip(in) - vector3(in.a->position), axis = rotation(*in.a).col(0);
    return tip - axis.dot(tip) * axis;
  }
  double room_;
  bool tells_;
};

const Registry& types_with_cage() {
  static constexpr Parameter parameters[] = {
      {.name = "radius", .unit = "m"},
      {.name = "promise", .kind = ParameterKind::choice, .default_value = 0, .choices = "told|silent"}};
  static const Component components[] = {
      joint<Cage>({.name = "cage", .space = Space::planar, .parameters = parameters}),
      joint<Corridor>({.name = "corridor", .space = Space::planar, .parameters = parameters}),
      joint<Tube>({.name = "tube", .space = Space::spatial, .parameters = parameters})};
  static const Registry registry = [] {
    Registry all = Registry::with_builtins();
    all.add([](const Host* host,
               Manifest* manifest) noexcept { return publish(*host, *manifest, "cage", "1", components); },
            "test");
    return all;
  }();
  return registry;
}

struct Asked {
  explicit Asked(const std::string& text)
      : run(text, {}, {}, types_with_cage()), times(asked), times_with_derivatives(derived) {}
  ModelRun run;
  long times, times_with_derivatives;
};
Asked ask(const std::string& text) {
  asked = derived = 0;
  return Asked(text);
}

void expect_same(const ModelRun& a, const ModelRun& b) {
  EXPECT_EQ(a.outcome().status, RunStatus::completed) << a.outcome().reason;
  EXPECT_EQ(a.kept().numbers(), b.kept().numbers());
  ASSERT_EQ(a.events().size(), b.events().size());
  for (std::size_t i = 0; i < a.events().size(); ++i) {
    EXPECT_EQ(a.events()[i].time, b.events()[i].time) << i;
    EXPECT_EQ(a.events()[i].fields, b.events()[i].fields) << i;
  }
}

// It falls, jumps and rattles in its cage.
constexpr const char* ball = R"(
freeplay: 1
name: ball
bodies: {ball: {mass: 2 kg, inertia: 1e-2, velocity: {linear: [0.3, 0.1], angular: 3}}}
joints: {cage: {type: cage, between: [ground, ball], radius: 20 mm, promise: told}}
simulation: {end: 0.4 s, step: 20 us, integrator: bathe, output: {interval: 1 ms}}
)";

TEST(SleepingJoints, AreAskedSeldomAndNothingElseChanges) {
  const Asked told = ask(ball), silent = ask(replaced(ball, "told", "silent"));
  expect_same(told.run, silent.run);
  EXPECT_GT(told.run.events().size(), 2u);
  EXPECT_GT(told.run.last("joint.cage.deepest"), 1e-4);
  EXPECT_LT(told.times, silent.times / 2);
  // In flight the silent one is, where factors are made.
  EXPECT_LT(told.times_with_derivatives, silent.times_with_derivatives);
}

TEST(SleepingJoints, GiveTheSameNumbersWithEveryIntegrator) {
  for (const char* integrator : {"newmark", "generalized-alpha", "hht", "dopri5", "verner6"}) {
    const std::string text = replaced(ball, "bathe", integrator);
    SCOPED_TRACE(integrator);
    expect_same(ask(text).run, ask(replaced(text, "told", "silent")).run);
  }
}

// The beam runs along a guide that turns, tilts and rattles in it.
constexpr const char* beam = R"(
freeplay: 1
name: beam
gravity: [0, -9.81]
bodies:
  guide: {mass: 5 kg, inertia: 1}
  beam: {mass: 2 kg, inertia: 1e-2, velocity: {linear: [1, 0.2], angular: 12}}
joints:
  hub: {type: revolute, between: [ground, guide]}
  rail: {type: corridor, between: [guide, beam], radius: 5 mm, promise: told}
drivers: {motor: {joint: hub, kind: velocity, value: 10 rad/s}}
simulation: {end: 0.2 s, step: 20 us, integrator: bathe, output: {interval: 1 ms}}
)";

TEST(SleepingJoints, AreAskedForForcesSeldomInStepsThatTheErrorChooses) {
  for (const char* model : {ball, beam}) {
    const std::string text = replaced(model, "bathe", "dopri5");
    const Asked told = ask(text), silent = ask(replaced(text, "told", "silent"));
    expect_same(told.run, silent.run);
    EXPECT_LT(told.times, silent.times / 2);
  }
}

// A blow moves the ball through all of its room within one step.
TEST(SleepingJoints, AStepInWhichOneMovesTooFarIsTakenAgain) {
  const std::string text =
      replaced(replaced(ball, "velocity: {linear: [0.3, 0.1], angular: 3}", "frames: {middle: [0, 0]}"),
               "simulation: {end: 0.4 s, step: 20 us",
               "gravity: [0, 0]\n"
               "forces: {blow: {type: force, at: ball, value: [\"2e9*exp(-((t - 0.01)/1e-5)^2)\", 0]}}\n"
               "simulation: {end: 12 ms, step: 20 us");
  const Asked told = ask(text), silent = ask(replaced(text, "told", "silent"));
  expect_same(told.run, silent.run);
  EXPECT_LT(told.times, silent.times / 2);
  EXPECT_GT(told.run.last("joint.cage.deepest"), 0.0);
}

// The cage goes through all of the ball's room and back within every step: at its end nothing shows.
TEST(SleepingJoints, AStepIsTakenAgainWhereAStageWasTooFar) {
  const std::string text = R"(
freeplay: 1
name: shaken
gravity: [0, 0]
bodies: {shaker: {mass: 1 kg, inertia: 1e-2}, ball: {mass: 2 kg, inertia: 1e-2}}
joints:
  rail: {type: prismatic, between: [ground, shaker]}
  cage: {type: cage, between: [shaker, ball], radius: 20 mm, promise: told}
drivers: {shake: {joint: rail, kind: position, value: "0.03*sin(pi*t/2e-5)^2"}}
simulation: {end: 1 ms, step: 20 us, integrator: bathe, output: {interval: 0.1 ms}}
)";
  const Asked told = ask(text), silent = ask(replaced(text, "told", "silent"));
  const double x = silent.run.last("body.ball.x");
  EXPECT_GT(std::abs(x), 1e-9);
  // The attempt that was thrown away has left other factors: the iterations end elsewhere within their tolerance.
  EXPECT_NEAR(told.run.last("body.ball.x"), x, 1e-8 * std::abs(x));
}

TEST(SleepingJoints, BetweenWallsCountShiftsAcrossAndTurnsAlone) {
  for (const char* integrator : {"bathe", "newmark"}) {
    const std::string text = replaced(beam, "bathe", integrator);
    SCOPED_TRACE(integrator);
    const Asked told = ask(text), silent = ask(replaced(text, "told", "silent"));
    expect_same(told.run, silent.run);
    EXPECT_LT(told.times, silent.times / 2);
    double most = 0.0;
    const auto& rows = told.run.kept();
    for (std::size_t i = 0; i < rows.rows(); ++i) most = std::max(most, std::abs(rows.at(i, "joint.rail.across")));
    EXPECT_GT(most, 5e-3);
  }
}

// The tube turns, the beam goes along it, spins and tilts.
constexpr const char* tip = R"(
freeplay: 1
name: tip
space: spatial
gravity: [0, -3, -9.81]
bodies:
  tube: {mass: 5 kg, inertia: [1, 1, 1]}
  beam: {mass: 2 kg, inertia: [1e-3, 1e-2, 1.05e-2], velocity: {linear: [0.2, 0.1, 0.05], angular: [30, 1, 2]}}
joints:
  hub: {type: revolute, between: [ground, tube]}
  bore: {type: tube, between: [tube, beam], radius: 20 mm, promise: told}
drivers: {motor: {joint: hub, kind: velocity, value: 3 rad/s}}
simulation: {end: 0.15 s, step: 20 us, integrator: bathe, output: {interval: 1 ms}}
)";

TEST(SleepingJoints, InSpaceCountShiftsSeenFromTheFirstBodyAndTurnsByTheirLevers) {
  for (const char* integrator : {"bathe", "newmark", "dopri5"}) {
    const std::string text = replaced(tip, "bathe", integrator);
    SCOPED_TRACE(integrator);
    const Asked told = ask(text), silent = ask(replaced(text, "told", "silent"));
    expect_same(told.run, silent.run);
    EXPECT_LT(told.times, silent.times / 2);
    double most = 0.0;
    const auto& rows = told.run.kept();
    for (std::size_t i = 0; i < rows.rows(); ++i) most = std::max(most, rows.at(i, "joint.bore.across"));
    EXPECT_GT(most, 0.02);
  }
}

}  // namespace
}  // namespace freeplay
