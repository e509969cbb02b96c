#include "run/ringing.h"

#include <cmath>

#include <gtest/gtest.h>

namespace freeplay {
namespace {

double amplitude(double steps_in_period, int steps, double drift = 0.0) {
  Ringing ringing;
  ringing.restart(5.0);
  for (int i = 1; i <= steps; ++i) ringing.see(5.0 + drift * i + 2.0 * std::sin(2.0 * M_PI * i / steps_in_period));
  return ringing.largest();
}

TEST(Ringing, IsTheAmplitudeOfASwingOfFewSteps) { EXPECT_NEAR(amplitude(8.0, 40), 2.0, 1e-12); }
TEST(Ringing, IsThatOfTheSmallerOfTwoSwingsInARow) {
  Ringing ringing;
  for (const double value : {0.0, 1.0, 0.0, 9.0, 8.0, 9.0, 0.0}) ringing.see(value);
  EXPECT_DOUBLE_EQ(ringing.largest(), 0.5);
}
TEST(Ringing, IsNoneOfWhatSwingsSlowly) { EXPECT_EQ(amplitude(40.0, 400), 0.0); }
TEST(Ringing, IsNoneOfOneTurningPoint) { EXPECT_EQ(amplitude(8.0, 5), 0.0); }
TEST(Ringing, IsNoneOfWhatOnlyGrows) { EXPECT_EQ(amplitude(8.0, 40, 3.0), 0.0); }
TEST(Ringing, ForgetsTheLastSwingWhereItBeginsAnew) {
  Ringing ringing;
  for (const double value : {0.0, 1.0, 0.0}) ringing.see(value);
  ringing.restart(7.0);
  for (const double value : {8.0, 7.0}) ringing.see(value);
  EXPECT_EQ(ringing.largest(), 0.0);
}

}  // namespace
}  // namespace freeplay
