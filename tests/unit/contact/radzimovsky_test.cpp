#include "line_contact_law.h"

namespace freeplay::test {
namespace {

TEST(Radzimovsky, ForceAndSlopeAreThoseOfTheFormula) {
  expect_line_forces("radzimovsky", {{0.015, 0.0001, 1e-08, 4.32635471910777, 470624346.298799},
                                     {0.015, 0.0001, 1e-07, 54.3726149875525, 605113198.981901},
                                     {0.015, 0.0001, 1e-06, 739.559075673854, 857942520.781546},
                                     {0.015, 0.0001, 1e-05, 12020.36341708, 1549561578.93388},
                                     {0.02, 0.0005, 1e-06, 786.833109738228, 884185643.641632},
                                     {0.02, 0.0005, 2e-05, 25505.6501901356, 1552296928.81891}});
}

TEST(Radzimovsky, ForceSolvesTheFormulaUpToTheLimit) {
  expect_line_law("radzimovsky", 3.125, 2.0 / 3.0, 7.12746874737079e-05);
}

TEST(Radzimovsky, PotentialIsTheIntegralOfTheForce) { expect_line_potential("radzimovsky", 3.125, 2.0 / 3.0); }

TEST(Radzimovsky, FailsFromTheLimitOn) { expect_line_limit("radzimovsky", 7.12746874737079e-05); }

TEST(Radzimovsky, TakesTheLossFactorOfAnotherLaw) { expect_line_damping("radzimovsky"); }

TEST(Radzimovsky, RefusesWhatDoesNotDefineIt) { expect_line_refusals("radzimovsky"); }

}  // namespace
}  // namespace freeplay::test
