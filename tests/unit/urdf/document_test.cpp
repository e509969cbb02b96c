#include "urdf/document.h"

#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "urdf/element.h"

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

/// Two links in the plane xz and a loop from the second to ground. The frame of each link is turned by `turn` against
/// the upright one, with all that is written in it, so that the mechanism stays the same.
std::string turned_links(const Eigen::Matrix3d& turn) {
  const auto text = [](const Eigen::Vector3d& v) { return fmt::format("{:.17g} {:.17g} {:.17g}", v[0], v[1], v[2]); };
  const auto rpy = [&](const Eigen::Matrix3d& r) {
    return text({std::atan2(r(2, 1), r(2, 2)), std::atan2(-r(2, 0), std::hypot(r(2, 1), r(2, 2))),
                 std::atan2(r(1, 0), r(0, 0))});
  };
  const Eigen::Matrix3d back = turn.transpose();
  const Eigen::Matrix3d bend = rotation({0, -0.3, 0});
  const auto body = [&](const char* name, double scale) {
    return fmt::format(
        "<link name='{}'><inertial><origin xyz='{}' rpy='{}'/><mass value='{}'/><inertia ixx='1' ixy='0.1' ixz='0' "
        "iyy='1.5' iyz='0' izz='1.2'/></inertial></link>",
        name, text(back * Eigen::Vector3d(0.1, 0.0, 0.05)), rpy(back), scale);
  };
  const std::string axis = "<axis xyz='" + text(back * Eigen::Vector3d(0, -1, 0)) + "'/>";
  return robot(
      "<link name='world'/>" + body("a", 2.0) + body("b", 3.0) +
      "<joint name='j' type='continuous'><parent link='world'/><child link='a'/><origin xyz='0.5 0 0.25' rpy='" +
      rpy(turn) + "'/>" + axis + "</joint><joint name='k' type='continuous'><parent link='a'/><child link='b'/>" +
      "<origin xyz='" + text(back * Eigen::Vector3d(0.3, 0.0, 0.2)) + "' rpy='" + rpy(back * bend * turn) + "'/>" +
      axis + "</joint><loop name='l' type='revolute'><predecessor link='b'><origin xyz='" +
      text(back * Eigen::Vector3d(0.4, 0.0, 0.1)) + "' rpy='" + rpy(back) +
      "'/></predecessor><successor link='world'><origin xyz='1 0 0'/></successor><axis xyz='0 -1 0'/></loop>");
}

double angle(const Node& frame) { return frame.is_map() ? number(frame.find("angle")) : 0.0; }
Eigen::Vector2d position(const Node& frame) {
  const Node& list = frame.is_map() ? *frame.find("position") : frame;
  return {number(list.items[0]), number(list.items[1])};
}

TEST(ReadUrdf, AFrameThatIsTiltedInItsLinkChangesNothing) {
  Options options;
  options.plane = Options::Plane::xz;
  const Read plain = read(turned_links(Eigen::Matrix3d::Identity()), options);
  ASSERT_TRUE(plain.sections) << plain.report;
  for (const Eigen::Vector3d& rpy :
       {Eigen::Vector3d(1.5708, 0, 0), Eigen::Vector3d(-1.5708, 0, 0), Eigen::Vector3d(3.14159, 0, 0),
        Eigen::Vector3d(0, 0, 1.5708), Eigen::Vector3d(1.5708, 0, 1.5708), Eigen::Vector3d(0.4, 0.7, -1.1)}) {
    const Read out = read(turned_links(rotation(rpy)), options);
    ASSERT_TRUE(out.sections) << out.report;
    EXPECT_NE(out.report.find("tilt of the frame 'a', 'b'"), std::string::npos) << out.report;
    // The turns from plain body frames to those of this robot are not told; what does not depend on them must agree.
    for (const char* name : {"a", "b"}) {
      const Node& was = at(plain.sections->bodies, {name});
      const Node& is = at(out.sections->bodies, {name});
      EXPECT_EQ(number(is.find("mass")), number(was.find("mass")));
      EXPECT_NEAR(number(is.find("inertia")), number(was.find("inertia")), 1e-12);
      const bool first = std::string(name) == "a";
      const Eigen::Vector2d com_was = position(*was.find("com")), com_is = position(*is.find("com"));
      const Eigen::Vector2d tip_was = position(at(&was, {"frames", first ? "k" : "l"})),
                            tip_is = position(at(&is, {"frames", first ? "k" : "l"}));
      EXPECT_NEAR(com_is.norm(), com_was.norm(), 1e-12);
      EXPECT_NEAR(tip_is.norm(), tip_was.norm(), 1e-12);
      EXPECT_NEAR(com_is.dot(tip_is), com_was.dot(tip_was), 1e-12);
      EXPECT_NEAR(com_is[0] * tip_is[1] - com_is[1] * tip_is[0], com_was[0] * tip_was[1] - com_was[1] * tip_was[0],
                  1e-12);
    }
    // Where the tip of b stands at coordinates zero does not depend on them, either.
    const auto tip = [](const Read& robot) {
      const Node* bodies = robot.sections->bodies;
      const Node& j = at(bodies, {"ground", "frames", "j"});
      const Node& k = at(bodies, {"a", "frames", "k"});
      const double first = angle(j), second = first + angle(k) - angle(at(bodies, {"b", "frames", "k"}));
      return Eigen::Vector2d(position(j) + Eigen::Rotation2Dd(first) * position(k) +
                             Eigen::Rotation2Dd(second) * position(at(bodies, {"b", "frames", "l"})));
    };
    EXPECT_LT((tip(out) - tip(plain)).norm(), 3e-5) << rpy.transpose();
  }
}

TEST(ReadUrdf, RoundedRightAnglesDoNotAddUpAlongAChain) {
  std::string text = "<link name='world'/>" + link("l0") +
                     "<joint name='j0' type='continuous'><parent link='world'/><child link='l0'/>"
                     "<origin rpy='1.5708 0 0'/><axis xyz='0 0 1'/></joint>";
  for (int i = 1; i < 9; ++i) {
    const std::string n = std::to_string(i);
    text += link("l" + n) + "<joint name='j" + n + "' type='continuous'><parent link='l" + std::to_string(i - 1) +
            "'/><child link='l" + n + "'/><origin xyz='1 0 0' rpy='1.5708 0 0'/><axis xyz='0 " +
            (i % 2 == 1 ? "1 0" : "0 1") + "'/></joint>";
  }
  Options options;
  options.plane = Options::Plane::xz;
  const Read out = read(robot(text), options);
  EXPECT_TRUE(out.sections) << out.report;
}

TEST(ReadUrdf, AnAxisThatLeavesThePlaneIsStillRefused) {
  Options options;
  options.plane = Options::Plane::xz;
  for (const char* origin : {"1.571 0 0", "1.4 0 0"}) {
    const Read out =
        read(robot("<link name='world'/>" + link("a") +
                   "<joint name='j' type='continuous'><parent link='world'/><child link='a'/><origin rpy='" + origin +
                   "'/><axis xyz='0 0 1'/></joint>"),
             options);
    EXPECT_FALSE(out.sections);
    EXPECT_NE(out.report.find("urdf-not-planar"), std::string::npos) << out.report;
  }
}

TEST(ReadUrdf, MistakesOfOneKindDoNotHideThoseOfAnother) {
  const std::string long_name(70, 'b');
  const Read out = read(robot(
      "<lnik/><link name='world'/><link name='a'><inertial><mass value='1,5'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' "
      "iyz='0' izz='-1'/></inertial></link><link name='b'/><link name='c'><inertial><mass value='-1'/><inertia ixx='1' "
      "ixy='0' ixz='0' iyy='1' iyz='0' izz='x'/></inertial></link>"
      "<joint name='origin' type='continuous'><parent link='world'/><child link='a'/><axis xyz='0 0 1'/></joint>"
      "<joint name='" +
      long_name +
      "' type='continuous'><parent link='a'/><child link='b'/><axis xyz='0 0 1'/></joint>"
      "<joint name='k' type='continuous'><parent link='a'/><child link='c'/><axis xyz='0 0 1'/></joint>"));
  EXPECT_FALSE(out.sections);
  for (const std::string& message :
       {std::string("unknown element 'lnik'"), std::string("'1,5' is not a number"),
        std::string("the mass of link 'c' must be positive"), std::string("'x' is not a number"),
        std::string("the moment about the normal of the plane is negative"), std::string("link 'b' has no mass"),
        "'" + long_name + "' is too long", std::string("the joint 'origin' needs a frame")}) {
    EXPECT_NE(out.report.find(message), std::string::npos) << message << "\n" << out.report;
  }
  std::size_t errors = 0;
  for (std::size_t i = out.report.find("error: "); i != std::string::npos; i = out.report.find("error: ", i + 1)) {
    ++errors;
  }
  EXPECT_EQ(errors, 8u) << out.report;  // and none that only follows from another
}

TEST(ReadUrdf, SaysOnceThatANameExistsTwice) {
  const Read out = read(robot("<link name='a'/><link name='a'/>"));
  EXPECT_NE(out.report.find("exists already"), std::string::npos);
  EXPECT_EQ(out.report.find("duplicate-name"), std::string::npos) << out.report;
}

std::string hinged(const std::string& in_joint, const std::string& in_robot = "") {
  return robot("<link name='world'/>\n" + link("a") + "\n<joint name='j' type='continuous'><parent link='world'/>" +
               "<child link='a'/><axis xyz='0 0 1'/>\n" + in_joint + "\n</joint>\n" + in_robot);
}

TEST(ReadUrdf, TakesBlanksAroundANumber) {
  EXPECT_EQ(read(robot("<link name='world'/>" + link("a", "<mass value=' 2\n'/>") +
                       "<joint name='j' type='continuous'><parent link='world'/><child link='a'/><axis xyz='0 0 1'/>"
                       "</joint>"))
                .report,
            "");
}

TEST(ReadUrdf, ReportsAllMistakesOfUnusedElementsAtTheirPlaces) {
  const std::string report = read(hinged("<calibration rising='x'/>\n<safety_controller k_position='y'/>",
                                         "<material name='m'><color rgba='0 0 2 1'/></material>\n<material name='n'/>"))
                                 .report;
  for (const char* place : {"r.urdf:4:14: error: 'rising' of the calibration of joint 'j'",
                            "r.urdf:5:2: error: the attribute 'k_velocity' of the safety_controller",
                            "r.urdf:5:20: error: 'k_position'", "r.urdf:7:27: error: 'rgba' of the color",
                            "r.urdf:8:1: error: the element 'color' of the material of the robot is missing"}) {
    EXPECT_NE(report.find(place), std::string::npos) << place << "\n" << report;
  }
}

TEST(ReadUrdf, SaysWhatItDoesNotUseOnce) {
  const std::string tilted = "<origin rpy='0.5 0 0'/><calibration rising='0'/>";
  const std::string report = read(hinged(tilted)).report;
  EXPECT_NE(report.find("calibration"), std::string::npos) << report;
  EXPECT_EQ(report.find("not used"), report.rfind("not used")) << report;
}

TEST(ReadUrdf, SaysThatARootOnGroundDoesNotFloat) {
  Options options;
  options.floating_base = true;
  EXPECT_NE(read(hinged(""), options).report.find("does not float: its root link 'world' is ground"),
            std::string::npos);
  EXPECT_EQ(read(hinged("")).report, "");
  EXPECT_EQ(read(robot(link("a")), options).report, "");
}

TEST(ReadUrdf, ReportsMistakesOfSeveralKindsTogether) {
  const std::string inertia = "<inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz=";
  const std::string rest =
      "<link name='a'><inertial><mass value='1'/>\n" + inertia + "'-5'/></inertial></link>\n" +
      "<link name='c'/><link name='com'/>\n<joint name='A' type='continuous'><parent link='world'/><child link='a'/>" +
      "<axis xyz='0 0 1'/></joint>\n<joint name='B' type='continuous'><parent link='a'/><child link='b'/>" +
      "<axis xyz='0 0 1'/></joint>\n<joint name='C' type='continuous'><parent link='b'/><child link='c'/>\n" +
      "<axis xyz='0 0.1 1'/></joint>\n<joint name='D' type='fixed'><parent link='b'/><child link='com'/></joint>";
  Options any;
  any.plane.reset();
  for (const std::string& first : {link("b") + "<link name='lonely'/>", "<link name='b'><inertial><mass value='1'/>" +
                                                                            inertia + "'x'/></inertial></link>"}) {
    const std::string report = read(robot("<link name='world'/>" + first + "\n" + rest), any).report;
    for (const char* told : {"r.urdf:3:50: error: impossible inertia of link 'a'",
                             "r.urdf:4:7: error: link 'c' has no mass", "urdf-not-planar", "r.urdf:1:"}) {
      EXPECT_NE(report.find(told), std::string::npos) << told << "\n" << report;
    }
  }
}

}  // namespace
}  // namespace freeplay::urdf
