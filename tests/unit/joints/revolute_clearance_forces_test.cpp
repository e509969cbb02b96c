#include <random>

#include "clearance_play.h"

namespace freeplay::test {
namespace {

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

}  // namespace
}  // namespace freeplay::test
