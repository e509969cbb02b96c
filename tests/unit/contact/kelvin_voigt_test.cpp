#include <cmath>

#include "law_probe.h"

namespace freeplay::test {
namespace {

ContactUnderTest make(double stiffness, double damping) {
  return {"kelvin-voigt", {{"K", stiffness}, {"D", damping}}, bare_pair()};
}

// K delta + D delta' with K = 2e7 N/m, D = 300 N s/m, by hand.
TEST(KelvinVoigt, ForceIsThatOfSpringAndDamper) {
  const ContactUnderTest law = make(2e7, 300.0);
  const struct {
    double penetration, rate, force;
  } cases[] = {{1e-6, 0.05, 35.0}, {1e-6, -0.05, 5.0}, {5e-6, 0.0, 100.0}, {1e-12, 0.1, 30.00002}};
  for (const auto& c : cases) EXPECT_NEAR(law.law.evaluate({c.penetration, c.rate, 0.1}).normal, c.force, 1e-12);
  for (const double rate : {-0.05, 0.0, 0.2}) expect_derivatives(law.law, {1e-6, rate, 0.1});
}

TEST(KelvinVoigt, ForceJumpsWhereTheContactBegins) {
  const ContactUnderTest law = make(2e7, 300.0);
  EXPECT_EQ(law.law.evaluate({0.0, 0.1, 0.1}).normal, 0.0);
  EXPECT_NEAR(law.law.evaluate({1e-15, 0.1, 0.1}).normal, 30.0, 1e-6);
}

TEST(KelvinVoigt, HasNoTensionAndKeepsItsEnergy) {
  const ContactForce f = make(2e7, 300.0).law.evaluate({1e-6, -0.1, 0.1});
  EXPECT_EQ(f.normal, 0.0);
  EXPECT_EQ(f.d_penetration, 0.0);
  EXPECT_EQ(f.d_rate, 0.0);
  EXPECT_NEAR(f.potential, 1e-5, 1e-20);  // 2e7 * 1e-12/2
}

TEST(KelvinVoigt, LeavesTheElasticPartWithoutApproachSpeed) {
  const ContactForce f = make(2e7, 300.0).law.evaluate({1e-6, 0.1, 0.0});
  EXPECT_NEAR(f.normal, 20.0, 1e-13);
  EXPECT_EQ(f.d_rate, 0.0);
}

// exp(-2 zeta acos(zeta)/sqrt(1 - zeta^2)): the force is cut where it would pull.
TEST(KelvinVoigt, ReboundsAsTheCutForceSays) {
  const struct {
    double zeta, ratio;
  } cases[] = {{0.05, 0.858758101775092}, {0.2, 0.571740027584777}, {0.5, 0.298436059192275}};
  const double stiffness = 2e7, mass = 0.2;
  for (const auto& c : cases) {
    const ContactUnderTest law = make(stiffness, 2.0 * c.zeta * std::sqrt(stiffness * mass));
    // The steps pass over the jump at the start and the cut: first order.
    EXPECT_NEAR(rebound_ratio(law.law, mass, 0.1, 1e-9), c.ratio, 5e-6);
  }
}

TEST(KelvinVoigt, TableBoundsStiffnessAndDamping) {
  const Parameter &k = parameter_of("kelvin-voigt", "K"), &d = parameter_of("kelvin-voigt", "D");
  EXPECT_TRUE(std::isnan(k.default_value));
  EXPECT_TRUE(std::isnan(d.default_value));
  EXPECT_EQ(k.minimum, 0.0);
  EXPECT_EQ(k.open, Open::minimum);
  EXPECT_EQ(d.minimum, 0.0);
  EXPECT_EQ(d.open, Open::none);
  EXPECT_STREQ(k.unit, "N/m");
  EXPECT_STREQ(d.unit, "N*s/m");
}

}  // namespace
}  // namespace freeplay::test
