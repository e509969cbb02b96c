#include "damped_hertz_law.h"

namespace freeplay::test {
namespace {

TEST(HuGuo, ForceIsThatOfTheFormula) {
  expect_forces("hu-guo",
                {81.317279836453, 68.8069290923833, 839.219840583147, 10.946556901061, 50.0414029762787, 0.0});
}

TEST(HuGuo, ReboundsWithTheExactRatioOfItsLossFactor) {
  expect_rebounds("hu-guo", {{0.9, 0.166666666666667, 0.899899943072231},
                             {0.7, 0.642857142857143, 0.697296968060859},
                             {0.5, 1.5, 0.487741256015349},
                             {0.3, 3.5, 0.270658458564543},
                             {0.1, 13.5, 0.0740735323633638}});
}

TEST(HuGuo, IsSmoothAndHasNoTension) { expect_smooth_without_tension("hu-guo"); }

TEST(HuGuo, ServesEveryRestitution) { expect_range("hu-guo", 0); }

TEST(HuGuo, RefusesWhatDoesNotDefineIt) { expect_refusals("hu-guo"); }

}  // namespace
}  // namespace freeplay::test
