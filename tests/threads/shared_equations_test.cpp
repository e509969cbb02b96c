// Simulations that share their equations of motion, each in a thread of its own, compute what one thread alone does.
#include <cstring>
#include <thread>

#include "run/equations.h"
#include "run/simulation.h"
#include "validation/run_model.h"

namespace freeplay {
namespace {

using test::mechanism;
using test::replaced;

/// Every number of every row and event.
class NumberKeeper final : public Sink {
 public:
  void row(std::span<const double> values) override { numbers.insert(numbers.end(), values.begin(), values.end()); }
  void event(const EventRecord& record) override {
    numbers.push_back(record.time);
    numbers.push_back(record.joint);
    numbers.push_back(record.event);
  }
  bool ok() const override { return true; }
  std::vector<double> numbers;
};

std::vector<double> numbers_of(const std::shared_ptr<const RunEquations>& equations, const Channels& channels) {
  NumberKeeper keeper;
  Sink* const sinks[] = {&keeper};
  Simulation simulation(equations, channels, sinks);
  EXPECT_EQ(simulation.run({}).status, RunStatus::completed);
  return keeper.numbers;
}

void expect_eight_equal_runs(const std::string& text) {
  const auto model = test::load(text);
  System system(*model);
  const Start start = assemble(system);
  const Channels channels(*model);
  const auto equations = std::make_shared<const RunEquations>(system, start);
  const std::vector<double> alone = numbers_of(equations, channels);
  ASSERT_GT(alone.size(), channels.all().size());
  std::vector<std::vector<double>> found(8);
  std::vector<std::thread> threads;
  for (std::vector<double>& own : found) {
    threads.emplace_back([&] { own = numbers_of(equations, channels); });
  }
  for (std::thread& thread : threads) thread.join();
  for (const std::vector<double>& own : found) {
    ASSERT_EQ(own.size(), alone.size());
    // NaN where an event has no field: bit for bit.
    EXPECT_EQ(std::memcmp(own.data(), alone.data(), alone.size() * sizeof(double)), 0);
  }
}

TEST(SharedEquations, EightThreadsStepALoosePinInFixedSteps) {
  expect_eight_equal_runs(
      replaced(replaced(mechanism("slider-crank"), "end: 24 ms", "end: 3 ms"), "discard: 12 ms", "discard: 0 ms"));
}

TEST(SharedEquations, EightThreadsStepALoosePinUnderAnAccuracy) {
  expect_eight_equal_runs(
      replaced(replaced(mechanism("slider-crank"), "end: 24 ms, step: 1 us", "end: 3 ms, accuracy: 1 um"),
               "discard: 12 ms", "discard: 0 ms"));
}

// Their drivers solve the ideal mechanism for the path, in work space of each thread.
TEST(SharedEquations, EightThreadsFollowAPathThroughTheWholeMechanism) {
  expect_eight_equal_runs(R"(freeplay: 1
bodies: {platform: {mass: 0.977161, inertia: 7.035559e-3}}
templates:
  leg:
    parameters: {at: required}
    bodies:
      cylinder: {mass: 0.4, inertia: 1.2e-3, com: [80 mm, 0], pose: {angle: $at + pi}}
      rod: {mass: 0.25, inertia: 7e-4, com: [-90 mm, 0]}
    frames:
      ground/A: {polar: [0.4, $at]}
      platform/C: {polar: [0.11, $at]}
    joints:
      A: {type: revolute, between: [ground/A, cylinder]}
      P: {type: prismatic, between: [cylinder, rod]}
      C: {type: revolute, between: [rod, platform/C]}
instances: {leg: {template: leg, count: 3, with: {at: 7*pi/6 + 2*pi*($i-1)/3}}}
drivers:
  circle:
    inverse_kinematics: {frame: platform, path: {x: 0.05*cos(4*pi*t), y: 0.05*sin(4*pi*t), angle: 0.1}, joints: leg*.P}
simulation: {end: 20 ms, step: 1 ms}
)");
}

TEST(SharedEquations, EightThreadsStepAMechanismInSpace) {
  expect_eight_equal_runs(replaced(mechanism("spatial/slider-crank"), "end: 20 ms", "end: 3 ms"));
}

}  // namespace
}  // namespace freeplay
