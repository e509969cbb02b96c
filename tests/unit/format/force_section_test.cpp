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

}  // namespace
}  // namespace freeplay
