#include "damped_hertz_law.h"

namespace freeplay::test {
namespace {

TEST(Gonthier, ForceIsThatOfTheFormula) {
  expect_forces("gonthier",
                {82.9853266023289, 67.1388823265073, 839.219840583147, 11.36356859253, 43.3692159127749, 0.0});
}

TEST(Gonthier, ReboundsWithTheExactRatioOfItsLossFactor) {
  expect_rebounds("gonthier", {{0.9, 0.211111111111111, 0.876435423861755},
                               {0.7, 0.728571428571429, 0.669581319748305},
                               {0.5, 1.5, 0.487741256015349},
                               {0.3, 3.03333333333333, 0.304224863917253},
                               {0.1, 9.9, 0.100989774217969}});
}

TEST(Gonthier, IsSmoothAndHasNoTension) { expect_smooth_without_tension("gonthier"); }

TEST(Gonthier, ServesEveryRestitution) { expect_range("gonthier", 0); }

TEST(Gonthier, RefusesWhatDoesNotDefineIt) { expect_refusals("gonthier"); }

}  // namespace
}  // namespace freeplay::test
