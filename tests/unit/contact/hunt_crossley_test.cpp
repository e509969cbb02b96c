#include "damped_hertz_law.h"

namespace freeplay::test {
namespace {

TEST(HuntCrossley, ForceIsThatOfTheFormula) {
  expect_forces("hunt-crossley",
                {80.6917622992495, 69.4324466295868, 839.219840583147, 10.7901775167601, 52.5434731250927, 0.0});
}

TEST(HuntCrossley, ReboundsWithTheExactRatioOfItsLossFactor) {
  expect_rebounds("hunt-crossley", {{0.9, 0.15, 0.909015741349202},
                                    {0.7, 0.45, 0.767999789078476},
                                    {0.5, 0.75, 0.662962200001546},
                                    {0.3, 1.05, 0.581288041808574},
                                    {0.1, 1.35, 0.515832616400396}});
}

TEST(HuntCrossley, IsSmoothAndHasNoTension) { expect_smooth_without_tension("hunt-crossley"); }

TEST(HuntCrossley, KnowsItsRangeOfRestitution) { expect_range("hunt-crossley", 0.9); }

TEST(HuntCrossley, RefusesWhatDoesNotDefineIt) { expect_refusals("hunt-crossley"); }

}  // namespace
}  // namespace freeplay::test
