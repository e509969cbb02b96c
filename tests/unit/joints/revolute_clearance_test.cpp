#include "clearance_play.h"

namespace freeplay::test {
namespace {

// delta = -4e-5 + 0.2 s + 5 s^2 for e = (0.6e-4, 0), e' = (0.2, 0), e'' = (10, 0): s = 1.990...e-4 s,
// v_0 = sqrt(0.2^2 + 2 10 4e-5) = 0.2019900988... m/s.
TEST(RevoluteClearance, PredictsTheApproachSpeedOfAContactInsideTheStep) {
  Play play(radii());
  play.b = planar_marker(0.6e-4, 0.0, 0.0, 0.2);
  MarkerAccelerations acc{};
  acc.a[0] = -4.0;
  acc.b[0] = 6.0;
  play.begin_step(1e-3, acc);
  play.b = planar_marker(c + 1e-6, 0.0, 0.0, 0.21);
  const double v0 = std::sqrt(0.04 + 20.0 * 4e-5);
  EXPECT_NEAR(play.apply()[0], lankarani_nikravesh({1e-6, 0.21, v0}).normal, 1e-7);
  // Told inside a fixed step, the contact keeps what the forces have used.
  play.on_event(0, 2e-4);
  play.b = planar_marker(c + 1e-6, 0.0, 0.0, -0.05);
  EXPECT_NEAR(play.apply()[0], lankarani_nikravesh({1e-6, -0.05, v0}).normal, 1e-7);
}

// delta = -1e-5 - 0.01 s + 10 s^2: it turns back and touches at s = 1.62e-3 s with v_0 = sqrt(0.01^2 + 2 20 1e-5) m/s.
TEST(RevoluteClearance, PredictsAJournalThatTurnsBack) {
  Play play(radii());
  MarkerAccelerations acc{};
  acc.b[0] = 20.0;
  const auto force_after = [&](double dt) {
    play.b = planar_marker(c - 1e-5, 0.0, 0.0, -0.01);
    play.begin_step(dt, acc);
    play.b = planar_marker(c + 1e-6, 0.0, 0.0, 0.03);
    return play.apply()[0];
  };
  EXPECT_NEAR(force_after(2e-3), lankarani_nikravesh({1e-6, 0.03, std::sqrt(5e-4)}).normal, 1e-7);
  EXPECT_NEAR(force_after(1e-3), lankarani_nikravesh({1e-6, 0.03, 0.03}).normal, 1e-7);
}

TEST(RevoluteClearance, TurningEccentricityDrivesThePrediction) {
  // e = (0.8e-4, 0), e' = (0, 0.1): delta'' = 0.01/0.8e-4 = 125; root of -2e-5 + 62.5 s^2 at 5.66e-4 s, but |e'| = 0.1
  // caps v_0 = 125 * 5.66e-4 = 0.0707 no further.
  Play play(radii());
  play.b = planar_marker(0.8e-4, 0.0, 0.0, 0.0, 0.1);
  play.begin_step(1e-3);
  play.b = planar_marker(c + 1e-6, 0.0, 0.0, 0.06);
  const double v0 = 125.0 * std::sqrt(2e-5 / 62.5);
  EXPECT_NEAR(play.apply()[0], lankarani_nikravesh({1e-6, 0.06, v0}).normal, 1e-7);
}

// Near the centre the parabola would say delta'' = 0.01/1e-10 = 1e8 m/s^2 and v_0 = 141 m/s.
TEST(RevoluteClearance, PredictedApproachSpeedNeverExceedsTheSpeed) {
  Play play(radii());
  play.b = planar_marker(1e-10, 0.0, 0.0, 0.0, 0.1);
  play.begin_step(1.1e-3);
  play.b = planar_marker(c + 1e-6, 0.0, 0.0, 0.05);
  EXPECT_NEAR(play.apply()[0], lankarani_nikravesh({1e-6, 0.05, 0.1}).normal, 1e-7);
}

TEST(RevoluteClearance, PredictsNothingForAContactBeyondTheStep) {
  Play play(radii());
  play.b = planar_marker(0.6e-4, 0.0, 0.0, 0.2);
  play.begin_step(1e-4);  // the gap closes after 2e-4 s
  play.b = planar_marker(c + 1e-6, 0.0, 0.0, 0.15);
  // The rate of the state itself counts: F = F_s (1 + chi).
  EXPECT_NEAR(play.apply()[0], K * 1e-9 * (1.0 + chi), 1e-7);
}

TEST(RevoluteClearance, LocatedContactTakesTheRateOfTheEvent) {
  Play play(radii());
  play.b = planar_marker(0.99e-4, 0.0, 0.0, 0.2);
  play.begin_step(5e-6);
  play.b = planar_marker(c, 0.0, 0.0, 0.19);
  const auto fields = play.on_event(0, 5e-6);
  EXPECT_EQ(fields[0], 0.19);
  EXPECT_TRUE(std::isnan(fields[3]) && std::isnan(fields[6]));
  play.b = planar_marker(c + 1e-6, 0.0, 0.0, 0.1);
  EXPECT_NEAR(play.apply()[0], lankarani_nikravesh({1e-6, 0.1, 0.19}).normal, 1e-7);
}

TEST(RevoluteClearance, GrazingContactHasAFloorUnderItsApproachSpeed) {
  Play play(radii());
  play.b = planar_marker(c, 0.0, 0.0, 1e-9);
  play.on_event(0, 0.0);
  play.b = planar_marker(c + 1e-6, 0.0, 0.0, 1e-7);
  EXPECT_NEAR(play.apply()[0], lankarani_nikravesh({1e-6, 1e-7, 1e-6}).normal, 1e-7);
}

TEST(RevoluteClearance, EventsAreArmedByTheContactFlag) {
  Play play(radii());
  play.b = planar_marker(0.5 * c, 0.0, 0.0, 0.2);
  EXPECT_NEAR(play.events().g[0], -0.5 * c, 1e-18);
  EXPECT_NEAR(play.events().rate[0], 0.2, 1e-15);
  EXPECT_TRUE(std::isnan(play.events().g[1]));
  play.touch(0.2);
  EXPECT_TRUE(std::isnan(play.events().g[0]));
  EXPECT_NEAR(play.events().g[1], -0.5 * c, 1e-18);
}

TEST(RevoluteClearance, EndOfContactReportsItsHistory) {
  Play play(radii());
  play.begin_step(1e-5, {}, 1.0);
  play.b = planar_marker(0.0, c, 0.0, 0.0, 0.2);
  play.on_event(0, 1.0);
  for (const double depth : {1e-6, 3e-6, 2e-6}) {
    play.b = planar_marker(0.0, c + depth, 0.0, 0.0, 0.0);
    play.commit(1.0 + 10.0 * depth);
  }
  play.b = planar_marker(0.0, c, 0.0, 0.05, -0.18);
  const auto fields = play.on_event(1, 1.25);
  EXPECT_EQ(fields[0], 0.18);
  EXPECT_NEAR(fields[1], -0.05, 1e-15);  // t = (-1, 0)
  EXPECT_NEAR(fields[2], M_PI / 2, 1e-15);
  EXPECT_EQ(fields[3], 0.25);
  EXPECT_NEAR(fields[4], K * std::pow(3e-6, 1.5), 1e-7);
  EXPECT_NEAR(fields[5], 3e-6, 1e-18);
  EXPECT_EQ(fields[6], 4.0);  // three and the step in which it ends
  EXPECT_FALSE(std::isnan(play.events().g[0]));
  EXPECT_EQ(play.observe()[6], 0.0);
}

TEST(RevoluteClearance, ContactWithoutAnEventBeginsOnCommit) {
  Play play(radii());
  play.b = planar_marker(c + 1e-6, 0.0, 0.0, 0.1);
  play.commit(1e-4);
  EXPECT_EQ(play.observe()[6], 1.0);
  play.b = planar_marker(c + 2e-6, 0.0, 0.0, 0.05);
  EXPECT_NEAR(play.apply()[0], lankarani_nikravesh({2e-6, 0.05, 0.1}).normal, 1e-6);
  // Left over from the rounding of a located end: leaving, so no contact.
  Play leaving(radii());
  leaving.b = planar_marker(c + 1e-13, 0.0, 0.0, -0.1);
  leaving.commit(1e-4);
  EXPECT_EQ(leaving.observe()[6], 0.0);
}

TEST(RevoluteClearance, ContactFromTheStartIsElasticAndItsEventIsStillDue) {
  Play play(radii());
  play.b = planar_marker(c + 1e-6, 0.0, 0.0, 0.3);
  play.initialize();
  EXPECT_NEAR(play.apply()[0], K * 1e-9, 1e-7);
  EXPECT_GT(play.events().g[0], 0.0);
  play.on_event(0, 0.0);
  EXPECT_TRUE(std::isnan(play.events().g[0]));
  EXPECT_NEAR(play.apply()[0], K * 1e-9, 1e-7);
}

TEST(RevoluteClearance, LoadedStartCarriesTheReaction) {
  ParameterStub stub = radii();
  stub.words["clearance.initial"] = 1;
  Play play(stub);
  const double distance = c + std::pow(50.0 / K, 1.0 / 1.5);
  const InitialOffset offset = play.offset(30.0, 40.0);
  // 0.005 - 0.0049 differs from 1e-4 by 3e-19.
  EXPECT_NEAR(offset.position[0], -0.6 * distance, 1e-18);
  EXPECT_NEAR(offset.position[1], -0.8 * distance, 1e-18);
  play.b = planar_marker(offset.position[0], offset.position[1], 0.0);
  play.initialize();
  const auto w = play.apply();
  EXPECT_NEAR(w[6], 30.0, 1e-9);
  EXPECT_NEAR(w[7], 40.0, 1e-9);
  EXPECT_EQ(play.offset(1e-13, 0.0).position[0], 0.0);
}

TEST(RevoluteClearance, StartIsCentredOrAsWritten) {
  EXPECT_EQ(Play(radii()).offset(30.0, 40.0).position[0], 0.0);
  ParameterStub stub = radii();
  stub.words["clearance.initial"] = -1;
  stub.vectors["clearance.initial.eccentricity"] = {1e-5, -2e-5};
  stub.vectors["clearance.initial.velocity"] = {0.1, 0.2};
  const InitialOffset offset = Play(stub).offset(30.0, 40.0);
  EXPECT_EQ(offset.position[1], -2e-5);
  EXPECT_EQ(offset.velocity[0], 0.1);
}

TEST(RevoluteClearance, IsTheTwinOfRevoluteWithALinkOfTheClearance) {
  EXPECT_STREQ(row().description.ideal, "revolute");
  EXPECT_STREQ(row().description.block, "clearance");
  EXPECT_NEAR(Play(radii()).layout.clearance, c, 1e-18);
  const char* names[] = {"ex", "ey", "delta", "fn", "ft", "power", "contact", "vt"};
  const JointLayout layout = Play(radii()).layout;
  ASSERT_EQ(layout.channels.size, 8u);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_STREQ(layout.channels[i].name, names[i]);
}

std::string fault(const ParameterStub& stub) {
  return bad_parameter_id([&] { Play play(stub); });
}

TEST(RevoluteClearance, AnyTwoRadiiWillDo) {
  for (const auto& given :
       {radii({{"bearing_radius", 0.005}, {"journal_radius", 0.0049}}),
        radii({{"bearing_radius", 0.005}, {"radial_clearance", 1e-4}}),
        radii({{"journal_radius", 0.0049}, {"radial_clearance", 1e-4}}),
        radii({{"bearing_radius", 0.005}, {"journal_radius", 0.0049}, {"radial_clearance", 1e-4}})}) {
    Play play(given);
    EXPECT_NEAR(given.pair.bearing_radius, 0.005, 1e-17);
    EXPECT_NEAR(given.pair.journal_radius, 0.0049, 1e-17);
    EXPECT_NEAR(given.pair.radial_clearance, 1e-4, 1e-17);
  }
}

TEST(RevoluteClearance, RefusesRadiiThatAreMissingOrDisagree) {
  EXPECT_EQ(fault(radii({})), "missing-key");
  EXPECT_EQ(fault(radii({{"bearing_radius", 0.005}})), "missing-key");
  EXPECT_EQ(fault(radii({{"bearing_radius", 0.005}, {"journal_radius", 0.0049}, {"radial_clearance", 1.001e-4}})),
            "conflicting-keys");
  EXPECT_EQ(fault(radii({{"bearing_radius", 0.0049}, {"journal_radius", 0.005}})), "out-of-range");
  EXPECT_EQ(fault(radii({{"bearing_radius", 0.005}, {"radial_clearance", 0.006}})), "out-of-range");
}

TEST(RevoluteClearance, ClearanceAloneIsEnoughWithoutFriction) {
  ParameterStub stub = radii({{"radial_clearance", 1e-4}});
  Play play(stub);
  EXPECT_TRUE(std::isnan(stub.pair.bearing_radius));
  play.b = planar_marker(c + 1e-6, 0.0, 0.0, 0.0, 0.0, 7.0);
  play.touch(0.1);
  EXPECT_NEAR(play.apply()[0], K * 1e-9, 1e-7);
  EXPECT_EQ(play.apply()[5], 0.0);
  stub.friction = std::make_shared<FunctionFriction>(ramp);
  EXPECT_EQ(fault(stub), "missing-key");
}

TEST(RevoluteClearance, MaterialIsForBothSidesOrForEach) {
  ParameterStub stub = radii();
  stub.numbers["clearance.material.E"] = 207e9;
  EXPECT_EQ(fault(stub), "missing-key");
  stub.numbers["clearance.material.nu"] = 0.3;
  EXPECT_EQ(fault(stub), "");
  EXPECT_EQ(stub.pair.journal.youngs_modulus, 207e9);
  stub.numbers["clearance.material.bearing.E"] = 110e9;
  stub.numbers["clearance.material.bearing.nu"] = 0.34;
  EXPECT_EQ(fault(stub), "conflicting-keys");
  stub.numbers.erase("clearance.material.E");
  stub.numbers.erase("clearance.material.nu");
  EXPECT_EQ(fault(stub), "missing-key");
  stub.numbers["clearance.material.journal.E"] = 207e9;
  stub.numbers["clearance.material.journal.nu"] = 0.3;
  EXPECT_EQ(fault(stub), "");
  EXPECT_EQ(stub.pair.bearing.poisson_ratio, 0.34);
}

TEST(RevoluteClearance, EndOfContactClearsTheBristle) {
  Play play(with_bristle());
  play.touch(0.1);
  play.z[0] = 1e-5;
  play.b = planar_marker(c, 0.0, 0.0, -0.1);
  play.on_event(1, 1e-4);
  EXPECT_EQ(play.z[0], 0.0);
}

}  // namespace
}  // namespace freeplay::test
