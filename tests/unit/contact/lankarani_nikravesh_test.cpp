#include "law_probe.h"

namespace freeplay::test {
namespace {

ContactUnderTest make(double restitution) {
  return {"lankarani-nikravesh", {{"restitution", restitution}}, pair_of(0.005, 0.0049)};
}

// Closed form K delta^1.5 (1 + chi delta'/v_0) with chi = 3(1 - 0.81)/4 = 0.1425, K = 75062104464.4181 N/m^1.5.
TEST(LankaraniNikravesh, ForceIsThatOfTheFormula) {
  const ContactUnderTest law = make(0.9);
  const struct {
    double penetration, rate, approach_speed, force;
  } cases[] = {{1e-6, 0.05, 0.1, 80.4102794075079}, {1e-6, -0.05, 0.1, 69.7139295213283},
               {5e-6, 0.0, 0.2, 839.219840583147},  {2.5e-7, 0.01, 0.01, 10.7198067938247},
               {1e-6, -0.2, 0.1, 53.669404692059},  {-1e-6, 0.1, 0.1, 0.0}};
  for (const auto& c : cases)
    EXPECT_NEAR(law.law.evaluate({c.penetration, c.rate, c.approach_speed}).normal, c.force, 1e-13 * (1.0 + c.force));
}

TEST(LankaraniNikravesh, DissipatesNothingWhenRestitutionIsOne) {
  const ContactUnderTest law = make(1.0);
  EXPECT_EQ(law.law.evaluate({1e-6, 0.3, 0.1}).normal, law.law.evaluate({1e-6, -0.3, 0.1}).normal);
}

TEST(LankaraniNikravesh, HasNoTension) {
  // 1 + chi delta'/v_0 is negative below delta' = -v_0/chi = -0.70 m/s; the energy stays.
  const ContactForce f = make(0.9).law.evaluate({1e-6, -0.8, 0.1});
  EXPECT_EQ(f.normal, 0.0);
  EXPECT_EQ(f.d_penetration, 0.0);
  EXPECT_EQ(f.d_rate, 0.0);
  EXPECT_NEAR(f.potential, 0.4 * 75.0621044644181 * 1e-6, 1e-18);
}

TEST(LankaraniNikravesh, LeavesTheElasticPartWithoutApproachSpeed) {
  const ContactForce f = make(0.9).law.evaluate({1e-6, 0.3, 0.0});
  EXPECT_NEAR(f.normal, 75.0621044644181, 1e-11);
  EXPECT_EQ(f.d_rate, 0.0);
}

TEST(LankaraniNikravesh, DerivativesAgreeWithDifferences) {
  const ContactUnderTest law = make(0.9);
  for (const double rate : {-0.3, 0.0, 0.2}) expect_derivatives(law.law, {1e-6, rate, 0.1});
}

// Out-speed ratio s of a drop with e = 0.9: root of chi(1 + s) = ln[(1 + chi)/(1 - chi s)], s = 0.913176677805581.
TEST(LankaraniNikravesh, ReboundsWithTheExactRatioOfItsLossFactor) {
  EXPECT_NEAR(rebound_ratio(make(0.9).law, 0.2, 0.1, 30e-9), 0.913176677805581, 1e-7);  // contact of about 120 us
}

TEST(LankaraniNikravesh, WarnsOfALowRestitution) {
  EXPECT_EQ(make(0.9).law.outside_range({1e-6, 0.0, 0.1}), nullptr);
  EXPECT_NE(make(0.5).law.outside_range({1e-6, 0.0, 0.1}), nullptr);
  EXPECT_NE(make(0.9).law.outside_range({2e-5, 0.0, 0.1}), nullptr);
}

TEST(LankaraniNikravesh, NeedsAStiffness) {
  EXPECT_EQ(bad_parameter_id([] {
              ContactUnderTest("lankarani-nikravesh", {{"restitution", 0.9}}, bare_pair());
            }),
            "missing-key");
}

}  // namespace
}  // namespace freeplay::test
