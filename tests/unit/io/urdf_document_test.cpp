#include "io/urdf_document.h"

#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "io/urdf_element.h"

namespace freeplay::urdf {
namespace {

struct Read {
  Document document{"r.urdf", ""};
  std::optional<Sections> sections;
  std::string report;
};

Read read(const std::string& text, const Options& options = {}) {
  Read out;
  Diagnostics diagnostics;
  diagnostics.add_source("r.urdf", text);
  out.sections = add_sections(text, &out.document.file_name(), options, out.document, diagnostics);
  out.report = diagnostics.format(0);
  return out;
}

std::string link(const std::string& name, const std::string& inertial = "<mass value='2'/>") {
  return "<link name='" + name + "'><inertial>" + inertial +
         "<inertia ixx='1' ixy='0' ixz='0' iyy='2' iyz='0' izz='3'/></inertial></link>";
}

std::string robot(const std::string& content) { return "<robot name='r'>" + content + "</robot>"; }

double number(const Node* node) { return node == nullptr ? std::nan("") : std::stod(node->text); }

const Node& at(const Node* node, std::initializer_list<const char*> path) {
  static const Node nothing;
  for (const char* key : path) {
    if (node != nullptr) node = node->find(key);
  }
  EXPECT_NE(node, nullptr);
  return node == nullptr ? nothing : *node;
}

TEST(ReadUrdf, TurnsByRollThenPitchThenYawAboutFixedAxes) {
  const Eigen::Vector3d turned = rotation({std::numbers::pi / 2, 0, std::numbers::pi / 2}) * Eigen::Vector3d(0, 1, 0);
  EXPECT_TRUE(turned.isApprox(Eigen::Vector3d(0, 0, 1)));  // y goes to z by roll; yaw leaves z alone
  const Eigen::Vector3d other = rotation({0, std::numbers::pi / 2, std::numbers::pi / 2}) * Eigen::Vector3d(0, 0, 1);
  EXPECT_TRUE(other.isApprox(Eigen::Vector3d(0, 1, 0)));  // z goes to x by pitch, x to y by yaw
}

TEST(ReadUrdf, TakesTheMomentAboutTheNormalOfThePlane) {
  const std::string text = robot("<link name='world'/>" + link("a") +
                                 "<joint name='j' type='floating'><parent link='world'/><child link='a'/></joint>");
  for (const auto& [plane, moment] :
       {std::pair(Options::Plane::xy, 3.0), std::pair(Options::Plane::xz, 2.0), std::pair(Options::Plane::yz, 1.0)}) {
    Options options;
    options.plane = plane;
    const Read out = read(text, options);
    ASSERT_TRUE(out.sections) << out.report;
    EXPECT_EQ(number(&at(out.sections->bodies, {"a", "inertia"})), moment);
  }
}

TEST(ReadUrdf, MergesBodiesOnFixedJointsByTheParallelAxisTheorem) {
  const std::string text =
      robot("<link name='world'/>" + link("a") + link("b") +
            "<joint name='j' type='continuous'><parent link='world'/><child link='a'/><axis xyz='0 0 1'/></joint>"
            "<joint name='k' type='fixed'><parent link='a'/><child link='b'/><origin xyz='1 0 0'/></joint>");
  Options options;
  options.merge_fixed = true;
  const Read merged = read(text, options);
  ASSERT_TRUE(merged.sections) << merged.report;
  const Node& body = at(merged.sections->bodies, {"a"});
  EXPECT_EQ(number(body.find("mass")), 4.0);
  EXPECT_EQ(number(at(&body, {"com"}).items[0]), 0.5);
  EXPECT_EQ(number(body.find("inertia")), 3.0 + 3.0 + 2 * 2.0 * 0.25);
  EXPECT_EQ(merged.sections->joints->entries.size(), 1u);
  EXPECT_EQ(number(at(&body, {"frames", "b"}).items[0]), 1.0);
  const Read apart = read(text);
  EXPECT_EQ(apart.sections->joints->entries.size(), 2u);
}

TEST(ReadUrdf, SnapsEachJointByItselfSoThatRoundedAnglesDoNotAddUp) {
  // Each link is tilted against the one before by 0.8e-5 rad; the last by 4e-5 against the first.
  std::string text =
      "<link name='world'/>" + link("l0") +
      "<joint name='j0' type='continuous'><parent link='world'/><child link='l0'/><axis xyz='0 0 1'/></joint>";
  for (int i = 1; i < 6; ++i) {
    const std::string n = std::to_string(i);
    text += link("l" + n) + "<joint name='j" + n + "' type='continuous'><parent link='l" + std::to_string(i - 1) +
            "'/><child link='l" + n + "'/><origin xyz='1 0 0' rpy='0.000008 0 0'/><axis xyz='0 0 1'/></joint>";
  }
  const Read out = read(robot(text));
  EXPECT_TRUE(out.sections) << out.report;
  EXPECT_NE(out.report.find("largest residual is 8e-06 rad"), std::string::npos) << out.report;
}

TEST(ReadUrdf, CountsAnAxisAgainstTheNormalBackwards) {
  // y is against the normal of xz. The follower of a mimic turns about -y: forward.
  const std::string text =
      robot("<link name='world'/>" + link("a") + link("b") +
            "<joint name='j' type='continuous'><parent link='world'/><child link='a'/><axis xyz='0 1 0'/></joint>"
            "<joint name='k' type='continuous'><parent link='a'/><child link='b'/><axis xyz='0 -1 0'/>"
            "<mimic joint='j' multiplier='3' offset='0.5'/></joint>");
  Options options;
  options.plane = Options::Plane::xz;
  const Read out = read(text, options);
  ASSERT_TRUE(out.sections) << out.report;
  // q_k = 3 q_j + 0.5 with c_j = -q_j and c_k = q_k.
  EXPECT_EQ(number(&at(out.sections->joints, {"k-mimic", "ratio"})), -3.0);
  EXPECT_EQ(number(&at(out.sections->joints, {"k-mimic", "offset"})), 0.5);
}

TEST(ReadUrdf, ASlideRunsAlongItsAxis) {
  const std::string text = robot(
      "<link name='world'/>" + link("a") +
      "<joint name='j' type='prismatic'><parent link='world'/><child link='a'/><origin xyz='1 2 9' rpy='0 0 0.25'/>"
      "<axis xyz='0 3 0'/><limit lower='0' upper='1' effort='1' velocity='1'/></joint>");
  const Read out = read(text);
  ASSERT_TRUE(out.sections) << out.report;
  const Node& first = at(out.sections->bodies, {"ground", "frames", "j"});
  EXPECT_EQ(number(at(&first, {"position"}).items[1]), 2.0);
  EXPECT_NEAR(number(first.find("angle")), 0.25 + std::numbers::pi / 2, 1e-15);
  EXPECT_NEAR(number(&at(out.sections->bodies, {"a", "frames", "j", "angle"})), std::numbers::pi / 2, 1e-15);
}

TEST(ReadUrdf, KeepsThePlacesOfTheFile) {
  const Read out = read("<robot name='r'>\n<link name='world'/>\n" + link("a") +
                        "\n<joint name='j' type='floating'><parent link='world'/><child link='a'/></joint></robot>");
  ASSERT_TRUE(out.sections) << out.report;
  const Node& mass = at(out.sections->bodies, {"a", "mass"});
  EXPECT_EQ(mass.location().file, "r.urdf");
  EXPECT_EQ(mass.line, 3);
  EXPECT_EQ(mass.column, 32);
}

TEST(ReadUrdf, AsksUrdfdomAboutWhatItDoesNotReadItself) {
  const Read out = read(robot("<link name='a'><visual><geometry><cone/></geometry></visual></link>"));
  EXPECT_FALSE(out.sections);
  EXPECT_NE(out.report.find("r.urdf:1:18: error: urdfdom refuses this link"), std::string::npos) << out.report;
}

TEST(ReadUrdf, TakesPercentSignsThatUrdfdomWouldPrintWith) {
  const Read out = read(robot("<link name='a'/><material name='%s%n'><color rgba='%s%s%n 1 1 1'/></material>"));
  EXPECT_FALSE(out.sections);
  EXPECT_NE(out.report.find("%s%s%n"), std::string::npos) << out.report;
}

std::string arm(const std::string& content, const std::string& link_content = "") {
  return robot(
      "<link name='world'/><link name='a'><inertial><mass value='2'/><inertia ixx='1' ixy='0' ixz='0' iyy='2' "
      "iyz='0' izz='3'/></inertial>" +
      link_content +
      "</link><joint name='j' type='continuous'><parent link='world'/><child link='a'/><axis xyz='0 0 1'/>"
      "</joint>" +
      content);
}

TEST(ReadUrdf, FindsEveryMistakeInShapesAtItsPlace) {
  const Read out = read(
      "<robot name='r'><link name='a'>\n<visual>\n<origin xyz='0,1 0 0'/>\n<geometry><box size='1 2'/></geometry>\n"
      "<material name='m'><color rgba='1 1 1 x'/></material></visual>\n<collision>\n<origin xzy='0 0 0'/>\n"
      "<geometry><cylinder radius='1' lenght='2'/></geometry></collision>\n</link></robot>");
  EXPECT_FALSE(out.sections);
  for (const char* message :
       {"r.urdf:3:9: error: 'xyz' of the origin of a visual of link 'a': '0,1' is not a number",
        "r.urdf:4:16: error: 'size' of the box of a visual of link 'a' must be three numbers, not 2",
        "r.urdf:5:27: error: 'rgba' of the color of a visual of link 'a': 'x' is not a number",
        "r.urdf:7:9: error: unknown attribute 'xzy'", "did you mean 'xyz'?",
        "r.urdf:8:32: error: unknown attribute 'lenght'", "did you mean 'length'?"}) {
    EXPECT_NE(out.report.find(message), std::string::npos) << message << "\n" << out.report;
  }
}

TEST(ReadUrdf, BlamesTheVersionOfTheRobotWhereItStands) {
  const Read out = read("<robot name='r'\n version='1.1'><link name='a'/></robot>");
  EXPECT_FALSE(out.sections);
  EXPECT_NE(out.report.find("r.urdf:2:2: error: urdfdom refuses the version"), std::string::npos) << out.report;
}

TEST(ReadUrdf, TakesElementsOfOtherProgramsForWhatTheyAre) {
  const Read out = read(arm("<tool/><root/><line/><point/><gripper/><skin/>"));
  EXPECT_TRUE(out.sections) << out.report;
  EXPECT_NE(out.report.find("not used: tool, root, line, point, gripper, skin"), std::string::npos) << out.report;
}

TEST(ReadUrdf, SeesSlipsOfThePenInTheNamesOfElements) {
  for (const auto& [word, meant] : {std::pair("lnik", "link"), std::pair("Joint", "joint"), std::pair("jont", "joint"),
                                    std::pair("loops", "loop"), std::pair("constaint", "constraint")}) {
    const Read out = read(arm("<" + std::string(word) + "/>"));
    EXPECT_FALSE(out.sections) << word;
    EXPECT_NE(out.report.find("did you mean '" + std::string(meant) + "'?"), std::string::npos) << out.report;
  }
}

TEST(ReadUrdf, AMereFrameMayBeCalledGround) {
  const std::string text =
      robot("<link name='world'/><link name='ground'/>" + link("a") +
            "<joint name='f' type='fixed'><parent link='world'/><child link='ground'/><origin xyz='1 0 0'/></joint>"
            "<joint name='j' type='continuous'><parent link='ground'/><child link='a'/><axis xyz='0 0 1'/></joint>");
  const Read out = read(text);
  ASSERT_TRUE(out.sections) << out.report;
  EXPECT_EQ(number(at(out.sections->bodies, {"ground", "frames", "j"}).items[0]), 1.0);
}

TEST(ReadUrdf, SaysThatARootWithoutMassLosesItsInertia) {
  const Read out = read(robot(
      "<link name='base'><inertial><origin xyz='0.5 0 0'/><mass value='0'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' "
      "iyz='0' izz='1'/></inertial></link>"));
  ASSERT_TRUE(out.sections) << out.report;
  EXPECT_NE(out.report.find("inertia without mass of link 'base', centre of mass without mass of link 'base'"),
            std::string::npos)
      << out.report;
}

TEST(ReadUrdf, SaysThatRepairLeavesInertiaThatThePlaneDoesNotUse) {
  const std::string text = robot(
      "<link name='world'/><link name='a'><inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' "
      "izz='9'/></inertial></link>"
      "<joint name='j' type='continuous'><parent link='world'/><child link='a'/><axis xyz='0 0 1'/></joint>");
  Options options;
  const std::string words = "'repair: inertia' leaves it as it is";
  EXPECT_EQ(read(text, options).report.find(words), std::string::npos);
  options.repair_inertia = true;
  EXPECT_NE(read(text, options).report.find(words), std::string::npos) << read(text, options).report;
}

}  // namespace
}  // namespace freeplay::urdf
