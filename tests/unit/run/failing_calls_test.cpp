// A joint that gives up at any of the calls that a run makes: the run ends there, says who and when, and keeps the rows
// before.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <set>
#include <stdexcept>

#include <gmock/gmock.h>

#include "base/error.h"
#include "validation/run_model.h"

namespace freeplay {
namespace {

using test::ModelRun;
using ::testing::HasSubstr;

enum class Call {
  coordinate,
  constrain,
  apply,
  initialize,
  begin_step,
  events,
  on_event,
  commit,
  observe,
  step_limit,
  warning,
  free_distance,
  next_corner,
  contacts,
  kinks
};
constexpr const char* call_names[] = {"coordinate", "constrain",     "apply",       "initialize", "begin_step",
                                      "events",     "on_event",      "commit",      "observe",    "step_limit",
                                      "warning",    "free_distance", "next_corner", "contacts",   "kinks"};

/// The call that fails, or from which on all of its kind do, and how many have been made.
struct Trap {
  Call call = Call::apply;
  long at = 0;  ///< counted from 1; 0: none
  bool for_good = false;
  long made = 0;
};
Trap trap;

void ask(Call call) {
  if (call != trap.call) return;
  ++trap.made;
  if (trap.made == trap.at || (trap.for_good && trap.at > 0 && trap.made > trap.at))
    throw std::runtime_error("gave up");
}

/// Holds b on the x axis of a, between two springs, which it meets 0.1 m to each side.
class FailingGuide final : public Joint {
 public:
  explicit FailingGuide(const Parameters&) {}
  void declare(JointLayout& layout) const override {
    layout.coordinate = Coordinate::position;
    layout.constraint_rows = 2;
    layout.forces = 1;
    layout.history = 2;
    layout.kinks = 1;
    layout.channels = channels_;
    layout.events = events_;
  }
  void coordinate(const JointInput& in, CoordinateRow& out) const override {
    ask(Call::coordinate);
    out.value = offset(in);
    out.jacobian[0] = -1.0;
    out.jacobian[6] = 1.0;
  }
  void constrain(const JointInput& in, ConstraintRows& out) const override {
    ask(Call::constrain);
    out.phi[0] = in.b->position[1] - in.a->position[1];
    out.phi[1] = std::atan2(in.b->rotation[3], in.b->rotation[0]);
    out.jacobian[1] = out.jacobian[12 + 5] = -1.0;
    out.jacobian[7] = out.jacobian[12 + 11] = 1.0;
  }
  void apply(const JointInput& in, JointForces& out) const override {
    ask(Call::apply);
    const double force = stiffness * (std::max(0.0, -offset(in) - gap) - std::max(0.0, offset(in) - gap));
    out.wrench_b[0] = force;
    out.wrench_a[0] = -force;
    out.potential = 0.5 * force * force / stiffness;
  }
  void initialize(const JointInput&, Span<double>, Span<double>) const override { ask(Call::initialize); }
  void begin_step(const JointInput&, const MarkerAccelerations&, double, Span<double>) const override {
    ask(Call::begin_step);
  }
  void events(const JointInput& in, Span<double> g, Span<double> rate) const override {
    ask(Call::events);
    for (std::size_t side = 0; side < 2; ++side) {
      const double sign = side == 0 ? 1.0 : -1.0, depth = sign * offset(in) - gap;
      const double speed = sign * (in.b->velocity[0] - in.a->velocity[0]);
      const bool touching = in.history[side] > 0.0;
      g[2 * side] = touching ? std::numeric_limits<double>::quiet_NaN() : depth;
      g[2 * side + 1] = touching ? -depth : std::numeric_limits<double>::quiet_NaN();
      rate[2 * side] = speed;
      rate[2 * side + 1] = -speed;
    }
  }
  void on_event(int index, const JointInput&, Span<double>, Span<double> history, Span<double>) const override {
    ask(Call::on_event);
    history[static_cast<std::size_t>(index) / 2] = index % 2 == 0 ? 1.0 : 0.0;
  }
  void commit(const JointInput&, Span<const double>, Span<double>) const override { ask(Call::commit); }
  void observe(const JointInput& in, Span<const double>, Span<double> values) const override {
    ask(Call::observe);
    values[0] = std::abs(offset(in)) - gap;
    values[1] = stiffness * std::max(0.0, values[0]);
    values[2] = values[0] > 0.0 ? 1.0 : 0.0;
  }
  double step_limit(const JointInput&) const override {
    ask(Call::step_limit);
    return unbounded;
  }
  const char* warning(const JointInput&) const override {
    ask(Call::warning);
    return nullptr;
  }
  double free_distance(const JointInput& in) const override {
    ask(Call::free_distance);
    return std::max(0.0, gap - std::abs(offset(in)));
  }
  double next_corner(double t) const override {
    ask(Call::next_corner);
    return t < 0.05 ? 0.05 : unbounded;
  }
  void contacts(const JointInput& in, Span<double> numbers) const override {
    ask(Call::contacts);
    for (std::size_t side = 0; side < 2; ++side) {
      numbers[3 * side] = stiffness * std::max(0.0, (side == 0 ? 1.0 : -1.0) * offset(in) - gap);
      numbers[3 * side + 1] = numbers[3 * side + 2] = 0.0;
    }
  }
  void kinks(const JointInput& in, Span<double> g) const override {
    ask(Call::kinks);
    g[0] = offset(in);
  }

 private:
  static double offset(const JointInput& in) { return in.b->position[0] - in.a->position[0]; }
  static constexpr double stiffness = 4e3, gap = 0.1;
  static constexpr Channel channels_[] = {{"delta", "m"}, {"fn", "N"}, {"contact", "1"}};
  static constexpr Event events_[] = {{"right_contact_begin", Crossing::rising, 1, {}},
                                      {"right_contact_end", Crossing::rising, 1, {}},
                                      {"left_contact_begin", Crossing::rising, 1, {}},
                                      {"left_contact_end", Crossing::rising, 1, {}}};
};

const Registry& types_with_failing_guide() {
  static const Component components[] = {joint<FailingGuide>({.name = "failing", .space = Space::planar})};
  static const Registry registry = [] {
    Registry all = Registry::with_builtins();
    all.add([](const Host* host,
               Manifest* manifest) noexcept { return publish(*host, *manifest, "failing", "1", components); },
            "test");
    return all;
  }();
  return registry;
}

ModelRun run_guide(const std::string& simulation) {
  return ModelRun(
      "freeplay: 1\nbodies: {puck: {mass: 1, inertia: 0.01, velocity: {linear: [1, 0]}}}\n"
      "joints: {odd: {type: failing, between: [ground, puck]}}\nsimulation: {end: 0.4 s, " +
          simulation + "}\n",
      {}, {}, types_with_failing_guide());
}

/// The first calls, the last ones, and some between.
std::set<long> some_of(long calls, long between) {
  std::set<long> chosen;
  for (long i = 1; i <= std::min(3L, calls); ++i) chosen.insert({i, calls + 1 - i});
  for (long i = 1; i < between && calls > 0; ++i) chosen.insert(1 + i * calls / between);
  return chosen;
}

/// What the failure of one call does to the run; "" where the run went on without it.
std::string failure_of(const Trap& set, const std::string& simulation) {
  trap = set;
  try {
    const ModelRun run = run_guide(simulation);
    for (const double number : run.kept().numbers()) EXPECT_TRUE(std::isfinite(number));
    for (std::size_t row = 1; row < run.rows(); ++row) EXPECT_GT(run.at(row, "time"), run.at(row - 1, "time"));
    if (run.outcome().status != RunStatus::failed) return "";
    double time = -1.0;
    EXPECT_EQ(std::sscanf(run.outcome().reason.c_str(), "t = %lf s: ", &time), 1) << run.outcome().reason;
    EXPECT_GE(time, run.outcome().time * (1.0 - 1e-8)) << run.outcome().reason;
    return run.outcome().reason;
  } catch (const Error& error) {  // before the first step
    EXPECT_EQ(error.category(), Error::Category::plugin) << error.what();
    return error.what();
  }
}

constexpr const char* runs_of_guide[] = {
    "step: 1 ms",
    "step: 1 ms, output: {interval: 7 ms, rows_in_contact: 20, discard: 0.2 s}",
    "accuracy: 1 um, output: {interval: 7 ms}",
    "accuracy: 0.1 um, output: {interval: 7 ms, rows_in_contact: 20, discard: 0.2 s}",
    "accuracy: 1 um, integrator: generalized-alpha, stop: [{channel: body.puck.x, below: 0.05, after: 0.15 s}]",
    "step: {size: 2 ms, adaptive: true, tolerance: 1e-3, min: 1 ns}"};

// A step that could not be made is tried again, so that a joint which fails once is not noticed there. What it fails at
// for good is noticed, but for what only looks back or ahead: the last calls of all.
TEST(FailedRun, AJointThatGivesUpAtAnyCallIsNamedAndEndsIt) {
  for (const char* simulation : runs_of_guide) {
    for (int c = 0; c < static_cast<int>(std::size(call_names)); ++c) {
      const Call call = static_cast<Call>(c);
      ASSERT_EQ(failure_of({call}, simulation), "") << simulation;
      const long calls = trap.made;
      for (const long at : some_of(calls, 8)) failure_of({call, at, false}, simulation);
      for (const long at : some_of(calls, 5)) {
        SCOPED_TRACE(std::string(simulation) + ": " + call_names[c] + " from " + std::to_string(at));
        const std::string failure = failure_of({call, at, true}, simulation);
        if (failure.empty()) {
          EXPECT_TRUE(call == Call::next_corner || at > calls - 4) << "went on";
        } else {
          EXPECT_THAT(failure, HasSubstr("joint 'odd'"));
          EXPECT_THAT(failure, HasSubstr("gave up"));
        }
      }
    }
  }
}

}  // namespace
}  // namespace freeplay
