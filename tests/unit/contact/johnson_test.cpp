#include "line_contact_law.h"

namespace freeplay::test {
namespace {

TEST(Johnson, ForceAndSlopeAreThoseOfTheFormula) {
  expect_line_forces("johnson", {{0.015, 0.0001, 1e-08, 4.43355832850724, 483337693.638262},
                                 {0.015, 0.0001, 1e-07, 56.1185846877624, 626816553.05122},
                                 {0.015, 0.0001, 1e-06, 773.753918996183, 904304027.649621},
                                 {0.015, 0.0001, 1e-05, 13072.9905073925, 1729032455.47136},
                                 {0.02, 0.0005, 1e-06, 814.618168251243, 919425539.776444},
                                 {0.02, 0.0005, 2e-05, 27138.3256176508, 1674952627.5269}});
}

TEST(Johnson, ForceSolvesTheFormulaUpToTheLimit) { expect_line_law("johnson", 4.0 * M_PI, -1.0, 5.41341132946451e-05); }

TEST(Johnson, PotentialIsTheIntegralOfTheForce) { expect_line_potential("johnson", 4.0 * M_PI, -1.0); }

TEST(Johnson, FailsFromTheLimitOn) { expect_line_limit("johnson", 5.41341132946451e-05); }

TEST(Johnson, TakesTheLossFactorOfAnotherLaw) { expect_line_damping("johnson"); }

TEST(Johnson, RefusesWhatDoesNotDefineIt) { expect_line_refusals("johnson"); }

// The ratio of a point contact with the same loss factor: hunt-crossley at e = 0.9.
TEST(Johnson, ReboundsAsItsLossFactorSays) {
  const ContactUnderTest law("johnson", {{"restitution", 0.9}}, line_pair(0.015, 1e-4), {{"damping", 1}});
  EXPECT_NEAR(rebound_ratio(law.law, 0.2, 0.1, 10e-9), 0.909015741349202, 1e-6);  // the slope has a kink at delta = 0
}

TEST(Johnson, SaysWhichParameterIsMissing) {
  try {
    ContactUnderTest("johnson", {}, bare_pair());
    FAIL();
  } catch (const BadParameter& e) {
    EXPECT_STREQ(e.path(), "");
    EXPECT_STREQ(e.what(),
                 "this law cannot do without 'length', the material of the bearing, the material of the journal");
  }
}

}  // namespace
}  // namespace freeplay::test
