// What urdfdom reads wrongly or not at all, and is therefore read, mended or checked here: first its own answer, then
// ours.
#include "urdf/urdfdom_model.h"

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <urdf_parser/urdf_parser.h>

#include "urdf/reader.h"

namespace freeplay::urdf {
namespace {

struct Ours {
  std::optional<Robot> robot;
  std::string report;
};

Ours read_robot(const std::string& text) {
  Ours out;
  Diagnostics diagnostics;
  diagnostics.add_source("r.urdf", text);
  const auto xml = parse_xml(text, "r.urdf", "bad-urdf", diagnostics);
  if (xml != nullptr) {
    Messages messages("r.urdf", diagnostics);
    UrdfdomModel model(xml->root());
    out.robot = read_robot(xml->root(), model, messages);
    if (!messages.failed()) model.report_refusal(messages);
  }
  out.report = diagnostics.format(0);
  return out;
}

const std::string inertia = "<inertia ixx='1' ixy='0.1' ixz='0.2' iyy='2' iyz='0.3' izz='2.5'/>";

std::string arm_of(const std::string& in_joint, const std::string& inertial = "<mass value='2'/>" + inertia,
                   const std::string& type = "continuous") {
  return "<robot name='r'><link name='world'/><link name='a'><inertial>" + inertial +
         "</inertial></link><joint name='j' type='" + type + "'><parent link='world'/><child link='a'/>" + in_joint +
         "</joint></robot>";
}

const std::string limit = "<limit lower='-1' upper='3' effort='4' velocity='5'/>";

TEST(UrdfdomModel, GivesMassInertiaPlaceAxisLimitDynamicsAndMimic) {
  const Ours out =
      read_robot(arm_of("<origin xyz='1 2 3'/><axis xyz='0 0 1'/>" + limit + "<dynamics damping='6' friction='7'/>",
                        "<origin xyz='4 5 6'/><mass value='2'/>" + inertia, "revolute"));
  ASSERT_EQ(out.report, "");
  const Link& link = out.robot->links[1];
  EXPECT_EQ(link.mass, 2.0);
  EXPECT_EQ(link.inertial.translation(), Eigen::Vector3d(4, 5, 6));
  Eigen::Matrix3d matrix;
  matrix << 1, 0.1, 0.2, 0.1, 2, 0.3, 0.2, 0.3, 2.5;
  EXPECT_EQ(link.inertia, matrix);
  const Joint& joint = out.robot->joints[0];
  EXPECT_EQ(joint.parent.frame.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(joint.axis, Eigen::Vector3d::UnitZ());
  ASSERT_TRUE(joint.limits);
  EXPECT_EQ(joint.limits->lower, -1.0);
  EXPECT_EQ(joint.limits->upper, 3.0);
  EXPECT_EQ(joint.limits->effort, 4.0);
  EXPECT_EQ(joint.reach, 3.0);
  EXPECT_EQ(joint.damping, 6.0);
  EXPECT_EQ(joint.friction, 7.0);
}

TEST(UrdfdomModel, LosesTheLastDigitsOfATurnThatAreKeptHere) {
  const std::string text = arm_of("<origin rpy='0 0 1.5707963267948966'/><axis xyz='0 0 1'/>");
  const auto q = ::urdf::parseURDF(text)->getJoint("j")->parent_to_joint_origin_transform.rotation;
  const double cosine = std::cos(1.5707963267948966);
  EXPECT_NE(1.0 - 2.0 * (q.y * q.y + q.z * q.z), cosine);
  EXPECT_EQ(read_robot(text).robot->joints[0].parent.frame.linear()(0, 0), cosine);
}

TEST(UrdfdomModel, ReadsAnAxisWithoutNumbersAsNoneWhichIsXHere) {
  const std::string text = arm_of("<axis/>");
  EXPECT_EQ(::urdf::parseURDF(text)->getJoint("j")->axis.x, 0.0);
  const Ours out = read_robot(text);
  EXPECT_EQ(out.report, "");
  EXPECT_EQ(out.robot->joints[0].axis, Eigen::Vector3d::UnitX());
}

TEST(UrdfdomModel, DoesNotKnowAllBlanksOfXmlWhichAreTakenHere) {
  const std::string between = arm_of("<axis xyz='0\t0\n1'/>"),
                    around = arm_of("<axis xyz='0 0 1'/>", "<mass value=' 2 '/>" + inertia);
  testing::internal::CaptureStderr();
  EXPECT_EQ(::urdf::parseURDF(between), nullptr);
  EXPECT_EQ(::urdf::parseURDF(around)->getLink("a")->inertial->mass, 0.0);
  testing::internal::GetCapturedStderr();
  for (const std::string& text : {between, around}) {
    const Ours out = read_robot(text);
    EXPECT_EQ(out.report, "");
    EXPECT_EQ(out.robot->joints[0].axis, Eigen::Vector3d::UnitZ());
    EXPECT_EQ(out.robot->links[1].mass, 2.0);
  }
}

TEST(UrdfdomModel, SortsLinksByNameWhichStayInTheOrderOfTheFileHere) {
  const std::string text = arm_of("<axis xyz='0 0 1'/>");
  std::vector<::urdf::LinkSharedPtr> links;
  ::urdf::parseURDF(text)->getLinks(links);
  EXPECT_EQ(links[0]->name, "a");
  EXPECT_EQ(read_robot(text).robot->links[0].name, "world");
}

/// Two joints to link b: from a and from c, which hangs on `carrier`.
std::string two_parents(const std::string& carrier) {
  return "<robot name='r'><link name='a'/><link name='b'/><link name='c'/>"
         "<joint name='j' type='fixed'><parent link='a'/><child link='b'/></joint>"
         "<joint name='k' type='fixed'><parent link='" +
         carrier +
         "'/><child link='c'/></joint>"
         "<joint name='l' type='prismatic'><parent link='c'/><child link='b'/><origin xyz='1 2 3'/><axis xyz='0 1 0'/>"
         "<limit lower='0' upper='2' effort='1' velocity='1'/></joint></robot>";
}

TEST(UrdfdomModel, KeepsOneParentOfALinkWhereTwoAreReadHere) {
  EXPECT_EQ(::urdf::parseURDF(two_parents("a"))->getLink("b")->parent_joint->name, "l");
  for (const char* carrier : {"a", "b"}) {  // b and c are a ring, which urdfdom takes and never frees
    const Ours out = read_robot(two_parents(carrier));
    EXPECT_EQ(out.report, "");
    ASSERT_EQ(out.robot->joints.size(), 3u);
    EXPECT_EQ(out.robot->joints[0].child.link, 1);
    EXPECT_EQ(out.robot->joints[2].child.link, 1);
    EXPECT_EQ(out.robot->joints[2].parent.link, 2);
    EXPECT_EQ(out.robot->joints[2].parent.frame.translation(), Eigen::Vector3d(1, 2, 3));
    EXPECT_EQ(out.robot->joints[2].reach, 2.0);
  }
}

TEST(UrdfdomModel, TakesInSilenceWhatIsAMistakeHere) {
  for (const std::string& text :
       {arm_of("<axis xyz='0 0 1'/>", "<mass value='-2'/>" + inertia), arm_of("<axis xyz='0 0 0'/>"),
        arm_of("<axis xyz='0 0 1'/><limit lower='1' upper='-1' effort='1' velocity='1'/>"),
        arm_of("<axis xyz='0 0 1'/><dynamics damping='-1'/>"), arm_of("<axis xyz='0 0 1'/><axis xyz='0 1 0'/>"),
        arm_of("<axis xyz='0 0 1'/>", "<mass value='2' unit='g'/>" + inertia),
        arm_of("<axis xyz='0 0 1'/><orign xyz='1 0 0'/>")}) {
    EXPECT_NE(::urdf::parseURDF(text), nullptr) << text;
    EXPECT_NE(read_robot(text).report.find("error: "), std::string::npos) << text;
  }
}

TEST(UrdfdomModel, PrintsWithThePercentSignsOfNamesWhichStayAsTheyAreHere) {
  const std::string text =
      "<robot name='r'><link name='a'><visual><geometry><box size='1 %% 1'/></geometry></visual></link></robot>";
  testing::internal::CaptureStderr();
  ::urdf::parseURDF(text);
  EXPECT_EQ(testing::internal::GetCapturedStderr().find("%%"), std::string::npos);
  const Ours out = read_robot(
      "<robot name='r'><link name='50%n'/><link name='\uFF05'/><joint name='%s' type='fixed'><parent link='50%n'/>"
      "<child link='\uFF05'/><mimic joint='%n%n'/></joint></robot>");
  EXPECT_NE(out.report.find("joint '%s' is to mimic '%n%n', an unknown joint"), std::string::npos) << out.report;
  EXPECT_EQ(out.robot->links[0].name, "50%n");
  EXPECT_EQ(out.robot->links[1].name, "\uFF05");
  EXPECT_EQ(out.robot->joints[0].name, "%s");
  EXPECT_EQ(out.robot->joints[0].child.link, 1);
}

TEST(UrdfdomModel, StillGivesTheRestOfARobotWithMistakes) {
  const Ours out =
      read_robot("<robot name='r'><link name='world'/><link name='a'><inertial><mass value='x'/>" + inertia +
                 "</inertial></link><link name='b'><inertial><mass value='3'/></inertial></link>"
                 "<joint name='j' type='revolute'><parent link='nowhere'/><child link='a'/><origin xyz='1 2 3'/>"
                 "<axis xyz='0 1 0'/></joint></robot>");
  for (const char* message : {"'x' is not a number", "the element 'inertia'", "unknown link 'nowhere'",
                              "the element 'limit' of joint 'j' is missing"}) {
    EXPECT_NE(out.report.find(message), std::string::npos) << message << "\n" << out.report;
  }
  EXPECT_EQ(out.robot->links[1].mass, 1.0);
  EXPECT_EQ(out.robot->links[1].inertia(1, 2), 0.3);
  EXPECT_EQ(out.robot->links[2].mass, 3.0);
  EXPECT_EQ(out.robot->joints[0].type, JointType::revolute);
  EXPECT_EQ(out.robot->joints[0].axis, Eigen::Vector3d::UnitY());
  EXPECT_EQ(out.robot->joints[0].parent.frame.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_FALSE(out.robot->joints[0].limits);
}

TEST(UrdfdomModel, IsNotGivenARingOfLinksThatItWouldNeverFree) {
  const Ours out = read_robot(
      "<robot name='r'><link name='a'/><link name='b'/>"
      "<joint name='j' type='fixed'><parent link='a'/><child link='b'/><origin xyz='1 2 3'/></joint>"
      "<joint name='k' type='fixed'><parent link='b'/><child link='a'/></joint></robot>");
  EXPECT_EQ(out.robot->joints[0].parent.frame.translation(), Eigen::Vector3d(1, 2, 3));  // each joint by itself
}

}  // namespace
}  // namespace freeplay::urdf
