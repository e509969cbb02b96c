// RoundingFloor: what counts as zero.
#include "stage/rounding_floor.h"

#include <gtest/gtest.h>

#include "assembly/assembly.h"
#include "validation/run_model.h"

namespace freeplay {
namespace {

/// A rod that hangs from the ground: two equations, x and y of the pin, in which x and y of the body stand as they are.
constexpr const char* rod = R"(freeplay: 1
bodies:
  rod: {mass: 1, inertia: 0.1, com: [0, -0.5]}
joints:
  pin: {type: revolute, between: [ground, rod]}
)";

struct Floor : ::testing::Test {
  Floor() : model(test::load(rod)), system(*model), state(assemble(system).state) { equations.use_history(state.h()); }
  void measure() {
    ASSERT_TRUE(evaluate());
    floor.measure();
  }
  bool evaluate() { return equations.evaluate(state.view(), term_position); }
  std::shared_ptr<const Model> model;
  System system;
  State state;
  StageEquations equations{system};
  ConvergenceParameters parameters;
  RoundingFloor floor{equations, parameters};
  const double eps = ConvergenceParameters::rounding;
};

TEST_F(Floor, IsThatOfTheLargestTermOfAnEquation) {
  measure();
  ASSERT_EQ(2u, floor.of_phi().size());
  for (const double rounding : floor.of_phi()) EXPECT_DOUBLE_EQ(16.0 * eps * system.size(), rounding);
  EXPECT_EQ(eps, floor.of_coordinates());
}

TEST_F(Floor, GrowsWithCoordinatesOfManyUnits) {
  state.q()[0] = 1000.0 * system.size();
  measure();
  EXPECT_DOUBLE_EQ(16.0 * eps * 100.0 * system.size(), floor.of_phi()[0]);
  EXPECT_DOUBLE_EQ(16.0 * eps * system.size(), floor.of_phi()[1]);
  EXPECT_DOUBLE_EQ(100.0 * eps, floor.of_coordinates());
}

TEST_F(Floor, HoldsResidualsOfSoManyRoundings) {
  measure();
  state.q()[0] += 2.0 * floor.of_phi()[0];
  ASSERT_TRUE(evaluate());
  EXPECT_FALSE(floor.phi_is_below(1.9));
  EXPECT_TRUE(floor.phi_is_below(2.1));
}

}  // namespace
}  // namespace freeplay
