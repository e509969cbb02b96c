#include <gtest/gtest.h>

#include "model_text.h"

namespace freeplay {
namespace {

/// Two pins, a slide and a gear, which stands on line 10 from column 6 on.
Built geared(const std::string& gear) {
  return build(
      "freeplay: 1\n"
      "bodies:\n"
      "  wheel: {mass: 1, inertia: 1}\n"
      "  pinion: {mass: 1, inertia: 1}\n"
      "  rack: {mass: 1, inertia: 1}\n"
      "joints:\n"
      "  W: {type: pin, between: [ground, wheel]}\n"
      "  P: {type: pin, between: [ground, pinion]}\n"
      "  R: {type: slide, between: [ground, rack]}\n"
      "  G: " +
      gear + "\n");
}

TEST(Gear, CouplesTwoJointsWhereverTheyStand) {
  const Built built = build(
      "freeplay: 1\n"
      "bodies: {wheel: {mass: 1, inertia: 1}, pinion: {mass: 1, inertia: 1}}\n"
      "joints:\n"
      "  G: {type: gear, of: [W, P], ratio: -2, offset: 30 deg}\n"
      "  W: {type: pin, between: [ground, wheel]}\n"
      "  P: {type: pin, between: [ground, pinion]}\n");
  ASSERT_TRUE(built.model) << built.report;
  ASSERT_EQ(built.model->gears.size(), 1u);
  const Gear& gear = built.model->gears.front();
  EXPECT_EQ(gear.joint, 0);
  EXPECT_EQ(gear.first, 1);
  EXPECT_EQ(gear.second, 2);
  EXPECT_EQ(gear.ratio, -2.0);
  EXPECT_NEAR(*gear.offset, M_PI / 6, 1e-15);
  EXPECT_EQ(built.model->joints.front().gear, 0);
}

TEST(Gear, RatioHasTheDimensionOfTheCoordinates) {
  const Built rack = geared("{type: gear, of: [P, R], ratio: 20 mm, offset: auto}");
  ASSERT_TRUE(rack.model) << rack.report;
  EXPECT_NEAR(rack.model->gears.front().ratio, 0.02, 1e-17);
  EXPECT_FALSE(rack.model->gears.front().offset);
  EXPECT_TRUE(geared("{type: gear, of: [R, P], ratio: 50 rad/m}").model);
  EXPECT_EQ(geared("{type: gear, of: [W, P], ratio: 20 mm}").places, "10:38 dimension-mismatch ");
}

TEST(Gear, RatioIsRequiredAndNotZero) {
  EXPECT_EQ(geared("{type: gear, of: [W, P]}").places, "10:3 missing-key ");
  EXPECT_EQ(geared("{type: gear, of: [W, P], ratio: 0}").places, "10:38 out-of-range ");
}

TEST(Gear, NeedsTwoJointsWithACoordinate) {
  EXPECT_EQ(geared("{type: gear, of: [W, Q], ratio: 1}").places, "10:27 unknown-name ");
  EXPECT_EQ(geared("{type: gear, of: [W, W], ratio: 1}").places, "10:27 duplicate-name ");
  EXPECT_EQ(geared("{type: gear, of: [W, G], ratio: 1}").places, "10:27 wrong-type ");
  EXPECT_EQ(geared("{type: gear, of: [W], ratio: 1}").places, "10:23 wrong-length ");
  EXPECT_EQ(geared("{type: gear, between: [ground, wheel], of: [W, P], ratio: 1}").places, "10:19 unknown-key ");
}

TEST(Gear, IsSuggestedAndIsNotDriven) {
  EXPECT_NE(geared("{type: geer, of: [W, P], ratio: 1}").report.find("did you mean 'gear'?"), std::string::npos);
  const Built built = geared("{type: gear, of: [W, P], ratio: 1}\ndrivers:\n  d: {joint: G, kind: angle, value: 0}");
  EXPECT_EQ(built.places, "12:14 wrong-type ");
}

}  // namespace
}  // namespace freeplay
