#include "clearance_play.h"
#include "spatial_force.h"

namespace freeplay::test {
namespace {

constexpr double bearing_length = 0.02;

ParameterStub stub_of(const Component& component, bool friction) {
  ParameterStub stub(component);
  stub.numbers["clearance.bearing_radius"] = bearing_radius;
  stub.numbers["clearance.journal_radius"] = journal_radius;
  stub.contact = std::make_shared<FunctionContact>(lankarani_nikravesh);
  if (friction) stub.friction = std::make_shared<FunctionFriction>(ramp);
  return stub;
}
SpatialForce socket(bool friction = true) {
  const Component& component = joint_row("spherical-clearance");
  return {component, stub_of(component, friction)};
}
SpatialForce bearing(bool friction = true, double axial = -1.0) {
  static const Component component = in_space(row());
  ParameterStub stub = stub_of(component, friction);
  stub.numbers["clearance.length"] = bearing_length;
  if (axial >= 0.0) stub.numbers["clearance.axial_clearance"] = axial;
  return {component, stub};
}

/// Both markers move at will; b stands at the offset `e` in a and is turned against it by `tilt` about axes of a.
void set_markers(SpatialForce& f, const Vector3d& e, const Vector3d& tilt, std::mt19937& random, double turning) {
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const auto any = [&](double size) { return Vector3d(size * u(random), size * u(random), size * u(random)); };
  const Matrix3d axes = turn(any(2.0));
  const Vector3d place = any(1e-4);
  f.a = marker(place, axes, any(1.0), any(turning));
  f.b = marker(place + axes * e, axes * turn(tilt) * turn({0.0, 0.0, 3.0 * u(random)}), any(1.0), any(turning));
}

/// All contacts are on from the start: the elastic part alone, whatever the rate is.
void hold(SpatialForce& f) {
  for (std::size_t place = 0; place < f.h.size(); place += 9) f.h[place] = 2.0;
}

// e in any direction, surfaces 2 um in each other.
TEST(SphericalClearance, ForcesBalanceAboutAnyPointAndForEveryObserver) {
  std::mt19937 random(3);
  for (int k = 0; k < 10; ++k) {
    SpatialForce f = socket();
    const Vector3d direction = turn({0.3 * k, -0.7 * k, 0.2}) * Vector3d::UnitX();
    set_markers(f, (c + 2e-6) * direction, {0.1, 0.2, 0.0}, random, 20.0);
    hold(f);
    EXPECT_GT(f.apply().norm(), 10.0);
    expect_balance(f);
    // 2 um are a difference of positions of 0.3 m to another observer.
    expect_same_for_another_observer(f, 1e-9);
  }
}

TEST(SphericalClearance, PlanarMotionHasTheForcesOfThePlanarPin) {
  Play planar(with_friction());
  SpatialForce spatial = socket();
  planar.a = spatial.a = planar_marker(1e-4, -2e-4, 0.3, 0.2, -0.1, 3.0);
  planar.b = spatial.b = planar_marker(1e-4 + 0.6 * (c + 2e-6), -2e-4 + 0.8 * (c + 2e-6), 0.7, -0.3, 0.5, -8.0);
  const std::vector<double> p = planar.apply();
  const Wrenches s = spatial.apply();
  for (int i = 0; i < 12; ++i) EXPECT_NEAR(s[i], p[static_cast<std::size_t>(i)], 1e-11 * 300.0) << i;
  EXPECT_NEAR(spatial.observe()[6], planar.observe()[5], 1e-10 * std::abs(planar.observe()[5]));
}

TEST(SphericalClearance, PowerIsThatOfTheWrenchesAndIsLost) {
  std::mt19937 random(4);
  for (int k = 0; k < 20; ++k) {
    SpatialForce f = socket();
    set_markers(f, (c + 2e-6) * Vector3d(0.36, 0.48, 0.8), {0.0, 0.0, 0.0}, random, 20.0);
    f.b = marker(vector3(f.b.position), rotation(f.b), vector3(f.a.velocity), vector3(f.b.angular_velocity));
    hold(f);
    EXPECT_NEAR(f.observe()[6], f.power(), 1e-11 * (1.0 + std::abs(f.power())));
    f.apply();
    EXPECT_LE(f.power() + f.potential_rate, 1e-9);
  }
}

// Slip (0, 3, 4) m/s across n = x: friction of 0.1 F_N against it.
TEST(SphericalClearance, FrictionOpposesTheSlipOfTheSurfaces) {
  SpatialForce f = socket();
  f.b = marker({c + 1e-6, 0, 0}, Matrix3d::Identity(), {0.0, 3.0, 4.0});
  const Wrenches w = f.apply();
  const double normal = -w[6];
  EXPECT_GT(normal, 10.0);
  EXPECT_NEAR(w[7], -0.06 * normal, 1e-12 * normal);
  EXPECT_NEAR(w[8], -0.08 * normal, 1e-12 * normal);
  // A ball that turns against the slip: R_J w x n cancels it.
  f.b = marker({c + 1e-6, 0, 0}, Matrix3d::Identity(), {0.0, 3.0, 4.0},
               {0.0, 4.0 / journal_radius, -3.0 / journal_radius});
  const Wrenches rolling = f.apply();
  EXPECT_NEAR(rolling[7], 0.0, 1e-9);
  EXPECT_NEAR(rolling[8], 0.0, 1e-9);
}

TEST(SphericalClearance, DerivativesAgreeWithDifferencesAlsoOnTheRampAndWithoutSlip) {
  std::mt19937 random(5);
  for (int k = 0; k < 5; ++k) {
    SpatialForce f = socket();
    set_markers(f, (c + 2e-6) * Vector3d(0.36, 0.48, 0.8), {0.1, 0.0, 0.2}, random, 20.0);
    expect_derivatives(f, 1e-10, 3e-7);
  }
  SpatialForce f = socket();
  f.b = marker({c + 2e-6, 0, 0}, Matrix3d::Identity(), {0.01, 3e-4, 4e-4});
  expect_derivatives(f, 1e-10, 3e-7);
  f.b = marker({c + 2e-6, 0, 0}, Matrix3d::Identity(), {0.01, 0.0, 0.0});
  expect_derivatives(f, 1e-10, 3e-7);
}

TEST(SphericalClearance, LoadRestsInTheDirectionOfTheForce) {
  const InitialOffset centred = socket().offset({0.0, 0.0, 0.0}, RowMajor3::Identity());
  EXPECT_EQ(vector3(centred.position).norm(), 0.0);
}

// Slots of the planar joint: the same history makes the same force.
TEST(RevoluteClearanceInSpace, PlanarMotionHasTheForcesOfThePlanarPin) {
  Play planar(with_friction());
  SpatialForce spatial = bearing();
  planar.a = spatial.a = planar_marker(1e-4, -2e-4, 0.3, 0.2, -0.1, 3.0);
  planar.b = spatial.b = planar_marker(1e-4 + 0.6 * (c + 2e-6), -2e-4 + 0.8 * (c + 2e-6), 0.7, 0.3, 0.5, -8.0);
  const auto compare = [&] {
    std::vector<double> by_planar, by_spatial;
    const std::vector<double> p = planar.apply(&by_planar);
    const Wrenches s = spatial.apply(&by_spatial);
    EXPECT_GT(s.norm(), 10.0);
    for (int i = 0; i < 12; ++i) EXPECT_NEAR(s[i], p[static_cast<std::size_t>(i)], 1e-11 * 300.0) << i;
    for (const std::size_t r : {0u, 1u, 5u, 6u, 7u, 11u})
      for (const std::size_t k : {0u, 1u, 5u, 6u, 7u, 11u, 12u, 13u, 17u, 18u, 19u, 23u})
        EXPECT_NEAR(by_spatial[24 * r + k], by_planar[24 * r + k], 1e-9 * (1.0 + std::abs(by_planar[24 * r + k])));
    EXPECT_NEAR(spatial.potential, planar.potential, 1e-12 * planar.potential);
    const auto from_plane = planar.observe();
    const std::vector<double> from_space = spatial.observe();
    for (const auto& [i, k] : {std::pair{0u, 0u}, {1u, 1u}, {2u, 3u}, {3u, 4u}, {4u, 5u}, {5u, 6u}, {6u, 7u}})
      EXPECT_NEAR(from_space[k], from_plane[i], 1e-10 * (1e-6 + std::abs(from_plane[i]))) << i;
  };
  compare();
  // As one contact that began with its own approach speed, at both ends.
  planar.on_event(0, 0.0);
  spatial.on_event(0);
  spatial.on_event(2);
  planar.b.velocity[0] = spatial.b.velocity[0] = -0.3;
  compare();
}

TEST(RevoluteClearanceInSpace, PlanarMotionHasThePredictionOfThePlanarPin) {
  Play planar(radii());
  SpatialForce spatial = bearing(false);
  MarkerAccelerations acc{};
  acc.a[0] = -4.0, acc.a[1] = 2.0, acc.a[5] = 30.0, acc.b[0] = 6.0, acc.b[5] = -50.0;
  planar.a = spatial.a = planar_marker(0.0, 0.0, 0.2, 0.0, 0.0, 7.0);
  planar.b = spatial.b = planar_marker(0.5e-4, 0.3e-4, 0.3, 0.2, 0.1, -3.0);
  planar.begin_step(1e-3, acc);
  spatial.begin_step(1e-3, acc);
  planar.b = spatial.b = planar_marker(c + 1e-6, 0.0, 0.0, 0.05);
  EXPECT_NEAR(spatial.apply()[0], planar.apply()[0], 1e-10 * planar.apply()[0]);
}

// Tilt about y by theta at the middle: the axis stands at +-theta L/2 in x at the ends.
TEST(RevoluteClearanceInSpace, TiltedJournalTouchesAtBothEndsOnOppositeSides) {
  SpatialForce f = bearing(false);
  const double reach = c + 2e-6, theta = std::atan(reach / (0.5 * bearing_length));
  f.b = marker({0, 0, 0}, turn({0.0, theta, 0.0}));
  const Wrenches w = f.apply();
  const double one = 0.5 * K * std::pow(2e-6, 1.5);
  EXPECT_NEAR(w.segment<3>(6).norm(), 0.0, 1e-6 * one);
  // The moment turns the journal back: about -y, arm L/2 to each end along the tilted axis.
  EXPECT_NEAR(w[10], -2.0 * one * 0.5 * bearing_length / std::pow(std::cos(theta), 2), 1e-6 * one);
  EXPECT_NEAR(f.observe()[3], 2e-6, 1e-15);
  EXPECT_NEAR(f.observe()[4], 2.0 * one, 1e-6 * one);
}
TEST(RevoluteClearanceInSpace, ShiftedAndTiltedJournalTouchesAtOneEnd) {
  SpatialForce f = bearing(false);
  const double theta = 2e-3;  // 2e-5 m at the ends
  f.b = marker({c - 1e-5, 0, 0}, turn({0.0, theta, 0.0}));
  const double delta = c - 1e-5 + std::tan(theta) * 0.5 * bearing_length - c;
  const auto [g, rate] = f.events();
  EXPECT_NEAR(g[0], delta, 1e-15);
  EXPECT_LT(g[2], 0.0);
  // F/2 across the tilted axis.
  EXPECT_NEAR(f.apply().segment<3>(6).norm(), 0.5 * K * std::pow(delta, 1.5) / std::cos(theta), 1e-6);
}

TEST(RevoluteClearanceInSpace, ShouldersHoldTheJournalBeyondItsAxialPlay) {
  for (const double axial : {-1.0, 3e-4, 0.0}) {  // not given: the radial clearance
    SpatialForce f = bearing(true, axial);
    const double play = axial < 0.0 ? c : axial;
    for (const double to : {1.0, -1.0}) {
      f.b = marker({0, 0, to * (play + 2e-6)}, Matrix3d::Identity());
      const Wrenches w = f.apply();
      EXPECT_NEAR(w[8], -to * K * std::pow(2e-6, 1.5), 1e-6);
      EXPECT_EQ(w[6], 0.0);
      f.b = marker({0, 0, to * 0.99 * play}, Matrix3d::Identity());
      EXPECT_EQ(f.apply().norm(), 0.0);
    }
  }
}

TEST(RevoluteClearanceInSpace, ForcesBalanceAboutAnyPointAndForEveryObserver) {
  std::mt19937 random(6);
  for (int k = 0; k < 10; ++k) {
    SpatialForce f = bearing();
    set_markers(f, {c - 5e-6, 1e-5, c + 1e-6}, {1e-3, 2e-3, 0.0}, random, 20.0);
    hold(f);
    EXPECT_GT(f.apply().norm(), 10.0);
    expect_balance(f);
    expect_same_for_another_observer(f, 1e-8);
  }
}

TEST(RevoluteClearanceInSpace, PowerIsThatOfTheWrenchesAndOnlyFrictionLosesIt) {
  std::mt19937 random(7);
  for (const bool friction : {false, true}) {
    for (int k = 0; k < 20; ++k) {
      SpatialForce f = bearing(friction);
      set_markers(f, {c - 5e-6, 1e-5, c + 1e-6}, {1e-3, 2e-3, 0.0}, random, 5.0);
      hold(f);
      const double power = f.power();
      EXPECT_NEAR(f.observe()[6], power, 1e-10 * (1.0 + std::abs(power)));
      if (friction) {
        EXPECT_LT(power + f.potential_rate, 0.0);
      } else {
        EXPECT_NEAR(power + f.potential_rate, 0.0, 1e-9 * std::abs(power));
      }
    }
  }
}

TEST(RevoluteClearanceInSpace, EventRatesAreThoseOfTheGaps) {
  std::mt19937 random(8);
  SpatialForce f = bearing();
  set_markers(f, {c - 5e-6, 1e-5, 1e-5}, {1e-2, 2e-2, 0.0}, random, 5.0);
  const MarkerKinematics a = f.a, b = f.b;
  const auto at = [&](double t) {
    const auto moved = [t](const MarkerKinematics& m) {
      return marker(vector3(m.position) + t * vector3(m.velocity), turn(t * vector3(m.angular_velocity)) * rotation(m),
                    vector3(m.velocity), vector3(m.angular_velocity));
    };
    f.a = moved(a);
    f.b = moved(b);
    return f.events();
  };
  const double step = 1e-7;
  const auto now = at(0.0), b1 = at(-step), b2 = at(-2.0 * step), a1 = at(step), a2 = at(2.0 * step);
  for (const std::size_t i : {0u, 2u, 4u, 6u}) {
    const double slope = (8.0 * (a1.first[i] - b1.first[i]) - (a2.first[i] - b2.first[i])) / (12.0 * step);
    EXPECT_NEAR(now.second[i], slope, 1e-8) << i;
  }
}

TEST(RevoluteClearanceInSpace, DerivativesAgreeWithDifferences) {
  std::mt19937 random(9);
  for (int k = 0; k < 5; ++k) {
    SpatialForce f = bearing();
    set_markers(f, {c - 5e-6, 1e-5, c + 1e-6}, {1e-3, 2e-3, 0.0}, random, 20.0);
    for (const int begin : {0, 4}) f.on_event(begin);
    expect_derivatives(f, 1e-10, 1e-6);
  }
}

// Contact at the upper end only: its history is its own.
TEST(RevoluteClearanceInSpace, EachEndRemembersItsOwnApproachSpeed) {
  SpatialForce f = bearing(false);
  f.b = marker({c, 0, 0}, Matrix3d::Identity(), {0.2, 0, 0});
  f.on_event(0);
  f.b = marker({c, 0, 0}, Matrix3d::Identity(), {0.5, 0, 0});
  f.on_event(2);
  f.b = marker({c + 1e-6, 0, 0}, Matrix3d::Identity(), {0.1, 0, 0});
  const auto force = [](double v0) { return 0.5 * lankarani_nikravesh({1e-6, 0.1, v0}).normal; };
  EXPECT_NEAR(f.apply()[0], force(0.2) + force(0.5), 1e-9 * f.apply()[0]);
}

TEST(RevoluteClearanceInSpace, LoadRestsInTheAxesOfTheBearing) {
  const RowMajor3 axes = turn({0.4, -0.7, 0.9});
  const Vector3d load = axes * Vector3d(3.0, -4.0, 12.0);
  const InitialOffset offset = [&] {
    static const Component component = in_space(row());
    ParameterStub stub = stub_of(component, false);
    stub.numbers["clearance.length"] = bearing_length;
    stub.words["clearance.initial"] = 1;
    return SpatialForce(component, stub).offset(load, axes);
  }();
  const Vector3d place = axes.transpose() * vector3(offset.position);
  const auto depth = [](double force) { return std::pow(force / K, 2.0 / 3.0); };
  // Along the load across the axis: the shoulder lifts the place where it acts, which tilts the pin, and so on.
  double height = 0.0, slope = 0.0, along = 0.0;
  for (int i = 0; i < 4; ++i) {
    height = -(c + depth(12.0 + 5.0 * slope));
    const double upper = -(c + depth(10.0 * (0.5 + height / bearing_length))),
                 lower = -(c + depth(10.0 * (0.5 - height / bearing_length)));
    slope = (upper - lower) / bearing_length;
    along = 0.5 * (upper + lower) + height * slope;
  }
  EXPECT_NEAR(place.x(), 0.6 * along, 1e-15);
  EXPECT_NEAR(place.y(), -0.8 * along, 1e-15);
  EXPECT_NEAR(place.z(), height, 1e-15);
}

// On one side of the bearing, on opposite ones, and on a shoulder; what the tilt, 2 c/L at most, does to the arms is
// left out in squares.
TEST(RevoluteClearanceInSpace, LoadedItExertsForceAndMomentOfTheReaction) {
  const Component component = in_space(row());
  ParameterStub stub = stub_of(component, false);
  stub.numbers["clearance.length"] = bearing_length;
  stub.words["clearance.initial"] = 1;
  SpatialForce f(component, stub);
  f.a = marker({0.1, -0.2, 0.3}, turn({0.4, -0.7, 0.9}));
  const Matrix3d axes = rotation(f.a);
  for (const Vector3d& moment : {Vector3d(0.0, 0.0, 0.0), Vector3d(0.01, -0.02, 0.0), Vector3d(-0.4, 0.3, 0.0)}) {
    Eigen::Matrix<double, 6, 1> load;
    load << axes * Vector3d(30.0, -40.0, 12.0), axes * moment;
    const InitialOffset offset = f.offset(load);
    f.b = marker(vector3(f.a.position) + vector3(offset.position), turn(vector3(offset.tilt)) * axes);
    const double size = 50.0 + moment.norm() / bearing_length;
    const Wrenches w = f.apply();
    EXPECT_NEAR((w.segment<3>(6) - load.head<3>()).norm(), 0.0, 1e-3 * size);
    EXPECT_NEAR((w.segment<3>(9) - load.tail<3>()).norm(), 0.0, 1e-3 * size * bearing_length);
    EXPECT_GT(vector3(offset.tilt).norm(), moment.norm() > 0.0 ? 1e-4 : -1.0);
  }
}

TEST(RevoluteClearanceInSpace, NeedsItsLengthAndAFrictionThatItCanKeep) {
  const Component component = in_space(row());
  ParameterStub stub = stub_of(component, false);
  EXPECT_EQ(bad_parameter_id([&] { JointInstance joint(component, stub); }), "missing-key");
  stub.numbers["clearance.length"] = bearing_length;
  stub.friction = std::make_shared<FunctionFriction>(bristle, 1);
  EXPECT_EQ(bad_parameter_id([&] { JointInstance joint(component, stub); }), "");
  stub.friction = std::make_shared<FunctionFriction>(bristle, 9);
  EXPECT_EQ(bad_parameter_id([&] { JointInstance joint(component, stub); }), "out-of-range");
}
TEST(RevoluteClearance, HasNoPlayAlongTheAxisInThePlane) {
  ParameterStub stub = radii();
  stub.numbers["clearance.axial_clearance"] = 1e-4;
  EXPECT_EQ(bad_parameter_id([&] { JointInstance joint(row(), stub); }), "type-space");
}

}  // namespace
}  // namespace freeplay::test
