#include "damped_hertz_law.h"

namespace freeplay::test {
namespace {

TEST(LeeWang, ForceIsThatOfTheFormula) {
  expect_forces("lee-wang",
                {77.8769333818338, 72.2472755470024, 839.219840583147, 10.0864702874062, 63.8027887947554, 0.0});
}

TEST(LeeWang, ReboundsWithTheExactRatioOfItsLossFactor) {
  expect_rebounds("lee-wang", {{0.9, 0.075, 0.952370152820406},
                               {0.7, 0.225, 0.869343110347063},
                               {0.5, 0.375, 0.799198782193568},
                               {0.3, 0.525, 0.738995319529823},
                               {0.1, 0.675, 0.686663439055472}});
}

TEST(LeeWang, IsSmoothAndHasNoTension) { expect_smooth_without_tension("lee-wang"); }

TEST(LeeWang, KnowsItsRangeOfRestitution) { expect_range("lee-wang", 0.9); }

TEST(LeeWang, RefusesWhatDoesNotDefineIt) { expect_refusals("lee-wang"); }

}  // namespace
}  // namespace freeplay::test
