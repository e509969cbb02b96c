#include "damped_hertz_law.h"

namespace freeplay::test {
namespace {

TEST(Flores, ForceIsThatOfTheFormula) {
  expect_forces("flores",
                {81.734291527922, 68.3899174009143, 839.219840583147, 11.0508098239282, 48.3733562104028, 0.0});
}

TEST(Flores, ReboundsWithTheExactRatioOfItsLossFactor) {
  expect_rebounds("flores", {{0.9, 0.177777777777778, 0.893920692663378},
                             {0.7, 0.685714285714286, 0.683184199730684},
                             {0.5, 1.6, 0.47044477932674},
                             {0.3, 3.73333333333333, 0.256207906679824},
                             {0.1, 14.4, 0.0694442251515404}});
}

TEST(Flores, IsSmoothAndHasNoTension) { expect_smooth_without_tension("flores"); }

TEST(Flores, ServesEveryRestitution) { expect_range("flores", 0); }

TEST(Flores, RefusesWhatDoesNotDefineIt) { expect_refusals("flores"); }

}  // namespace
}  // namespace freeplay::test
