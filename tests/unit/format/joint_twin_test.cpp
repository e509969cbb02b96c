#include <gtest/gtest.h>

#include "model_text.h"

namespace freeplay {
namespace {

const std::string loose = with_rod(
    "parameters: {c: 1 mm, k: 5e9}\n"
    "joints:\n"
    "  a: {type: pin, ring: ground, shaft: rod, play: {gap: $c, contact: {law: power, K: $k, exponent: 2}}}\n");

TEST(JointTwins, ABlockMakesTheTypeItsTwin) {
  const Built built = build(loose);
  ASSERT_TRUE(built.model) << built.report;
  const JointElement& joint = built.model->joints[0];
  EXPECT_TRUE(joint.has_play);
  EXPECT_STREQ(joint.component->description.name, "loose-pin");
  EXPECT_STREQ(joint.ideal_component()->description.name, "pin");
  EXPECT_DOUBLE_EQ(joint.layout.clearance, 1e-3);
  EXPECT_EQ(joint.ideal_layout().constraint_rows, 2);
  EXPECT_EQ(built.model->clearance_joints(), 1);
}

TEST(JointTwins, TheTwinMayBeNamedDirectly) {
  const Built built = build(
      with_rod("joints: {a: {type: loose-pin, between: [ground, rod], play: {gap: 1, contact: {law: power, K: 1}}}}"));
  ASSERT_TRUE(built.model) << built.report;
  EXPECT_TRUE(built.model->joints[0].has_play);
}

TEST(JointTwins, IdealClosesThePlayButItsBlockIsStillChecked) {
  BuildOptions options;
  options.ideal = {"all"};
  const Built built = build(loose, options);
  ASSERT_TRUE(built.model) << built.report;
  EXPECT_FALSE(built.model->joints[0].has_play);
  EXPECT_STREQ(built.model->joints[0].component->description.name, "pin");
  EXPECT_EQ(built.model->joints[0].layout.constraint_rows, 2);
  const std::string wrong =
      with_rod("joints: {a: {type: pin, between: [ground, rod], play: {gap: 1, friction: none}}}");
  EXPECT_EQ(build(wrong, options).places, "4:49 missing-key 4:74 unknown-type ");
}

TEST(JointTypes, ThatAreMisspeltAreJudgedAsWhatWasMeant) {
  EXPECT_EQ(build(with_rod("joints:\n  A: {type: pinn, betwen: [ground, rod]}\n")).places,
            "5:3 missing-key 5:13 unknown-type 5:19 unknown-key ");
  EXPECT_EQ(build(with_rod("joints:\n  A: {type: nothing-like-it, betwen: [ground, rod]}\n")).places,
            "5:13 unknown-type ");
}

TEST(JointTwins, IdealNeedsAMatch) {
  BuildOptions options;
  options.ideal = {"a", "b*"};
  try {
    build(loose, options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 2);
    EXPECT_NE(error.message().find("b*"), std::string::npos);
  }
  options.ideal = {"all"};
  EXPECT_TRUE(build(with_rod(""), options).model);
}

TEST(JointTwins, CannotBeDrivenUnlessClosed) {
  const std::string driven = loose + "drivers: {m: {joint: a, kind: angle, value: 0}}\n";
  EXPECT_EQ(build(driven).places, "7:22 driver-on-clearance ");
  BuildOptions options;
  options.ideal = {"a"};
  EXPECT_TRUE(build(driven, options).model);
}

TEST(JointTwins, TakeStartValuesOfTheIdealJoint) {
  const Built built = build(loose + "initial: {joints: {a: 10 deg}}\n");
  ASSERT_TRUE(built.model) << built.report;
  EXPECT_NEAR(built.model->joints[0].start_coordinate.value().value, 0.1745, 1e-3);
}

TEST(JointTwins, AFailingLawIsAPluginError) {
  BuildOptions options;
  options.set = {{"k", "14"}};
  try {
    build(loose, options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 5);
    EXPECT_EQ(error.id(), "plugin-failed");
    EXPECT_EQ(error.location().line, 6);
    EXPECT_NE(error.message().find("broken inside"), std::string::npos);
  }
}

TEST(JointParameters, CarryTimeFunctionsThatOutliveTheirConstructor) {
  const Built built = build(with_rod("joints: {a: {type: rod, between: [ground, rod], load: 3*t^2}}"));
  ASSERT_TRUE(built.model) << built.report;
  EXPECT_DOUBLE_EQ(built.model->joints[0].layout.clearance, 12.0);  // the toy reports the rate at t = 2 s
}

}  // namespace
}  // namespace freeplay
