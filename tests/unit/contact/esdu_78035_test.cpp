#include "line_contact_law.h"

namespace freeplay::test {
namespace {

TEST(Esdu78035, ForceAndSlopeAreThoseOfTheFormula) {
  expect_line_forces("esdu-78035", {{0.015, 0.0001, 1e-08, 3.7602270786512, 404393969.864444},
                                    {0.015, 0.0001, 1e-07, 45.5809191404735, 498176004.242868},
                                    {0.015, 0.0001, 1e-06, 581.818686614683, 652668777.873824},
                                    {0.015, 0.0001, 1e-05, 8155.79123845796, 961959476.395308},
                                    {0.02, 0.0005, 1e-06, 649.738135658205, 714720543.16286},
                                    {0.02, 0.0005, 2e-05, 18711.5235024481, 1076511179.10226}});
}

TEST(Esdu78035, ForceSolvesTheFormulaUpToTheLimit) { expect_line_law("esdu-78035", 4.0 * M_PI, 1.0, 4e-4); }

TEST(Esdu78035, PotentialIsTheIntegralOfTheForce) { expect_line_potential("esdu-78035", 4.0 * M_PI, 1.0); }

TEST(Esdu78035, FailsFromTheLimitOn) { expect_line_limit("esdu-78035", 4e-4); }

TEST(Esdu78035, TakesTheLossFactorOfAnotherLaw) { expect_line_damping("esdu-78035"); }

TEST(Esdu78035, RefusesWhatDoesNotDefineIt) { expect_line_refusals("esdu-78035"); }

}  // namespace
}  // namespace freeplay::test
