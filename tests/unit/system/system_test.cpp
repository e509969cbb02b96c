#include "system/system.h"

#include <cmath>
#include <functional>
#include <random>

#include "validation/run_model.h"

namespace freeplay {
namespace {

struct Case {
  const char* model;
  Variant variant;
};
void PrintTo(const Case& what, std::ostream* out) {
  *out << what.model << (what.variant == Variant::closed ? ", closed" : ", released");
}

/// A model off its constraints, moving as it likes: equations must be exact there too.
class Equations : public ::testing::TestWithParam<Case> {
 protected:
  Equations()
      : model_(test::load(test::mechanism(GetParam().model))),
        released_(*model_),
        start_(assemble(released_)),
        system_(*model_, GetParam().variant),
        q_(start_.state.q().begin(), start_.state.q().end()),
        v_(q_.size()),
        z_(static_cast<std::size_t>(system_.layout().nz())),
        h_(static_cast<std::size_t>(system_.layout().nh())) {
    system_.share_motions(released_);
    std::mt19937 engine(7);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (double& x : q_) x += 0.02 * uniform(engine);
    for (double& x : v_) x = 2.0 * uniform(engine);
    // Angles are counted from where the joints stand.
    Evaluation e(system_);
    EXPECT_TRUE(system_.evaluate(at(0.0), term_coordinate, e));
    for (int j = 0; j < static_cast<int>(model_->joints.size()); ++j) {
      if (const int turn = system_.layout().turn(j); turn >= 0) {
        h_[static_cast<std::size_t>(turn)] = e.coordinate[static_cast<std::size_t>(j)];
      }
    }
  }

  Point at(double s) {
    moved_ = q_;
    for (std::size_t i = 0; i < q_.size(); ++i) moved_[i] += s * v_[i];
    return {time_ + s, moved_, v_, z_, h_};
  }
  /// d/ds at s = 0 of a vector, difference of fourth order.
  static std::vector<double> slope(double width, const std::function<std::vector<double>(double)>& f) {
    const auto a = f(-2.0 * width), b = f(-width), c = f(width), d = f(2.0 * width);
    std::vector<double> out(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) out[i] = (8.0 * (c[i] - b[i]) - (d[i] - a[i])) / (12.0 * width);
    return out;
  }
  std::vector<double> phi(const Point& point) {
    Evaluation e(system_);
    EXPECT_TRUE(system_.evaluate(point, term_position, e));
    return e.phi;
  }
  void dense_jacobian(const Evaluation& e, std::vector<double>& out) const {
    std::vector<SparseEntry> entries;
    system_.jacobian().list(e.jacobian, entries);
    for (const SparseEntry& entry : entries) {
      out[static_cast<std::size_t>(entry.row()) * q_.size() + static_cast<std::size_t>(entry.col())] += entry.value();
    }
  }
  /// Phi_q v - nu.
  std::vector<double> phi_rate(const Point& point) {
    Evaluation e(system_);
    EXPECT_TRUE(system_.evaluate(point, term_position | term_velocity, e));
    std::vector<double> rate(e.phi.size());
    system_.jacobian().multiply(e.jacobian, point.v, rate);
    for (std::size_t i = 0; i < rate.size(); ++i) rate[i] -= e.nu[i];
    return rate;
  }

  std::unique_ptr<Model> model_;
  System released_;
  Start start_;
  System system_;
  std::vector<double> q_, v_, z_, h_, moved_;
  double time_ = 0.0123;
};

// Differences of fourth order over 1e-4: rounding of 1e-16 divided by 1e-4, and (1e-4)^4 of the fifth derivative.
constexpr double difference_error = 1e-9;

TEST_P(Equations, JacobianIsTheDerivativeOfTheConstraints) {
  Evaluation e(system_);
  ASSERT_TRUE(system_.evaluate(at(0.0), term_position, e));
  const std::size_t nc = e.phi.size(), nv = q_.size();
  std::vector<double> jacobian(nc * nv);
  dense_jacobian(e, jacobian);
  double worst = 0.0;
  for (std::size_t k = 0; k < nv; ++k) {
    const auto column = slope(1e-4, [&](double s) {
      std::vector<double> q = q_;
      q[k] += s;
      return phi({time_, q, v_, z_, h_});
    });
    for (std::size_t r = 0; r < nc; ++r) worst = std::max(worst, std::abs(jacobian[r * nv + k] - column[r]));
  }
  test::record("worst_difference", worst);
  EXPECT_LE(worst, difference_error);
}

TEST_P(Equations, TransposedProductIsThatOfTheDenseJacobian) {
  Evaluation e(system_);
  ASSERT_TRUE(system_.evaluate(at(0.0), term_position, e));
  const std::size_t nc = e.phi.size(), nv = q_.size();
  std::vector<double> jacobian(nc * nv), lambda(nc), sum(nv, 0.0), want(nv, 0.0);
  dense_jacobian(e, jacobian);
  for (std::size_t r = 0; r < nc; ++r) lambda[r] = 1.0 + 0.3 * static_cast<double>(r);
  for (std::size_t r = 0; r < nc; ++r) {
    for (std::size_t k = 0; k < nv; ++k) want[k] += jacobian[r * nv + k] * lambda[r];
  }
  system_.jacobian().add_transposed(e.jacobian, lambda, sum);
  for (std::size_t k = 0; k < nv; ++k) EXPECT_NEAR(sum[k], want[k], 1e-13 * (1.0 + std::abs(want[k])));
}

TEST_P(Equations, NuIsWhatTimeMovesInTheConstraints) {
  const auto along = slope(1e-5, [&](double s) { return phi(at(s)); });
  const auto rate = phi_rate(at(0.0));
  double worst = 0.0, scale = 1.0;
  for (std::size_t r = 0; r < rate.size(); ++r) {
    worst = std::max(worst, std::abs(rate[r] - along[r]));
    scale = std::max(scale, std::abs(rate[r]));
  }
  test::record("worst_difference", worst);
  EXPECT_LE(worst, difference_error * scale);  // the slider-crank turns at 500 rad/s
}

TEST_P(Equations, GammaIsTheBiasOfTheAccelerations) {
  Evaluation e(system_);
  ASSERT_TRUE(system_.evaluate(at(0.0), term_position | term_velocity | term_acceleration, e));
  const auto along = slope(1e-4, [&](double s) { return phi_rate(at(s)); });
  double worst = 0.0, scale = 1.0;
  for (std::size_t r = 0; r < along.size(); ++r) {
    worst = std::max(worst, std::abs(-e.gamma[r] - along[r]));
    scale = std::max(scale, std::abs(e.gamma[r]));
  }
  test::record("worst_difference", worst);
  EXPECT_LE(worst, difference_error * scale);
}

INSTANTIATE_TEST_SUITE_P(Models, Equations,
                         ::testing::Values(Case{"pendulum", Variant::released}, Case{"four-bar", Variant::released},
                                           Case{"slider-crank", Variant::released},
                                           Case{"slider-crank", Variant::closed}, Case{"3-rrr", Variant::released},
                                           Case{"3-rrr", Variant::closed}, Case{"4-rrr", Variant::released},
                                           Case{"4-rrr", Variant::closed}));

// --- forces ----------------------------------------------------------------------------------------------------------

/// Two bodies that touch, each away from its centre of mass, turning and sliding.
constexpr const char* touching =
    "freeplay: 1\ngravity: [0, -9.81]\n"
    "bodies:\n"
    "  ring: {mass: 0.3, inertia: 1e-3, com: [0.02, 0.01]}\n"
    "  shaft: {mass: 0.2, inertia: 2e-3, com: [-0.03, 0.015]}\n"
    "joints:\n"
    "  pin:\n"
    "    type: revolute\n"
    "    between: [ring, shaft]\n"
    "    clearance: {bearing_radius: 20 mm, radial_clearance: 2 mm, contact: {law: lankarani-nikravesh, K: 1e6,\n"
    "      restitution: 0.7}, friction: {law: ambrosio, mu: 0.2, v0: 0.01, v1: 1}}\n";

TEST(ForceDerivatives, OfAJointInContactAreThoseOfTheForces) {
  const auto model = test::load(touching);
  System system(*model);
  const Start start = assemble(system);
  std::vector<double> q(start.state.q().begin(), start.state.q().end()), v(6);
  std::vector<double> h(start.state.h().begin(), start.state.h().end());
  q[2] += 0.3;
  q[3] += 2.4e-3 - 0.03 * (std::cos(0.4) - 1.0);
  q[4] += 1.9e-3;
  q[5] += 0.4;
  const double speeds[] = {0.1, -0.2, 5.0, 0.25, 0.05, -3.0};
  std::copy(std::begin(speeds), std::end(speeds), v.begin());
  Evaluation e(system);
  const auto force = [&](const std::vector<double>& at_q, const std::vector<double>& at_v) {
    EXPECT_TRUE(system.evaluate({0.0, at_q, at_v, {}, h}, term_force, e));
    return e.force;
  };
  ASSERT_TRUE(system.evaluate({0.0, q, v, {}, h}, term_force | term_derivative, e));
  const std::vector<double> by_q = e.force_q, by_v = e.force_v;
  const JointInput in = system.joints().input(0, {0.0, q, v, {}, h}, e);
  ASSERT_GT(std::hypot(in.b->position[0] - in.a->position[0], in.b->position[1] - in.a->position[1]), 2.2e-3);

  double worst = 0.0;
  for (const bool position : {true, false}) {
    const std::vector<double>& table = position ? by_q : by_v;
    double largest = 0.0;
    for (const double x : table) largest = std::max(largest, std::abs(x));
    for (std::size_t k = 0; k < 6; ++k) {
      const double width = position ? 1e-7 : 1e-6;
      auto low_q = q, high_q = q, low_v = v, high_v = v;
      (position ? low_q : low_v)[k] -= width;
      (position ? high_q : high_v)[k] += width;
      const auto low = force(low_q, low_v), high = force(high_q, high_v);
      for (std::size_t r = 0; r < 6; ++r) {
        worst = std::max(worst, std::abs((high[r] - low[r]) / (2.0 * width) - table[r * 6 + k]) / largest);
      }
    }
  }
  test::record("worst_of_largest", worst);
  EXPECT_LE(worst, 1e-7);  // central differences: rounding 1e-16 of forces of 100 N over 1e-7 m, against 1e5 N/m
}

// --- forces by formulas of the motion --------------------------------------------------------------------------------

/// Largest difference of the derivatives of all forces from central differences, in parts of the largest.
double worst_derivative(const System& system, const std::vector<double>& q, const std::vector<double>& v) {
  const std::size_t nv = v.size(), width = static_cast<std::size_t>(system.layout().body_velocities());
  const std::vector<double> h(static_cast<std::size_t>(system.layout().nh()));
  const auto force = [&](const std::vector<double>& at_q, const std::vector<double>& at_v) {
    Evaluation e(system);
    EXPECT_TRUE(system.evaluate({0.3, at_q, at_v, {}, h}, term_force, e));
    return e.force;
  };
  Evaluation e(system);
  EXPECT_TRUE(system.evaluate({0.3, q, v, {}, h}, term_force | term_derivative, e));
  double worst = 0.0;
  for (const bool position : {true, false}) {
    const std::vector<double>& given = position ? e.force_q : e.force_v;
    std::vector<double> table(nv * nv);
    for (std::size_t p = 0; p < system.forces().pairs().size(); ++p) {
      const BodyId bodies[2] = {system.forces().pairs()[p].a, system.forces().pairs()[p].b};
      for (std::size_t r = 0; r < 2 * width; ++r) {
        for (std::size_t c = 0; c < 2 * width; ++c) {
          const BodyId row = bodies[r / width], column = bodies[c / width];
          if (row == ground || column == ground) continue;
          const std::size_t at = (width * static_cast<std::size_t>(row) + r % width) * nv +
                                 width * static_cast<std::size_t>(column) + c % width;
          table[at] += given[4 * width * width * p + 2 * width * r + c];
        }
      }
    }
    double largest = 0.0;
    for (const double x : table) largest = std::max(largest, std::abs(x));
    EXPECT_GT(largest, 0.0);
    for (std::size_t k = 0; k < nv; ++k) {
      constexpr double step = 1e-5;
      std::vector<double> change(nv), low_q = q, high_q = q, low_v = v, high_v = v;
      change[k] = position ? step : 0.0;
      system.coordinates().retract(q, change, high_q);
      change[k] = -change[k];
      system.coordinates().retract(q, change, low_q);
      (position ? low_q : low_v)[position ? 0 : k] -= position ? 0.0 : step;
      (position ? high_q : high_v)[position ? 0 : k] += position ? 0.0 : step;
      const auto low = force(low_q, low_v), high = force(high_q, high_v);
      for (std::size_t r = 0; r < nv; ++r) {
        worst = std::max(worst, std::abs((high[r] - low[r]) / (2.0 * step) - table[r * nv + k]) / largest);
      }
    }
  }
  return worst;
}

TEST(ForceDerivatives, OfFormulasOfTheMotionAreThoseOfTheForces) {
  const auto model = test::load(
      "freeplay: 1\n"
      "bodies:\n"
      "  a: {mass: 1, inertia: 1, com: [0.1, 0.2], frames: {tip: {position: [0.5, 0.3], angle: 0.4}}}\n"
      "  b: {mass: 1, inertia: 1, frames: {end: [-0.2, 0.7]}}\n"
      "  c: {mass: 1, inertia: 1}\n"
      "joints: {pin: {type: revolute, between: [b, c]}}\n"
      "forces:\n"
      "  along: {type: force, at: a/tip, axes: frame,\n"
      "    value: [\"2 N*s/m*frame.b/end.vx*frame.tip.x/1 m\", \"1 N*joint.pin.angle*sin(body.a.angle)\"]}\n"
      "  across: {type: force, at: a/tip, value: [\"3 N*s*body.c.omega*joint.pin.angle\", \"4 "
      "N*s/m*frame.a/tip.vy\"]}\n"
      "  turn: {type: torque, on: b, value: \"-2 N*m*s*joint.pin.speed*body.c.y/1 m\"}\n"
      "drivers: {motor: {joint: pin, kind: torque, value: \"2 N*body.a.x - 1 N*m*s*joint.pin.speed\"}}\n");
  const System system(*model);
  EXPECT_LE(worst_derivative(system, {0.1, 0.2, 0.3, -0.4, 0.5, 0.6, 0.7, -0.8, 0.9},
                             {1.0, 2.0, 3.0, -4.0, 5.0, 6.0, 7.0, -8.0, 9.0}),
            1e-8);
}

TEST(ForceDerivatives, OfFormulasOfTheMotionInSpaceAreThoseOfTheForces) {
  const auto model = test::load(
      "freeplay: 1\nspace: spatial\n"
      "bodies:\n"
      "  a: {mass: 1, inertia: [1, 1, 1], com: [0.1, 0.2, 0.3], frames: {tip: [0.5, 0.3, -0.2]}}\n"
      "  b: {mass: 1, inertia: [1, 1, 1], frames: {end: [-0.2, 0.7, 0.4]}}\n"
      "forces:\n"
      "  along: {type: force, at: a/tip, axes: frame,\n"
      "    value: [\"2 N*s/m*frame.b/end.vx*frame.tip.z/1 m\", \"1 N*s*body.b.wy\", \"3 N/m*frame.b/end.y\"]}\n"
      "  turn: {type: torque, on: b, value: [\"-2 N*s*frame.tip.vz\", 0, \"body.a.wx*1 N*m*s*frame.tip.x/1 m\"]}\n");
  const System system(*model);
  const double u = std::sqrt(0.5);
  EXPECT_LE(worst_derivative(system, {0.1, 0.2, 0.3, u, 0.0, u, 0.0, -0.4, 0.5, 0.6, 0.5, 0.5, -0.5, 0.5},
                             {1.0, 2.0, 3.0, -4.0, 5.0, 6.0, 7.0, -8.0, 9.0, -1.0, -2.0, 4.0}),
            1e-8);
}

TEST(ForcePair, OfAJointInContactHasNoResultant) {
  const auto model = test::load(test::replaced(touching, "gravity: [0, -9.81]\n", ""));
  System system(*model);
  const Start start = assemble(system);
  std::vector<double> q(start.state.q().begin(), start.state.q().end()), v{0.1, -0.2, 5.0, 0.25, 0.05, -3.0};
  q[3] += 3e-3;
  Evaluation e(system);
  ASSERT_TRUE(system.evaluate({0.0, q, v, {}, start.state.h()}, term_force, e));
  ASSERT_GT(std::abs(e.force[0]), 10.0);
  EXPECT_NEAR(e.force[0] + e.force[3], 0.0, 1e-12);
  EXPECT_NEAR(e.force[1] + e.force[4], 0.0, 1e-12);
  // About the origin: the moments about the centres of mass and those of the forces.
  double moment = 0.0;
  for (std::size_t b = 0; b < 2; ++b) {
    moment += e.force[3 * b + 2] + q[3 * b] * e.force[3 * b + 1] - q[3 * b + 1] * e.force[3 * b];
  }
  EXPECT_NEAR(moment, 0.0, 1e-12);
}

}  // namespace
}  // namespace freeplay
