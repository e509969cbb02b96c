// IndependentRows: which constraint equations are redundant, and how near a singular position is.
#include "stage/independent_rows.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "assembly/assembly.h"
#include "validation/run_model.h"

namespace freeplay {
namespace {

/// A door on two hinges with one axis: two of its four equations are redundant.
constexpr const char* door = R"(freeplay: 1
bodies:
  door: {mass: 1, inertia: 0.1, com: [0.3, 0]}
joints:
  upper: {type: revolute, between: [ground, door]}
  lower: {type: revolute, between: [ground, door]}
)";

struct Door : ::testing::Test {
  Door() : model(test::load(door)), system(*model), e(system) {
    const State state = assemble(system).state;
    EXPECT_TRUE(system.evaluate(point(state), term_position, e));
  }
  std::shared_ptr<const Model> model;
  System system;
  Evaluation e;
};

TEST_F(Door, HasTwoRedundantEquations) {
  IndependentRows rows(system.jacobian());
  EXPECT_FALSE(rows.is_known());
  EXPECT_FALSE(rows.any_dependent());
  EXPECT_TRUE(rows.find(e));
  EXPECT_TRUE(rows.any_dependent());
  EXPECT_EQ(2, std::ranges::count(rows.dependent(), 1));
}

TEST_F(Door, KeepsItsChoice) {
  IndependentRows rows(system.jacobian());
  rows.find(e);
  EXPECT_EQ(1, rows.choice());
  EXPECT_FALSE(rows.find(e));
  EXPECT_EQ(1, rows.choice());
}

TEST_F(Door, SharesTheLoadEvenly) {
  IndependentRows rows(system.jacobian());
  rows.find(e);
  rows.find_more(e, 0.0);
  double lambda[] = {6.0, 4.0, 0.0, 0.0};
  rows.least_norm(lambda);
  for (const int r : {0, 2}) EXPECT_NEAR(3.0, lambda[r], 1e-14);
  for (const int r : {1, 3}) EXPECT_NEAR(2.0, lambda[r], 1e-14);
}

TEST_F(Door, IsAsRegularAsTheSmallestPivotOfAnAttempt) {
  IndependentRows rows(system.jacobian());
  rows.note_pivot(2.0);
  rows.note_pivot(0.5);
  rows.note_pivot(1.0);
  EXPECT_EQ(0.25, rows.regularity());
  EXPECT_EQ(0.25, rows.attempt_regularity());
  rows.begin_attempt();
  EXPECT_EQ(0.5, rows.regularity());  // no pivot yet: that of the last position
  EXPECT_EQ(1.0, rows.attempt_regularity());
}

TEST_F(Door, IsSingularWhereMoreEquationsDependOnOthers) {
  IndependentRows rows(system.jacobian());
  rows.keep_all();  // four independent ones before
  rows.note_pivot(1.0);
  rows.find(e);
  EXPECT_EQ(0.0, rows.regularity());
}

}  // namespace
}  // namespace freeplay
