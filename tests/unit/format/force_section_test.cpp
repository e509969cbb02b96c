#include <gtest/gtest.h>

#include "model_text.h"

namespace freeplay {
namespace {

TEST(ForceSection, TakesJointsWithoutRowsInOrder) {
  const Built built =
      build(with_rod("joints: {A: {type: pin, between: [ground, rod]}}\n"
                     "forces:\n"
                     "  band: {type: spring, between: [ground, rod/tip], stiffness: 2}\n"
                     "  push: {type: torque, on: rod, value: 1}\n"
                     "  A: {type: spring, between: [ground, rod]}\n"));
  ASSERT_TRUE(built.model) << built.report;
  ASSERT_EQ(built.model->joints.size(), 3u);
  EXPECT_FALSE(built.model->joints[0].is_force);
  EXPECT_TRUE(built.model->joints[1].is_force);
  ASSERT_EQ(built.model->force_elements.size(), 3u);
  EXPECT_EQ(built.model->force_elements[0].joint, 1);
  EXPECT_EQ(built.model->force_elements[1].applied, 0);
  EXPECT_EQ(built.model->force_elements[2].joint, 2);  // forces have names of their own
}

TEST(ForceSection, RefusesJointsWithRowsOrPlay) {
  const auto places = [](const std::string& type) {
    return build(with_rod("forces:\n  f: {type: " + type + ", between: [ground, rod/tip]}\n")).places;
  };
  EXPECT_EQ(places("pin"), "5:13 unknown-type ");
  EXPECT_EQ(places("gear"), "5:13 unknown-type ");
  const Built built = build(with_rod("forces:\n  f: {type: sprin, between: [ground, rod/tip]}\n"));
  EXPECT_NE(built.report.find("did you mean 'spring'?"), std::string::npos);
}

TEST(ForceSection, WarnsOfWhatActsOnGround) {
  const Built built =
      build(with_rod("forces:\n"
                     "  f: {type: force, at: ground/origin, value: [1, 0]}\n"
                     "  t: {type: torque, on: ground, value: 1}\n"
                     "  g: {type: gravity, on: [ground, rod], value: [0, 1]}\n"));
  EXPECT_TRUE(built.model);
  EXPECT_EQ(built.places, "3:39 unused 5:24 unused 6:25 unused 7:27 unused ");
}

TEST(ForceSection, AForceIsNoJointForOthers) {
  const Built built =
      build(with_rod("joints: {A: {type: pin, between: [ground, rod]}}\n"
                     "forces: {band: {type: spring, between: [ground, rod/tip]}}\n"
                     "initial: {joints: {band: 1}}\n"));
  EXPECT_EQ(built.places, "6:20 unknown-name ");
}

TEST(ForceSection, ABodyHasOneGravity) {
  const std::string twice =
      "forces:\n"
      "  up: {type: gravity, on: [rod, \"r*\"], value: [0, 1]}\n"
      "  down: {type: gravity, on: [rod], value: [0, -1]}\n";
  EXPECT_EQ(build(with_rod(twice)).places, "6:30 duplicate-name ");
  const Built once =
      build(with_rod("gravity: [0, -9]\nforces: {up: {type: gravity, on: [rod, \"r*\"], value: [0, 1]}}\n"));
  ASSERT_TRUE(once.model) << once.report;
  EXPECT_EQ(once.model->bodies.front().gravity[1], 1.0);
  EXPECT_TRUE(once.model->force_elements.empty());
}

TEST(ForceSection, UnitOfAParameterFollowsAWord) {
  const auto with = [](const std::string& keys) {
    return build(with_rod("forces: {f: {type: spring, between: [ground, rod/tip], " + keys + "}}\n")).places;
  };
  EXPECT_EQ(with("stiffness: 2 N/m"), "");
  EXPECT_EQ(with("stiffness: 2 N*m/rad, kind: twist"), "");
  EXPECT_EQ(with("stiffness: 2 N*m/rad"), "4:67 dimension-mismatch ");
  EXPECT_EQ(with("stiffness: 2 N/m, kind: twist"), "4:67 dimension-mismatch ");
}

TEST(ForceSection, ReadsFormulasOfTheMotion) {
  const Built built =
      build(with_rod("joints: {A: {type: pin, between: [ground, rod]}}\n"
                     "forces:\n"
                     "  f: {type: force, at: rod, value: [\"-3 N*s/m*body.rod.vx*(1 + t)\", 1 N]}\n"
                     "  g: {type: force, at: rod, value: [\"2 N/m*frame.tip.x - 1 N/m*frame.rod/tip.y\", 0]}\n"));
  ASSERT_TRUE(built.model) << built.report;
  const AppliedForce& force = built.model->forces[0];
  ASSERT_EQ(force.by_motion.formulas.size(), 2u);
  ASSERT_EQ(force.by_motion.channels.size(), 1u);
  EXPECT_EQ(force.by_motion.channels[0].of, MotionChannel::Of::velocity);
  EXPECT_EQ(force.in_time.size(), 1u);
  EXPECT_EQ(built.model->forces[1].by_motion.channels.size(), 2u);
}

TEST(ForceSection, RefusesFormulasThatDoNotFit) {
  const auto report = [](const std::string& value) {
    return build(with_rod("joints: {A: {type: pin, between: [ground, rod]}}\n"
                          "forces:\n  f: {type: force, at: rod, value: [\"" +
                          value + "\", 0]}\n"))
        .report;
  };
  const auto has = [&](const std::string& value, const std::string& text) {
    EXPECT_NE(report(value).find(text), std::string::npos) << value << "\n" << report(value);
  };
  has("2 N/m*body.rid.x", "6:44: error: unknown channel 'body.rid.x' [unknown-name]");
  has("2 N/m*body.rid.x", "did you mean 'body.rod.x'?");
  has("2 N*joint.A.angel", "did you mean 'joint.A.angle'?");
  has("2 N*frame.rod/tap.x", "did you mean 'frame.rod/tip.x'?");
  has("2 N*body.rod.vx", "6:38: error: expected force, but this is");
  has("body.rod.vx + 1 N", "cannot be added or compared [dimension-mismatch]");
  has("2 N*body.rod.qw", "unknown channel 'body.rod.qw'");
  const Built constant = build("freeplay: 1\nbodies: {rod: {mass: body.rod.x, inertia: 1}}\n");
  EXPECT_EQ(constant.places, "2:22 state-not-allowed ");
}

}  // namespace
}  // namespace freeplay
