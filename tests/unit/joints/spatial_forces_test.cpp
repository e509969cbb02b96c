#include "spatial_force.h"

namespace freeplay::test {
namespace {

SpatialForce bushing(double damping) {
  static const Component row = in_space(joint_row("bushing"));
  ParameterStub stub(row);
  const char* names[] = {"x", "y", "z", "turn_x", "turn_y", "turn_z"};
  const double sizes[] = {1e3, 2e3, 5e3, 10.0, 30.0, 70.0};
  for (int i = 0; i < 6; ++i) {
    stub.numbers[std::string("stiffness.") + names[i]] = sizes[i];
    stub.numbers[std::string("damping.") + names[i]] = damping * sizes[i];
  }
  return {row, stub};
}
SpatialForce spring(bool rotational, double damping) {
  static const Component row = in_space(joint_row("spring-damper"));
  ParameterStub stub(row);
  stub.words["kind"] = rotational ? 1 : 0;
  stub.numbers["stiffness"] = 200.0;
  stub.numbers["damping"] = damping;
  stub.numbers[rotational ? "free_angle" : "free_length"] = 0.2;
  stub.numbers["preload"] = 3.0;
  return {row, stub};
}
void set_markers(SpatialForce& f) {
  f.a = spatial_a.at(0.0);
  f.b = spatial_b.at(0.0);
}

struct Element {
  std::string name;
  SpatialForce (*make)(double damping);
};
class ForcesInSpace : public testing::TestWithParam<Element> {};

TEST_P(ForcesInSpace, BalanceAboutAnyPointAndForEveryObserver) {
  SpatialForce f = GetParam().make(0.1);
  set_markers(f);
  expect_balance(f);
  expect_same_for_another_observer(f, 1e-13);
}
TEST_P(ForcesInSpace, GiveBackTheWorkThatTheyStore) {
  SpatialForce f = GetParam().make(0.0);
  set_markers(f);
  f.apply();
  EXPECT_NEAR(f.power(), -f.potential_rate, 1e-12 * std::abs(f.potential_rate));
  // and what they say is stored is that rate
  const double h = 1e-5;
  const auto stored = [&](double t) {
    f.a = spatial_a.at(t);
    f.b = spatial_b.at(t);
    f.apply();
    return f.potential;
  };
  const double slope = (stored(h) - stored(-h)) / (2.0 * h);
  set_markers(f);
  f.apply();
  EXPECT_NEAR(f.potential_rate, slope, 1e-7 * std::abs(slope));
}
TEST_P(ForcesInSpace, LoseEnergyByDamping) {
  SpatialForce f = GetParam().make(0.1);
  set_markers(f);
  f.apply();
  EXPECT_LT(f.power() + f.potential_rate, -1e-3);
}
TEST_P(ForcesInSpace, DerivativesAgreeWithDifferences) {
  SpatialForce f = GetParam().make(0.1);
  set_markers(f);
  expect_derivatives(f, 1e-5, 1e-7);
}
INSTANTIATE_TEST_SUITE_P(
    Element, ForcesInSpace,
    testing::Values(Element{"bushing", bushing},
                    Element{"linear_spring", [](double damping) { return spring(false, damping); }},
                    Element{"rotational_spring", [](double damping) { return spring(true, damping); }}),
    [](const auto& element) { return element.param.name; });

// Shifted by (1, 2, 3) mm and turned about z by 0.5 rad: each axis has its own stiffness.
TEST(Bushing, HasAStiffnessForEachAxisOfTheFirstFrame) {
  SpatialForce f = bushing(0.0);
  const Matrix3d axes = turn({0.4, -0.7, 0.9});
  f.a = marker({0, 0, 0}, axes);
  f.b = marker(axes * Vector3d(1e-3, 2e-3, 3e-3), axes * turn({0.0, 0.0, 0.5}));
  const Wrenches w = f.apply();
  EXPECT_NEAR((axes.transpose() * w.segment<3>(6) - Vector3d(-1.0, -4.0, -15.0)).norm(), 0.0, 1e-13);
  EXPECT_NEAR((axes.transpose() * w.segment<3>(9) - Vector3d(0.0, 0.0, -35.0)).norm(), 0.0, 1e-13);
}

// In the plane both classes of the spring are one.
TEST(SpringDamperInSpace, PlanarMotionHasThePlanarForces) {
  for (const bool rotational : {false, true}) {
    SpatialForce f = spring(rotational, 4.0);
    const Component& planar_row = joint_row("spring-damper");
    ParameterStub stub(planar_row);
    stub.words["kind"] = rotational ? 1 : 0;
    stub.numbers = {{"stiffness", 200.0}, {"damping", 4.0}, {"preload", 3.0}};
    stub.numbers[rotational ? "free_angle" : "free_length"] = 0.2;
    const JointInstance planar(planar_row, stub);
    f.a = motion_a.at(0.1);
    f.b = motion_b.at(0.1);
    std::vector<double> by_planar(12 * 24), by_spatial;
    JointForces p{};
    p.derivatives = {by_planar.data(), by_planar.size()};
    JointInput in = f.in();
    if (rotational) in.coordinate = coordinate_row(planar, f.a, f.b).value;
    planar.call(&abi::JointTable::apply, &in, &p);
    const Wrenches s = f.apply(&by_spatial);
    for (int i = 0; i < 6; ++i) {
      EXPECT_NEAR(s[i], p.wrench_a[i], 1e-12) << i;
      EXPECT_NEAR(s[6 + i], p.wrench_b[i], 1e-12) << i;
    }
    for (const std::size_t r : {0u, 1u, 5u, 6u, 7u, 11u})
      for (const std::size_t k : {0u, 1u, 5u, 6u, 7u, 11u, 12u, 13u, 17u, 18u, 19u, 23u})
        EXPECT_NEAR(by_spatial[24 * r + k], by_planar[24 * r + k], 1e-11) << r << ' ' << k;
  }
}

}  // namespace
}  // namespace freeplay::test
