#include "damped_hertz_law.h"

namespace freeplay::test {
namespace {

TEST(HerbertMcwhannell, ForceIsThatOfTheFormula) {
  expect_forces("herbert-mcwhannell",
                {81.2485416455515, 68.8756672832848, 839.219840583147, 10.9293723533356, 50.3163557398847, 0.0});
}

TEST(HerbertMcwhannell, ReboundsWithTheExactRatioOfItsLossFactor) {
  expect_rebounds("herbert-mcwhannell", {{0.9, 0.164835164835165, 0.900892985676143},
                                         {0.7, 0.569620253164557, 0.722682649087923},
                                         {0.5, 1.0, 0.59362426004004},
                                         {0.3, 1.32911392405063, 0.519966554943413},
                                         {0.1, 1.48351648351648, 0.490697659633628}});
}

TEST(HerbertMcwhannell, IsSmoothAndHasNoTension) { expect_smooth_without_tension("herbert-mcwhannell"); }

TEST(HerbertMcwhannell, KnowsItsRangeOfRestitution) { expect_range("herbert-mcwhannell", 0.5); }

TEST(HerbertMcwhannell, RefusesWhatDoesNotDefineIt) { expect_refusals("herbert-mcwhannell"); }

}  // namespace
}  // namespace freeplay::test
