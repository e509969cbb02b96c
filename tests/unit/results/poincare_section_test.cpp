#include "results/poincare_section.h"

#include <cmath>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

struct PoincareRows {
  std::vector<double> time, x;
  PoincareSection section(double phase, double period) const {
    const std::span<const double> column(x);
    return poincare_section(time, {&column, 1}, phase, period);
  }
};

PoincareRows circle() {
  PoincareRows rows;
  for (int i = 0; i <= 1000; ++i) {
    rows.time.push_back(1e-2 * i);
    rows.x.push_back(std::cos(2.0 * M_PI * rows.time.back() / 0.77));
  }
  return rows;
}

TEST(PoincareSection, OfAPeriodicMotionIsOnePoint) {
  const PoincareSection s = circle().section(0.3, 0.77);
  ASSERT_EQ(s.time.size(), 13u);
  for (std::size_t k = 0; k < s.time.size(); ++k) {
    EXPECT_EQ(s.time[k], 0.3 + 0.77 * static_cast<double>(k));
    EXPECT_NEAR(s.values[0][k], std::cos(2.0 * M_PI * 0.3 / 0.77), s.uncertainty[0]);
  }
}

// A chord of a cosine errs by w^2 h^2/8 at most.
TEST(PoincareSection, ToldUncertaintyIsThatOfTheChord) {
  const double w = 2.0 * M_PI / 0.77, error = w * w * 1e-4 / 8.0;
  const double told = circle().section(0.0, 0.0131).uncertainty[0];
  EXPECT_GT(told, 0.99 * error);
  EXPECT_LT(told, 2.1 * error);
}

TEST(PoincareSection, TakesRowsThatItMeets) {
  const PoincareRows rows{{0.0, 1.0, 2.0, 3.0}, {1.0, 4.0, std::nan(""), 7.0}};
  const PoincareSection s = rows.section(1.0, 2.0);
  EXPECT_EQ(s.time, (std::vector{1.0, 3.0}));
  EXPECT_EQ(s.values[0], (std::vector{4.0, 7.0}));
}

TEST(PoincareSection, HoldsOnlyInstantsThatRowsReach) {
  const PoincareRows rows{{1.0, 2.0, 3.0}, {10.0, 20.0, 30.0}};
  EXPECT_EQ(rows.section(0.25, 0.5).time, (std::vector{1.25, 1.75, 2.25, 2.75}));
  EXPECT_EQ(rows.section(0.25, 0.5).values[0], (std::vector{12.5, 17.5, 22.5, 27.5}));
  EXPECT_TRUE(rows.section(3.5, 1.0).time.empty());
  EXPECT_EQ(rows.section(1.0, 2.0 + 1e-12).time.size(), 2u);  // the last row, but for rounding
}

}  // namespace
}  // namespace freeplay
