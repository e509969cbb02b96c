#include "law_probe.h"

namespace freeplay::test {
namespace {

double stiffness(const ContactPair& pair) {
  // F = K delta^1.5 at delta = 1 m is K.
  return ContactUnderTest("hertz", {}, pair).law.evaluate({1.0, 0.0, 0.0}).normal;
}

// K = 4/(3(h_b + h_j)) sqrt(R_b R_j/(R_b - R_j)), closed form in 34 digits.
TEST(Hertz, StiffnessFollowsFromRadiiAndMaterial) {
  EXPECT_NEAR(stiffness(pair_of(0.005, 0.0049)) / 75062104464.4181, 1.0, 1e-13);
  EXPECT_NEAR(stiffness(pair_of(0.005, 0.00498)) / 169208575681.877, 1.0, 1e-12);  // rounding of R_b - R_j
  EXPECT_NEAR(stiffness(pair_of(0.005, 0.0048)) / 52532529987.8033, 1.0, 1e-13);
  EXPECT_NEAR(stiffness(pair_of(0.01, 0.0095)) / 66101983978.9685, 1.0, 1e-13);
  EXPECT_NEAR(stiffness(pair_of(0.008, 0.0079, bronze, steel)) / 85233797541.2324, 1.0, 1e-13);
}

ContactPair on_wall(SurfaceShape shape, double radius) {
  ContactPair pair{unknown, radius, 1e-4, unknown, steel, steel};
  pair.bearing_shape = SurfaceShape::plane;
  pair.journal_shape = shape;
  return pair;
}

// K = 4/(3(h_b + h_j)) sqrt(R_j): a wall has no curvature; h = (1 - 0.3^2)/207e9 of both.
TEST(Hertz, StiffnessOnAWallFollowsFromTheRadiusOfWhatTouchesIt) {
  const double expected = 4.0 / (3.0 * 2.0 * (1.0 - 0.09) / 207e9) * std::sqrt(0.005);
  for (const SurfaceShape shape : {SurfaceShape::cylinder, SurfaceShape::sphere, SurfaceShape::unknown})
    EXPECT_NEAR(stiffness(on_wall(shape, 0.005)) / expected, 1.0, 1e-14);
  const auto id = [](const ContactPair& pair) {
    return bad_parameter_id([&] { ContactUnderTest("hertz", {}, pair); });
  };
  EXPECT_EQ(id(on_wall(SurfaceShape::cylinder, unknown)), "missing-key");
  EXPECT_EQ(id(on_wall(SurfaceShape::corner, unknown)), "missing-key");
  EXPECT_EQ(id(on_wall(SurfaceShape::plane, unknown)), "missing-key");
  // A tenth of the radius, not of the play.
  const ContactUnderTest law("hertz", {}, on_wall(SurfaceShape::cylinder, 0.005));
  EXPECT_EQ(law.law.outside_range({4.9e-4, 0.0, 0.0}), nullptr);
  EXPECT_NE(law.law.outside_range({5.1e-4, 0.0, 0.0}), nullptr);
}

TEST(ContactPair, TellsAWallFromABearingWhoseRadiusIsNotKnown) {
  ContactPair pair = pair_of(0.005, 0.0049);
  EXPECT_NEAR(pair.relative_curvature(), 1.0 / 0.0049 - 1.0 / 0.005, 1e-12);
  EXPECT_TRUE(pair.conforming());
  pair.bearing_radius = unknown;
  EXPECT_TRUE(std::isnan(pair.relative_curvature()));
  EXPECT_FALSE(pair.conforming());
  pair.bearing_shape = SurfaceShape::cylinder;  // a bearing all the same
  EXPECT_TRUE(std::isnan(pair.relative_curvature()));
  EXPECT_TRUE(pair.conforming());
  pair.bearing_shape = SurfaceShape::plane;
  EXPECT_EQ(pair.relative_curvature(), 1.0 / 0.0049);
  EXPECT_FALSE(pair.conforming());
  EXPECT_TRUE(std::isnan(on_wall(SurfaceShape::corner, unknown).relative_curvature()));
  EXPECT_FALSE(on_wall(SurfaceShape::corner, unknown).conforming());
  EXPECT_TRUE(std::isnan(on_wall(SurfaceShape::plane, unknown).relative_curvature()));
  EXPECT_TRUE(on_wall(SurfaceShape::plane, unknown).conforming());
}

TEST(Hertz, IsElastic) {
  const ContactUnderTest under_test("hertz", {{"K", 75062104464.4181}}, bare_pair());
  for (const double rate : {-0.2, -0.05, 0.0, 0.05})
    EXPECT_NEAR(under_test.law.evaluate({1e-6, rate, 0.1}).normal, 75.0621044644181, 1e-12);
  EXPECT_EQ(under_test.law.evaluate({1e-6, 0.05, 0.1}).d_rate, 0.0);
}

TEST(Hertz, ForceVanishesWithoutPenetration) {
  const ContactUnderTest under_test("hertz", {{"K", 1e10}}, bare_pair());
  for (const double penetration : {-1e-6, 0.0}) {
    const ContactForce f = under_test.law.evaluate({penetration, 0.1, 0.1});
    EXPECT_EQ(f.normal, 0.0);
    EXPECT_EQ(f.d_penetration, 0.0);
    EXPECT_EQ(f.potential, 0.0);
  }
}

TEST(Hertz, PotentialIsTheIntegralOfTheForce) {
  // K delta^(n+1)/(n+1) = 3e9 * 1e-12 ... with n = 2: 3e9 * (1e-4)^3/3 = 1e-3 J
  const ContactUnderTest under_test("hertz", {{"K", 3e9}, {"exponent", 2.0}}, bare_pair());
  EXPECT_NEAR(under_test.law.evaluate({1e-4, 0.0, 0.1}).potential, 1e-3, 1e-17);
  EXPECT_NEAR(under_test.law.evaluate({1e-4, 0.0, 0.1}).normal, 30.0, 1e-12);
}

TEST(Hertz, DerivativesAgreeWithDifferences) {
  const ContactUnderTest point("hertz", {{"K", 7e10}}, bare_pair());
  const ContactUnderTest line("hertz", {{"K", 7e10}, {"exponent", 1.1}}, bare_pair());
  for (const double penetration : {1e-9, 1e-6, 1e-4}) {
    expect_derivatives(point.law, {penetration, 0.1, 0.1});
    expect_derivatives(line.law, {penetration, 0.1, 0.1});
  }
}

TEST(Hertz, RefusesAStiffnessThatDoesNotFollow) {
  const auto make = [](const Numbers& numbers, const ContactPair& pair) {
    return bad_parameter_id([&] { ContactUnderTest("hertz", numbers, pair); });
  };
  EXPECT_EQ(make({}, bare_pair()), "missing-key");
  EXPECT_EQ(make({}, pair_of(0.005, 0.0049, steel, no_material)), "missing-key");
  EXPECT_EQ(make({{"exponent", 1.2}}, pair_of(0.005, 0.0049)), "missing-key");
  EXPECT_EQ(make({{"exponent", 1.2}, {"K", 1e9}}, bare_pair()), "");
  EXPECT_EQ(make({}, pair_of(0.005, 0.0049)), "");
}

TEST(Hertz, SaysWhichParametersOfTheStiffnessAreMissing) {
  try {
    ContactUnderTest("hertz", {}, pair_of(0.005, 0.0049, steel, no_material));
    FAIL();
  } catch (const BadParameter& e) {
    EXPECT_STREQ(e.path(), "");
    EXPECT_STREQ(e.what(), "'K' is required, as it cannot be computed without the material of the journal");
  }
}

TEST(Hertz, WarnsOfConformalContactWhereItComputesTheStiffness) {
  const ContactUnderTest computed("hertz", {}, pair_of(0.005, 0.0049)),
      given("hertz", {{"K", 1e10}}, pair_of(0.005, 0.0049));
  EXPECT_EQ(computed.law.outside_range({0.9e-5, 0.0, 0.0}), nullptr);
  EXPECT_NE(computed.law.outside_range({1.1e-5, 0.0, 0.0}), nullptr);
  EXPECT_EQ(given.law.outside_range({1.1e-5, 0.0, 0.0}), nullptr);
}

}  // namespace
}  // namespace freeplay::test
