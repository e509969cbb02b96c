#include "run/error_budget.h"

#include <gtest/gtest.h>

namespace freeplay {
namespace {

TEST(ErrorBudget, ThatIsFullAllowsWhatAnyStepMay) {
  const ErrorBudget budget(10.0, 5);
  EXPECT_DOUBLE_EQ(budget.share(1.0, false), 1.0);
  EXPECT_DOUBLE_EQ(budget.share(64.0, false), 1.0 / 32.0);
  EXPECT_DOUBLE_EQ(budget.share(1.0, true), 0.25);
}

// Of steps that use up their share, in units of what counts: the power 6/5 of the estimate.
TEST(ErrorBudget, NeverSpendsMoreThanItHadAndWasGiven) {
  ErrorBudget budget(10.0, 5);
  double spent = 0.0;
  const int steps = 10000;
  for (int i = 0; i < steps; ++i) {
    spent += std::pow(budget.share(1.0, false), 1.2);
    budget.spend(1.0, false);
    budget.pass(1e-3);
  }
  EXPECT_LT(spent, 16.0 + 10.0 * 1e-3 * steps);
  EXPECT_GT(spent, 0.9 * 10.0 * 1e-3 * steps);
}

TEST(ErrorBudget, ComesBackWithTimeUntilItIsFull) {
  ErrorBudget budget(10.0, 5);
  for (int i = 0; i < 100; ++i) budget.spend(1.0, false);
  EXPECT_LT(budget.share(1.0, false), 0.1);
  budget.pass(100.0);
  EXPECT_DOUBLE_EQ(budget.share(1.0, false), 1.0);
}

}  // namespace
}  // namespace freeplay
