#include "damped_hertz_law.h"

namespace freeplay::test {
namespace {

TEST(ZhiyingQishao, ForceIsThatOfTheFormula) {
  expect_forces("zhiying-qishao",
                {81.5943800910311, 68.5298288378051, 839.219840583147, 11.0158319647055, 48.9330019579662, 0.0});
}

TEST(ZhiyingQishao, ReboundsWithTheExactRatioOfItsLossFactor) {
  expect_rebounds("zhiying-qishao", {{0.9, 0.174049893037824, 0.89591818639379},
                                     {0.7, 0.69696044114937, 0.679566506477271},
                                     {0.5, 1.52903352850821, 0.48260802056123},
                                     {0.3, 2.76767397737149, 0.32669740280354},
                                     {0.1, 4.49186324232661, 0.217469340613765}});
}

TEST(ZhiyingQishao, IsSmoothAndHasNoTension) { expect_smooth_without_tension("zhiying-qishao"); }

TEST(ZhiyingQishao, KnowsItsRangeOfRestitution) { expect_range("zhiying-qishao", 0.4); }

TEST(ZhiyingQishao, RefusesWhatDoesNotDefineIt) { expect_refusals("zhiying-qishao"); }

}  // namespace
}  // namespace freeplay::test
