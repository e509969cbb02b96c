#include <array>
#include <random>

#include "joint_probe.h"

namespace freeplay::test {
namespace {

// Base set: steel pin in a bearing of 5 mm with 0.1 mm of play. K of Hertz, chi = 3(1 - 0.81)/4.
constexpr double K = 75062104464.41812, chi = 0.1425, bearing_radius = 0.005, journal_radius = 0.0049, c = 1e-4;

ContactForce lankarani_nikravesh(const ContactState& s) {
  const double elastic = K * s.penetration * std::sqrt(s.penetration),
               loss = s.approach_speed > 0.0 ? chi / s.approach_speed : 0.0;
  const double factor = 1.0 + loss * s.rate, potential = 0.4 * elastic * s.penetration;
  if (factor <= 0.0) return {0.0, 0.0, 0.0, potential};
  return {elastic * factor, 1.5 * elastic / s.penetration * factor, elastic * loss, potential};
}
FrictionForce ramp(const FrictionState& s, Span<double>) {
  const double mu = 0.1, v0 = 1e-4, v1 = 1e-3, speed = std::abs(s.slip_speed);
  if (speed <= v0) return {};
  const double share = std::copysign(mu * std::min(1.0, (speed - v0) / (v1 - v0)), s.slip_speed);
  return {-share * s.normal_force, -share, speed < v1 ? -mu * s.normal_force / (v1 - v0) : 0.0};
}
/// A bristle z of relative stiffness 2e3 1/m: z' = v - 5e3 |v| z, force -F_N (2e3 z + 0.3 z').
FrictionForce bristle(const FrictionState& s, Span<double> rate) {
  const double z = s.internal[0], speed = std::abs(s.slip_speed);
  rate[0] = s.slip_speed - 5e3 * speed * z;
  const double per_force = -(2e3 * z + 0.3 * rate[0]);
  return {per_force * s.normal_force, per_force, -0.3 * (1.0 - std::copysign(5e3, s.slip_speed) * z) * s.normal_force};
}

const Component& row() { return joint_row("revolute-clearance"); }

ParameterStub radii(std::map<std::string, double> numbers = {{"bearing_radius", bearing_radius},
                                                             {"journal_radius", journal_radius}}) {
  ParameterStub stub(row());
  for (const auto& [name, value] : numbers) stub.numbers["clearance." + name] = value;
  stub.contact = std::make_shared<FunctionContact>(lankarani_nikravesh);
  return stub;
}
ParameterStub with_friction() {
  ParameterStub stub = radii();
  stub.friction = std::make_shared<FunctionFriction>(ramp);
  return stub;
}
ParameterStub with_bristle() {
  ParameterStub stub = radii();
  stub.friction = std::make_shared<FunctionFriction>(bristle, 1);
  return stub;
}

/// A clearance joint with its share of z and h.
class Play {
 public:
  explicit Play(const ParameterStub& stub) : contact_(stub.contact), friction_(stub.friction), joint_(row(), stub) {
    joint_.call(&abi::JointTable::declare, &layout);
    z.resize(static_cast<std::size_t>(layout.internal_variables));
    h.resize(static_cast<std::size_t>(layout.history));
  }
  JointInput in(double t = 0.0) const { return input(t, a, b, {z.data(), z.size()}, {h.data(), h.size()}); }
  Span<double> zs() { return {z.data(), z.size()}; }
  Span<double> hs() { return {h.data(), h.size()}; }

  void initialize() {
    const JointInput i = in();
    joint_.call(&abi::JointTable::initialize, &i, zs(), hs());
  }
  void begin_step(double dt, MarkerAccelerations acc = {}, double t = 0.0) {
    const JointInput i = in(t);
    joint_.call(&abi::JointTable::begin_step, &i, &acc, dt, hs());
  }
  std::array<double, 7> on_event(int index, double t) {
    std::array<double, 7> fields{};
    const JointInput i = in(t);
    joint_.call(&abi::JointTable::on_event, index, &i, zs(), hs(), Span<double>(fields.data(), 7));
    return fields;
  }
  void commit(double t) {
    const JointInput i = in(t);
    joint_.call(&abi::JointTable::commit, &i, Span<const double>(), hs());
  }
  struct EventValues {
    double g[2], rate[2];
  };
  EventValues events() const {
    EventValues e{};
    const JointInput i = in();
    joint_.call(&abi::JointTable::events, &i, Span<double>(e.g), Span<double>(e.rate));
    return e;
  }
  std::array<double, 7> observe() const {
    std::array<double, 7> channels{};
    const JointInput i = in();
    joint_.call(&abi::JointTable::observe, &i, Span<const double>(), Span<double>(channels.data(), 7));
    return channels;
  }
  InitialOffset offset(double fx, double fy) const {
    InitialOffset out{};
    const double reaction[] = {fx, fy, 0.0};
    joint_.call(&abi::JointTable::initial_offset, Span<const double>(reaction), &out);
    return out;
  }
  /// [wrench a, wrench b, z'] and, if asked, their derivatives.
  std::vector<double> apply(std::vector<double>* derivatives = nullptr) const {
    std::vector<double> rate(z.size());
    JointForces f{};
    f.internal_rate = {rate.data(), rate.size()};
    if (derivatives) {
      derivatives->assign((12 + z.size()) * (24 + z.size()), 0.0);
      f.derivatives = {derivatives->data(), derivatives->size()};
    }
    const JointInput i = in();
    joint_.call(&abi::JointTable::apply, &i, &f);
    std::vector<double> all(f.wrench_a, f.wrench_a + 6);
    all.insert(all.end(), f.wrench_b, f.wrench_b + 6);
    all.insert(all.end(), rate.begin(), rate.end());
    potential = f.potential;
    return all;
  }
  /// Into contact with the approach speed v0 by a located event at the present markers.
  void touch(double v0) {
    const MarkerKinematics kept_a = a, kept_b = b;
    a = planar_marker(0.0, 0.0, 0.0);
    b = planar_marker(c, 0.0, 0.0, v0);
    on_event(0, 0.0);
    a = kept_a;
    b = kept_b;
  }

  JointLayout layout;
  MarkerKinematics a = planar_marker(0.0, 0.0, 0.0), b = planar_marker(0.0, 0.0, 0.0);
  std::vector<double> z, h;
  mutable double potential = 0.0;

 private:
  // The laws outlive the joint, as they do in a model.
  std::shared_ptr<ContactLaw> contact_;
  std::shared_ptr<FrictionLaw> friction_;
  JointInstance joint_;
};

/// A body at q = (x, y, angle) with velocity v, and its marker at s in its axes.
MarkerKinematics marker_on(const double (&q)[3], const double (&v)[3], const double (&s)[2]) {
  const double cq = std::cos(q[2]), sq = std::sin(q[2]), x = cq * s[0] - sq * s[1], y = sq * s[0] + cq * s[1];
  return planar_marker(q[0] + x, q[1] + y, q[2], v[0] - v[2] * y, v[1] + v[2] * x, v[2]);
}

struct Sample {
  double qi[3], vi[3], qj[3], vj[3], si[2], sj[2], v0;
  double delta, rate, slip, fn, ft, on_j[3], on_i[3], power;
};
// Evaluated in double precision from the formulas of the class, with laws as above; wrenches are about mass centres.
constexpr Sample samples[] = {{{0.1, 0.2, 0.3},
                               {0.5, -0.2, 3.0},
                               {0.306490769, 0.19614106, -0.4},
                               {0.35, 0.27, -7.0},
                               {0.12, 0.0},
                               {-0.1, 0.0005},
                               0.1,
                               1.4000945324230612e-06,
                               0.47496676970166835,
                               -0.69767621439969,
                               208.51879259319512,
                               20.851879259319514,
                               {108.78323009017728, -179.1119666139499, 12.278272960943415},
                               {-108.78323009017728, 179.1119666139499, 24.286906804349236},
                               -113.58729913563926},
                              {{0.0, 0.0, 0.0},
                               {0.0, 0.0, 0.0},
                               {0.000101, 0.0, 0.0},
                               {0.02, 0.0005, 0.0},
                               {0.0, 0.0},
                               {0.0, 0.0},
                               0.02,
                               9.999999999997397e-07,
                               0.02,
                               0.0005,
                               85.75845435056424,
                               -3.8114868600250777,
                               {-85.75845435056424, -3.8114868600250777, -0.018674379870692866},
                               {85.75845435056424, 3.8114868600250777, 0.0190593400435554},
                               -1.7170748304412973},
                              {{0.02, -0.01, 1.2},
                               {0.3, 0.1, 10.0},
                               {0.02, -0.0101015, 0.7},
                               {0.31, 0.08, -20.0},
                               {0.0, 0.0},
                               {0.0, 0.0},
                               0.05,
                               1.499999999998898e-06,
                               0.020000000000000004,
                               -0.138,
                               145.7580710172481,
                               14.575807101724813,
                               {14.575807101724813, 145.7580710172481, 0.0714105229431253},
                               {-14.575807101724813, -145.7580710172481, -0.07288996736395036},
                               -4.9265134818297245}};

void expect_wrench(const double* wrench, const double (&q)[3], const MarkerKinematics& m, const double (&expected)[3]) {
  const double moment = wrench[5] + (m.position[0] - q[0]) * wrench[1] - (m.position[1] - q[1]) * wrench[0];
  // Penetration is a difference of coordinates of 0.3 m: its rounding is 4e-11 of 1.4 um.
  EXPECT_NEAR(wrench[0], expected[0], 1e-7);
  EXPECT_NEAR(wrench[1], expected[1], 1e-7);
  EXPECT_NEAR(moment, expected[2], 1e-8);
}

TEST(RevoluteClearance, KinematicsAndWrenchesAreThoseOfTheFormulas) {
  for (const Sample& s : samples) {
    Play play(with_friction());
    play.a = marker_on(s.qi, s.vi, s.si);
    play.b = marker_on(s.qj, s.vj, s.sj);
    play.touch(s.v0);
    const auto channels = play.observe();
    EXPECT_NEAR(channels[2], s.delta, 1e-15);
    EXPECT_NEAR(channels[3], s.fn, 1e-7);
    EXPECT_NEAR(channels[4], s.ft, 1e-8);
    EXPECT_NEAR(channels[5], s.power, 1e-7);
    EXPECT_EQ(channels[6], 1.0);
    EXPECT_NEAR(play.events().rate[1], s.rate, 1e-12);
    EXPECT_NEAR(play.on_event(1, 0.0)[1], s.slip, 1e-12);
    play.touch(s.v0);
    const auto wrenches = play.apply();
    expect_wrench(wrenches.data(), s.qi, play.a, s.on_i);
    expect_wrench(wrenches.data() + 6, s.qj, play.b, s.on_j);
    EXPECT_NEAR(play.potential, 0.4 * K * std::pow(s.delta, 2.5), 1e-12);
  }
}

// Journal turning in a bearing at rest, touching at n = (1, 0): v_T = R_J w > 0, friction brakes it.
TEST(RevoluteClearance, FrictionBrakesATurningJournal) {
  Play play(with_friction());
  play.b = planar_marker(c + 1e-6, 0.0, 0.0, 0.0, 0.0, 5.0);
  play.touch(0.1);
  const auto w = play.apply();
  EXPECT_LT(w[11], 0.0);
  EXPECT_NEAR(play.on_event(1, 0.0)[1], journal_radius * 5.0, 1e-15);
}

TEST(RevoluteClearance, ForceIsZeroWhileJournalIsInsideTheGap) {
  for (const double distance : {0.0, 1e-17, 0.5 * c, c}) {
    Play play(with_bristle());
    play.a = planar_marker(0.0, 0.0, 0.4, 0.3, 0.1, 2.0);
    play.b = planar_marker(distance, 0.0, 0.1, -0.2, 0.1, 1.0);
    std::vector<double> derivatives;
    for (const double x : play.apply(&derivatives)) EXPECT_EQ(x, 0.0);
    for (const double x : derivatives) EXPECT_EQ(x, 0.0);
  }
}

/// Random markers at `distance` of their origins, near the world origin so that differences keep their digits.
void place_at_random(Play& play, std::mt19937& random, double distance) {
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const double angle = 3.0 * u(random), x = 1e-4 * u(random), y = 1e-4 * u(random);
  play.a = planar_marker(x, y, u(random), u(random), u(random), 20.0 * u(random));
  play.b = planar_marker(x + distance * std::cos(angle), y + distance * std::sin(angle), u(random), u(random),
                         u(random), 20.0 * u(random));
  for (double& z : play.z) z = 1e-4 * u(random);
}

TEST(RevoluteClearance, WrenchesBalanceAboutAnyPoint) {
  std::mt19937 random(7);
  for (int k = 0; k < 20; ++k) {
    Play play(with_friction());
    place_at_random(play, random, c + 2e-6);
    play.touch(0.3);
    const auto w = play.apply();
    const double px = 0.7, py = -0.4;
    const auto moment = [&](const double* f, const MarkerKinematics& m) {
      return f[5] + (m.position[0] - px) * f[1] - (m.position[1] - py) * f[0];
    };
    EXPECT_EQ(w[0] + w[6], 0.0);
    EXPECT_EQ(w[1] + w[7], 0.0);
    EXPECT_NEAR(moment(w.data(), play.a) + moment(w.data() + 6, play.b), 0.0, 1e-13 * 300.0);
  }
}

TEST(RevoluteClearance, PowerIsThatOfTheWrenches) {
  std::mt19937 random(8);
  for (int k = 0; k < 20; ++k) {
    Play play(with_friction());
    place_at_random(play, random, c + 2e-6);
    play.touch(0.3);
    const auto w = play.apply();
    const double power = w[0] * play.a.velocity[0] + w[1] * play.a.velocity[1] + w[5] * play.a.angular_velocity[2] +
                         w[6] * play.b.velocity[0] + w[7] * play.b.velocity[1] + w[11] * play.b.angular_velocity[2];
    EXPECT_NEAR(play.observe()[5], power, 1e-12 * (1.0 + std::abs(power)));
  }
}

/// Moves one column of [pose a, pose b, twist a, twist b, z] by `step`.
void shift(Play& play, std::size_t column, double step) {
  if (column >= 24) {
    play.z[column - 24] += step;
    return;
  }
  MarkerKinematics& m = (column / 6) % 2 == 0 ? play.a : play.b;
  const std::size_t axis = column % 6;
  if (column >= 12) {
    (axis < 3 ? m.velocity[axis] : m.angular_velocity[axis - 3]) += step;
  } else if (axis < 3) {
    m.position[axis] += step;
  } else if (axis == 5) {
    m = planar_marker(m.position[0], m.position[1], std::atan2(m.rotation[3], m.rotation[0]) + step, m.velocity[0],
                      m.velocity[1], m.angular_velocity[2]);
  }
}

void expect_derivatives(const Play& play) {
  const std::size_t rows = 12 + play.z.size(), columns = 24 + play.z.size();
  std::vector<double> derivatives;
  play.apply(&derivatives);
  for (std::size_t j = 0; j < columns; ++j) {
    if (j < 24 && j % 6 >= 2 && j % 6 <= 4) continue;  // out of the plane
    const double step = j < 12 ? 1e-10 : j < 24 ? 1e-6 : 1e-8;
    const auto at = [&](double by) {
      Play& p = const_cast<Play&>(play);
      const MarkerKinematics a = p.a, b = p.b;
      const auto z = p.z;
      shift(p, j, by);
      auto out = p.apply();
      p.a = a;
      p.b = b;
      p.z = z;
      return out;
    };
    // Fourth order, as the elastic force bends on the scale of the penetration.
    const auto p1 = at(step), m1 = at(-step), p2 = at(2.0 * step), m2 = at(-2.0 * step);
    for (std::size_t i = 0; i < rows; ++i) {
      const double difference = (8.0 * (p1[i] - m1[i]) - (p2[i] - m2[i])) / (12.0 * step);
      double largest = 0.0;  // of the row in this block of columns
      for (std::size_t k = 6 * (j / 6); k < std::min(6 * (j / 6) + 6, columns); ++k)
        largest = std::max(largest, std::abs(derivatives[i * columns + k]));
      EXPECT_NEAR(derivatives[i * columns + j], difference, 3e-7 * largest + 1e-6) << "row " << i << " column " << j;
    }
  }
}

TEST(RevoluteClearance, DerivativesAgreeWithDifferencesInContact) {
  std::mt19937 random(9);
  for (int k = 0; k < 10; ++k) {
    Play play(with_friction());
    place_at_random(play, random, c + 2e-6);
    play.touch(1.5);
    expect_derivatives(play);
  }
}

TEST(RevoluteClearance, DerivativesAgreeWithDifferencesOnTheFrictionRamp) {
  Play play(with_friction());
  play.a = planar_marker(1e-4, -2e-4, 0.3, 0.1, 0.2, 0.0);
  play.b = planar_marker(1e-4 + c + 2e-6, -2e-4, 0.1, 0.15, 0.2 + 5e-4, 0.0);  // slip 5e-4 m/s
  play.touch(0.1);
  expect_derivatives(play);
}

TEST(RevoluteClearance, DerivativesAgreeWithDifferencesWithInternalVariables) {
  std::mt19937 random(10);
  for (int k = 0; k < 10; ++k) {
    Play play(with_bristle());
    place_at_random(play, random, c + 2e-6);
    play.touch(1.5);
    expect_derivatives(play);
  }
}

TEST(RevoluteClearance, DerivativesAgreeWithDifferencesWhereContactBeginsUnpredicted) {
  Play play(with_friction());
  play.a = planar_marker(1e-4, -2e-4, 0.3, 0.1, 0.2, 3.0);
  play.b = planar_marker(1e-4 + c + 2e-6, -2e-4 + 1e-6, 0.1, 0.4, 0.3, -2.0);
  expect_derivatives(play);
}

// delta = -4e-5 + 0.2 s + 5 s^2 for e = (0.6e-4, 0), e' = (0.2, 0), e'' = (10, 0): s = 1.990...e-4 s,
// v_0 = sqrt(0.2^2 + 2 10 4e-5) = 0.2019900988... m/s.
TEST(RevoluteClearance, PredictsTheApproachSpeedOfAContactInsideTheStep) {
  Play play(radii());
  play.b = planar_marker(0.6e-4, 0.0, 0.0, 0.2);
  MarkerAccelerations acc{};
  acc.a[0] = -4.0;
  acc.b[0] = 6.0;
  play.begin_step(1e-3, acc);
  play.b = planar_marker(c + 1e-6, 0.0, 0.0, 0.21);
  const double v0 = std::sqrt(0.04 + 20.0 * 4e-5);
  EXPECT_NEAR(play.apply()[0], lankarani_nikravesh({1e-6, 0.21, v0}).normal, 1e-7);
  // Told inside a fixed step, the contact keeps what the forces have used.
  play.on_event(0, 2e-4);
  play.b = planar_marker(c + 1e-6, 0.0, 0.0, -0.05);
  EXPECT_NEAR(play.apply()[0], lankarani_nikravesh({1e-6, -0.05, v0}).normal, 1e-7);
}

// delta = -1e-5 - 0.01 s + 10 s^2: it turns back and touches at s = 1.62e-3 s with v_0 = sqrt(0.01^2 + 2 20 1e-5) m/s.
TEST(RevoluteClearance, PredictsAJournalThatTurnsBack) {
  Play play(radii());
  MarkerAccelerations acc{};
  acc.b[0] = 20.0;
  const auto force_after = [&](double dt) {
    play.b = planar_marker(c - 1e-5, 0.0, 0.0, -0.01);
    play.begin_step(dt, acc);
    play.b = planar_marker(c + 1e-6, 0.0, 0.0, 0.03);
    return play.apply()[0];
  };
  EXPECT_NEAR(force_after(2e-3), lankarani_nikravesh({1e-6, 0.03, std::sqrt(5e-4)}).normal, 1e-7);
  EXPECT_NEAR(force_after(1e-3), lankarani_nikravesh({1e-6, 0.03, 0.03}).normal, 1e-7);
}

TEST(RevoluteClearance, TurningEccentricityDrivesThePrediction) {
  // e = (0.8e-4, 0), e' = (0, 0.1): delta'' = 0.01/0.8e-4 = 125; root of -2e-5 + 62.5 s^2 at 5.66e-4 s, but |e'| = 0.1
  // caps v_0 = 125 * 5.66e-4 = 0.0707 no further.
  Play play(radii());
  play.b = planar_marker(0.8e-4, 0.0, 0.0, 0.0, 0.1);
  play.begin_step(1e-3);
  play.b = planar_marker(c + 1e-6, 0.0, 0.0, 0.06);
  const double v0 = 125.0 * std::sqrt(2e-5 / 62.5);
  EXPECT_NEAR(play.apply()[0], lankarani_nikravesh({1e-6, 0.06, v0}).normal, 1e-7);
}

// Near the centre the parabola would say delta'' = 0.01/1e-10 = 1e8 m/s^2 and v_0 = 141 m/s.
TEST(RevoluteClearance, PredictedApproachSpeedNeverExceedsTheSpeed) {
  Play play(radii());
  play.b = planar_marker(1e-10, 0.0, 0.0, 0.0, 0.1);
  play.begin_step(1.1e-3);
  play.b = planar_marker(c + 1e-6, 0.0, 0.0, 0.05);
  EXPECT_NEAR(play.apply()[0], lankarani_nikravesh({1e-6, 0.05, 0.1}).normal, 1e-7);
}

TEST(RevoluteClearance, PredictsNothingForAContactBeyondTheStep) {
  Play play(radii());
  play.b = planar_marker(0.6e-4, 0.0, 0.0, 0.2);
  play.begin_step(1e-4);  // the gap closes after 2e-4 s
  play.b = planar_marker(c + 1e-6, 0.0, 0.0, 0.15);
  // The rate of the state itself counts: F = F_s (1 + chi).
  EXPECT_NEAR(play.apply()[0], K * 1e-9 * (1.0 + chi), 1e-7);
}

TEST(RevoluteClearance, LocatedContactTakesTheRateOfTheEvent) {
  Play play(radii());
  play.b = planar_marker(0.99e-4, 0.0, 0.0, 0.2);
  play.begin_step(5e-6);
  play.b = planar_marker(c, 0.0, 0.0, 0.19);
  const auto fields = play.on_event(0, 5e-6);
  EXPECT_EQ(fields[0], 0.19);
  EXPECT_TRUE(std::isnan(fields[3]) && std::isnan(fields[6]));
  play.b = planar_marker(c + 1e-6, 0.0, 0.0, 0.1);
  EXPECT_NEAR(play.apply()[0], lankarani_nikravesh({1e-6, 0.1, 0.19}).normal, 1e-7);
}

TEST(RevoluteClearance, GrazingContactHasAFloorUnderItsApproachSpeed) {
  Play play(radii());
  play.b = planar_marker(c, 0.0, 0.0, 1e-9);
  play.on_event(0, 0.0);
  play.b = planar_marker(c + 1e-6, 0.0, 0.0, 1e-7);
  EXPECT_NEAR(play.apply()[0], lankarani_nikravesh({1e-6, 1e-7, 1e-6}).normal, 1e-7);
}

TEST(RevoluteClearance, EventsAreArmedByTheContactFlag) {
  Play play(radii());
  play.b = planar_marker(0.5 * c, 0.0, 0.0, 0.2);
  EXPECT_NEAR(play.events().g[0], -0.5 * c, 1e-18);
  EXPECT_NEAR(play.events().rate[0], 0.2, 1e-15);
  EXPECT_TRUE(std::isnan(play.events().g[1]));
  play.touch(0.2);
  EXPECT_TRUE(std::isnan(play.events().g[0]));
  EXPECT_NEAR(play.events().g[1], -0.5 * c, 1e-18);
}

TEST(RevoluteClearance, EndOfContactReportsItsHistory) {
  Play play(radii());
  play.begin_step(1e-5, {}, 1.0);
  play.b = planar_marker(0.0, c, 0.0, 0.0, 0.2);
  play.on_event(0, 1.0);
  for (const double depth : {1e-6, 3e-6, 2e-6}) {
    play.b = planar_marker(0.0, c + depth, 0.0, 0.0, 0.0);
    play.commit(1.0 + 10.0 * depth);
  }
  play.b = planar_marker(0.0, c, 0.0, 0.05, -0.18);
  const auto fields = play.on_event(1, 1.25);
  EXPECT_EQ(fields[0], 0.18);
  EXPECT_NEAR(fields[1], -0.05, 1e-15);  // t = (-1, 0)
  EXPECT_NEAR(fields[2], M_PI / 2, 1e-15);
  EXPECT_EQ(fields[3], 0.25);
  EXPECT_NEAR(fields[4], K * std::pow(3e-6, 1.5), 1e-7);
  EXPECT_NEAR(fields[5], 3e-6, 1e-18);
  EXPECT_EQ(fields[6], 4.0);  // three and the step in which it ends
  EXPECT_FALSE(std::isnan(play.events().g[0]));
  EXPECT_EQ(play.observe()[6], 0.0);
}

TEST(RevoluteClearance, ContactThatNoEventToldBeginsOnCommit) {
  Play play(radii());
  play.b = planar_marker(c + 1e-6, 0.0, 0.0, 0.1);
  play.commit(1e-4);
  EXPECT_EQ(play.observe()[6], 1.0);
  play.b = planar_marker(c + 2e-6, 0.0, 0.0, 0.05);
  EXPECT_NEAR(play.apply()[0], lankarani_nikravesh({2e-6, 0.05, 0.1}).normal, 1e-6);
  // Left over from the rounding of a located end: leaving, so no contact.
  Play leaving(radii());
  leaving.b = planar_marker(c + 1e-13, 0.0, 0.0, -0.1);
  leaving.commit(1e-4);
  EXPECT_EQ(leaving.observe()[6], 0.0);
}

TEST(RevoluteClearance, ContactFromTheStartIsElasticAndStillToBeTold) {
  Play play(radii());
  play.b = planar_marker(c + 1e-6, 0.0, 0.0, 0.3);
  play.initialize();
  EXPECT_NEAR(play.apply()[0], K * 1e-9, 1e-7);
  EXPECT_GT(play.events().g[0], 0.0);
  play.on_event(0, 0.0);
  EXPECT_TRUE(std::isnan(play.events().g[0]));
  EXPECT_NEAR(play.apply()[0], K * 1e-9, 1e-7);
}

TEST(RevoluteClearance, LoadedStartCarriesTheReaction) {
  ParameterStub stub = radii();
  stub.words["clearance.initial"] = 1;
  Play play(stub);
  const double distance = c + std::pow(50.0 / K, 1.0 / 1.5);
  const InitialOffset offset = play.offset(30.0, 40.0);
  // 0.005 - 0.0049 differs from 1e-4 by 3e-19.
  EXPECT_NEAR(offset.position[0], -0.6 * distance, 1e-18);
  EXPECT_NEAR(offset.position[1], -0.8 * distance, 1e-18);
  play.b = planar_marker(offset.position[0], offset.position[1], 0.0);
  play.initialize();
  const auto w = play.apply();
  EXPECT_NEAR(w[6], 30.0, 1e-9);
  EXPECT_NEAR(w[7], 40.0, 1e-9);
  EXPECT_EQ(play.offset(1e-13, 0.0).position[0], 0.0);
}

TEST(RevoluteClearance, StartIsCentredOrAsWritten) {
  EXPECT_EQ(Play(radii()).offset(30.0, 40.0).position[0], 0.0);
  ParameterStub stub = radii();
  stub.words["clearance.initial"] = -1;
  stub.vectors["clearance.initial.eccentricity"] = {1e-5, -2e-5};
  stub.vectors["clearance.initial.velocity"] = {0.1, 0.2};
  const InitialOffset offset = Play(stub).offset(30.0, 40.0);
  EXPECT_EQ(offset.position[1], -2e-5);
  EXPECT_EQ(offset.velocity[0], 0.1);
}

TEST(RevoluteClearance, IsTheTwinOfRevoluteWithALinkOfTheClearance) {
  EXPECT_STREQ(row().description.ideal, "revolute");
  EXPECT_STREQ(row().description.block, "clearance");
  EXPECT_NEAR(Play(radii()).layout.clearance, c, 1e-18);
  const char* names[] = {"ex", "ey", "delta", "fn", "ft", "power", "contact"};
  const JointLayout layout = Play(radii()).layout;
  ASSERT_EQ(layout.channels.size, 7u);
  for (std::size_t i = 0; i < 7; ++i) EXPECT_STREQ(layout.channels[i].name, names[i]);
}

std::string fault(const ParameterStub& stub) {
  return bad_parameter_id([&] { Play play(stub); });
}

TEST(RevoluteClearance, AnyTwoRadiiWillDo) {
  for (const auto& given :
       {radii({{"bearing_radius", 0.005}, {"journal_radius", 0.0049}}),
        radii({{"bearing_radius", 0.005}, {"radial_clearance", 1e-4}}),
        radii({{"journal_radius", 0.0049}, {"radial_clearance", 1e-4}}),
        radii({{"bearing_radius", 0.005}, {"journal_radius", 0.0049}, {"radial_clearance", 1e-4}})}) {
    Play play(given);
    EXPECT_NEAR(given.pair.bearing_radius, 0.005, 1e-17);
    EXPECT_NEAR(given.pair.journal_radius, 0.0049, 1e-17);
    EXPECT_NEAR(given.pair.radial_clearance, 1e-4, 1e-17);
  }
}

TEST(RevoluteClearance, RefusesRadiiThatAreMissingOrDisagree) {
  EXPECT_EQ(fault(radii({})), "missing-key");
  EXPECT_EQ(fault(radii({{"bearing_radius", 0.005}})), "missing-key");
  EXPECT_EQ(fault(radii({{"bearing_radius", 0.005}, {"journal_radius", 0.0049}, {"radial_clearance", 1.001e-4}})),
            "conflicting-keys");
  EXPECT_EQ(fault(radii({{"bearing_radius", 0.0049}, {"journal_radius", 0.005}})), "out-of-range");
  EXPECT_EQ(fault(radii({{"bearing_radius", 0.005}, {"radial_clearance", 0.006}})), "out-of-range");
}

TEST(RevoluteClearance, ClearanceAloneIsEnoughWithoutFriction) {
  ParameterStub stub = radii({{"radial_clearance", 1e-4}});
  Play play(stub);
  EXPECT_TRUE(std::isnan(stub.pair.bearing_radius));
  play.b = planar_marker(c + 1e-6, 0.0, 0.0, 0.0, 0.0, 7.0);
  play.touch(0.1);
  EXPECT_NEAR(play.apply()[0], K * 1e-9, 1e-7);
  EXPECT_EQ(play.apply()[5], 0.0);
  stub.friction = std::make_shared<FunctionFriction>(ramp);
  EXPECT_EQ(fault(stub), "missing-key");
}

TEST(RevoluteClearance, MaterialIsForBothSidesOrForEach) {
  ParameterStub stub = radii();
  stub.numbers["clearance.material.E"] = 207e9;
  EXPECT_EQ(fault(stub), "missing-key");
  stub.numbers["clearance.material.nu"] = 0.3;
  EXPECT_EQ(fault(stub), "");
  EXPECT_EQ(stub.pair.journal.youngs_modulus, 207e9);
  stub.numbers["clearance.material.bearing.E"] = 110e9;
  stub.numbers["clearance.material.bearing.nu"] = 0.34;
  EXPECT_EQ(fault(stub), "conflicting-keys");
  stub.numbers.erase("clearance.material.E");
  stub.numbers.erase("clearance.material.nu");
  EXPECT_EQ(fault(stub), "missing-key");
  stub.numbers["clearance.material.journal.E"] = 207e9;
  stub.numbers["clearance.material.journal.nu"] = 0.3;
  EXPECT_EQ(fault(stub), "");
  EXPECT_EQ(stub.pair.bearing.poisson_ratio, 0.34);
}

TEST(RevoluteClearance, EndOfContactClearsTheBristle) {
  Play play(with_bristle());
  play.touch(0.1);
  play.z[0] = 1e-5;
  play.b = planar_marker(c, 0.0, 0.0, -0.1);
  play.on_event(1, 1e-4);
  EXPECT_EQ(play.z[0], 0.0);
}

}  // namespace
}  // namespace freeplay::test
