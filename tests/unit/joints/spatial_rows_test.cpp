#include "spatial_joint.h"

namespace freeplay::test {
namespace {

/// A joint type in space that has rows.
class SpatialRows : public testing::TestWithParam<const char*> {
 protected:
  const Component row_ = in_space(joint_row(GetParam()));
  JointInstance joint_{row_, parameters()};

  ParameterStub parameters() const {
    ParameterStub stub(row_);
    for (const Parameter& p : row_.description.parameters) stub.numbers[p.name] = 0.7;
    return stub;
  }
  JointLayout layout() const {
    JointLayout layout;
    layout.space = Space::spatial;
    joint_.call(&abi::JointTable::declare, &layout);
    return layout;
  }
};

TEST_P(SpatialRows, AreDerivativesOffTheConstraintToo) { expect_spatial_derivatives(joint_); }

TEST_P(SpatialRows, CoordinateRowIsDerivative) {
  if (layout().coordinate != Coordinate::none) expect_spatial_derivatives(joint_, spatial_coordinate);
}

TEST_P(SpatialRows, PlacedBodySatisfiesThem) {
  Pose pose{};
  std::int32_t can = 0;
  joint_.call(&abi::JointTable::place, 0.8, &pose, &can);
  if (can == 0) return;
  const MarkerKinematics a = marker({0.3, -0.2, 0.5}, turn({0.4, -0.7, 0.9}));
  const Matrix3d turned = rotation(a) * Eigen::Map<const RowMajor3>(pose.rotation);
  const MarkerKinematics b = marker(vector3(a.position) + rotation(a) * vector3(pose.position), turned);
  for (const double phi : spatial_rows(joint_, a, b).phi) EXPECT_NEAR(phi, 0.0, 1e-15);
  if (layout().coordinate == Coordinate::none) return;
  EXPECT_NEAR(coordinate_row(joint_, a, b).value, 0.8, 1e-15);
}

// A row between bodies that move as one is at rest: the pair of forces that it stands for is balanced. Rows of joined
// origins stand in world axes, so that this holds where the origins coincide.
TEST_P(SpatialRows, AreAtRestWhileBothMarkersMoveAsOneBody) {
  const bool apart = std::string(GetParam()) == "distance" || std::string(GetParam()) == "point-on-line";
  const Vector3d w(0.4, -1.2, 0.7), v(0.3, 0.1, -0.5), p(0.3, -0.2, 0.5), q = apart ? Vector3d(0.9, 0.4, -0.1) : p;
  const MarkerKinematics a = marker(p, turn({0.4, -0.7, 0.9}), v + w.cross(p), w),
                         b = marker(q, turn({-0.3, 0.5, 1.3}), v + w.cross(q), w);
  const Rows rows = spatial_rows(joint_, a, b);
  for (std::size_t i = 0; i < rows.phi.size(); ++i) EXPECT_NEAR(rows.rate(i, a, b), 0.0, 1e-14);
}

std::string test_name(const testing::TestParamInfo<const char*>& info) {
  std::string name = info.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}
INSTANTIATE_TEST_SUITE_P(Joint, SpatialRows,
                         testing::Values("revolute", "prismatic", "fixed", "distance", "point-on-line", "spherical",
                                         "universal", "cylindrical", "planar"),
                         test_name);

struct Counted {
  const char* name;
  int rows;
  Coordinate coordinate;
};
TEST(SpatialJoints, HaveTheRowsAndTheCoordinateOfTheModelFormat) {
  const Counted all[] = {{"revolute", 5, Coordinate::angle},
                         {"prismatic", 5, Coordinate::position},
                         {"fixed", 6, Coordinate::none},
                         {"distance", 1, Coordinate::none},
                         {"spherical", 3, Coordinate::none},
                         {"universal", 4, Coordinate::none},
                         {"point-on-line", 2, Coordinate::position},
                         {"cylindrical", 4, Coordinate::none},
                         {"planar", 3, Coordinate::none}};
  for (const Counted& counted : all) {
    const Component row = in_space(joint_row(counted.name));
    ParameterStub stub(row);
    stub.numbers["length"] = 1.0;
    JointInstance joint(row, stub);
    JointLayout layout;
    layout.space = Space::spatial;
    joint.call(&abi::JointTable::declare, &layout);
    EXPECT_EQ(layout.constraint_rows, counted.rows) << counted.name;
    EXPECT_EQ(layout.coordinate, counted.coordinate) << counted.name;
    EXPECT_EQ(layout.pin, 0u) << counted.name;
  }
}

/// Rows of both classes of a type where the motion is planar: `same` lists where the planar rows stand among the
/// spatial ones, all others concern motions out of the plane alone.
void expect_planar_rows(const char* name, const std::vector<std::size_t>& same) {
  const Component& planar_row = joint_row(name);
  const Component spatial_row = in_space(planar_row);
  ParameterStub stub(planar_row);
  stub.numbers["length"] = 0.7;
  const JointInstance planar(planar_row, stub), spatial(spatial_row, stub);
  const MarkerKinematics a = motion_a.at(0.3), b = motion_b.at(0.3);
  const Rows p = constraint_rows(planar, a, b), s = spatial_rows(spatial, a, b);
  ASSERT_EQ(p.phi.size(), same.size());
  std::vector<bool> matched(s.phi.size());
  for (std::size_t i = 0; i < same.size(); ++i) {
    const std::size_t k = same[i];
    matched[k] = true;
    EXPECT_NEAR(s.phi[k], p.phi[i], 1e-15) << name;
    EXPECT_NEAR(s.gamma[k], p.gamma[i], 1e-14) << name;
    for (std::size_t c = 0; c < 12; ++c) EXPECT_NEAR(s.jacobian[12 * k + c], p.jacobian[12 * i + c], 1e-15) << name;
  }
  for (std::size_t k = 0; k < s.phi.size(); ++k) {
    if (matched[k]) continue;
    EXPECT_NEAR(s.phi[k], 0.0, 1e-15) << name;
    EXPECT_NEAR(s.gamma[k], 0.0, 1e-14) << name;
    for (const std::size_t c : {0u, 1u, 5u, 6u, 7u, 11u}) EXPECT_NEAR(s.jacobian[12 * k + c], 0.0, 1e-15) << name;
  }
}
TEST(SpatialJoints, HaveThePlanarRowsInAPlanarMotion) {
  expect_planar_rows("revolute", {0, 1});
  expect_planar_rows("prismatic", {0, 4});
  expect_planar_rows("fixed", {0, 1, 5});
  expect_planar_rows("distance", {0});
  expect_planar_rows("point-on-line", {0});
}
TEST(SpatialJoints, HaveThePlanarCoordinateInAPlanarMotion) {
  for (const char* name : {"revolute", "prismatic", "point-on-line"}) {
    const Component& planar_row = joint_row(name);
    const Component spatial_row = in_space(planar_row);
    const JointInstance planar(planar_row, ParameterStub(planar_row)), spatial(spatial_row, ParameterStub(spatial_row));
    const MarkerKinematics a = motion_a.at(0.3), b = motion_b.at(0.3);
    const CoordinateRow p = coordinate_row(planar, a, b), s = coordinate_row(spatial, a, b);
    EXPECT_NEAR(s.value, p.value, 1e-15) << name;
    EXPECT_NEAR(s.bias, p.bias, 1e-14) << name;
    for (int c = 0; c < 12; ++c) EXPECT_NEAR(s.jacobian[c], p.jacobian[c], 1e-15) << name;
  }
}

// 2 tan(tilt/2) in the direction of x_a and y_a, at any tilt.
TEST(SpatialJoints, AlignedAxesHaveNoSecondSolutionUpsideDown) {
  const Component row = in_space(joint_row("revolute"));
  const JointInstance joint(row, ParameterStub(row));
  const MarkerKinematics a = marker({0, 0, 0}, Matrix3d::Identity());
  for (const double tilt : {0.3, 1.7, 3.0, 3.14}) {
    const Rows rows = spatial_rows(joint, a, marker({0, 0, 0}, turn({0.0, tilt, 0.0})));  // z_b leans towards x_a
    EXPECT_NEAR(rows.phi[3], 2.0 * std::tan(0.5 * tilt), 1e-9 * rows.phi[3]);
    EXPECT_NEAR(rows.phi[4], 0.0, 1e-12);
  }
}

// The rotation vector is axis times angle, also where series and closed form meet and close to half a turn.
TEST(SpatialJoints, FixedFramesReadTheRotationVector) {
  const Component row = in_space(joint_row("fixed"));
  const JointInstance joint(row, ParameterStub(row));
  const Matrix3d first = turn({0.4, -0.7, 0.9});
  const Vector3d axis = Vector3d(2.0, -1.0, 0.5).normalized();
  for (const double angle : {1e-12, 1e-7, 0.4999, 0.5001, 1.9, 3.1}) {
    const Rows rows = spatial_rows(joint, marker({0, 0, 0}, first), marker({0, 0, 0}, first * turn(angle * axis)));
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(rows.phi[static_cast<std::size_t>(3 + i)], angle * axis[i], 1e-14);
  }
}

TEST(SpatialJoints, NameTheAxisThatTheModelFileTurns) {
  EXPECT_EQ(joint_row("revolute").description.axis, MarkerAxis::z);
  EXPECT_EQ(joint_row("revolute-clearance").description.axis, MarkerAxis::z);
  EXPECT_EQ(joint_row("cylindrical").description.axis, MarkerAxis::z);
  EXPECT_EQ(joint_row("planar").description.axis, MarkerAxis::z);
  EXPECT_EQ(joint_row("prismatic").description.axis, MarkerAxis::x);
  EXPECT_EQ(joint_row("point-on-line").description.axis, MarkerAxis::x);
  EXPECT_EQ(joint_row("spherical").description.axis, MarkerAxis::none);
}

}  // namespace
}  // namespace freeplay::test
