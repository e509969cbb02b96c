// Driven bodies: found where time alone places them, and the equations of the others are those of the whole mechanism.
#include "system/driven_bodies.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "base/index.h"
#include "stage/newton_stage_solver.h"
#include "validation/run_model.h"

namespace freeplay {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<std::string> driven_in(const std::string& text) {
  const auto model = test::load(text);
  std::vector<std::string> names;
  for (const planar::DrivenBody& one : planar::driven_bodies(*model)) names.push_back(model->bodies[at(one.body)].name);
  return names;
}

/// A crank on ground and what is said besides.
std::string crank(const std::string& bodies, const std::string& joints, const std::string& rest) {
  return "freeplay: 1\n"
         "bodies:\n"
         "  crank: {mass: 0.3, inertia: 1e-3, frames: {tip: [0.1, 0]}}\n" +
         bodies +
         "joints:\n"
         "  A: {type: revolute, between: [ground, crank]}\n" +
         joints + rest;
}
constexpr const char* motor = "drivers: {motor: {joint: A, kind: angle, value: 2*t}}\n";
constexpr const char* loose_rod = "  rod: {mass: 0.2, inertia: 1e-3, frames: {tip: [0.2, 0]}}\n";

TEST(DrivenBodies, AreThoseThatDriversAndWeldsPlace) {
  EXPECT_THAT(driven_in(crank("", "", motor)), ElementsAre("crank"));
  EXPECT_THAT(driven_in(crank(loose_rod, "  B: {type: revolute, between: [crank/tip, rod]}\n", motor)),
              ElementsAre("crank"));
  EXPECT_THAT(driven_in(crank(loose_rod, "  B: {type: fixed, between: [rod, crank/tip]}\n", motor)),
              ElementsAre("crank", "rod"));
  EXPECT_THAT(driven_in(crank(loose_rod, "  B: {type: prismatic, between: [rod, crank/tip]}\n",
                              "drivers: {motor: {joint: A, kind: velocity, value: 3}, feed: {joint: B, kind: position, "
                              "value: 0.1*t}}\n")),
              ElementsAre("crank", "rod"));
}

TEST(DrivenBodies, AreNotThoseThatMoveByThemselves) {
  EXPECT_THAT(driven_in(crank("", "", "")), IsEmpty());
  EXPECT_THAT(driven_in(crank("", "", "drivers: {motor: {joint: A, kind: torque, value: 2}}\n")), IsEmpty());
  EXPECT_THAT(driven_in(crank(loose_rod, "  B: {type: fixed, between: [rod, crank/tip]}\n", "")), IsEmpty());
}

TEST(DrivenBodies, AreNotThoseThatMoreThanOneHolds) {
  EXPECT_THAT(driven_in(crank("", "  again: {type: revolute, between: [ground, crank]}\n", motor)), IsEmpty());
  EXPECT_THAT(driven_in(crank(loose_rod,
                              "  B: {type: fixed, between: [rod, crank/tip]}\n"
                              "  C: {type: prismatic, between: [ground, rod]}\n",
                              motor)),
              ElementsAre("crank"));
}

TEST(DrivenBodies, AreNotThoseThatAGearTurns) {
  EXPECT_THAT(driven_in(crank("  wheel: {mass: 0.2, inertia: 1e-3}\n",
                              "  B: {type: revolute, between: [ground, wheel]}\n"
                              "  mesh: {type: gear, of: [A, B], ratio: -2}\n",
                              motor)),
              ElementsAre("crank"));
}

/// All ways to be driven, each end of each joint once, below bodies that are free: a rod by a pin, a puck by a slide
/// that turns, and a spring that pulls at driven bodies.
constexpr const char* everything = R"(freeplay: 1
gravity: [1, -9.81]
bodies:
  rod: {mass: 0.2, inertia: 1e-3, com: [0.1, 0.01], frames: {tip: [0.2, 0]}}
  crank: {mass: 0.3, inertia: 1e-3, com: [0.02, 0.01], frames: {tip: {position: [0.05, 0], angle: 20 deg}}}
  puck: {mass: 0.1, inertia: 2e-4, com: [0.01, 0.02]}
  plate: {mass: 0.15, inertia: 5e-4, com: [0.03, 0], frames: {side: {position: [0.04, 0.02], angle: -50 deg}}}
  second: {mass: 0.25, inertia: 1e-3, com: [0.05, 0], frames: {tip: [0.1, 0.01]}}
  table: {mass: 1, inertia: 1e-2, com: [0.1, -0.1], frames: {rail: {position: [0, 0.1], angle: 40 deg}}}
  wheel: {mass: 0.4, inertia: 2e-3, com: [0.01, 0], frames: {rim: {position: [0.06, 0], angle: 15 deg}}}
  carriage: {mass: 0.5, inertia: 1e-3, com: [0.02, 0.03], frames: {hub: [0.05, 0.05]}}
  tongue: {mass: 0.12, inertia: 3e-4, com: [0.01, 0.02]}
  ram: {mass: 0.22, inertia: 4e-4, com: [0.02, -0.01]}
joints:
  main: {type: revolute, between: [ground, crank]}
  weld: {type: fixed, between: [plate, crank/tip]}
  elbow: {type: revolute, between: [second, plate/side]}
  hang: {type: revolute, between: [second/tip, rod]}
  bed: {type: prismatic, between: [ground, table]}
  feed: {type: prismatic, between: [carriage, table/rail]}
  spindle: {type: revolute, between: [carriage/hub, wheel]}
  push: {type: prismatic, between: [tongue, crank/tip]}
  lift: {type: prismatic, between: [plate/side, ram]}
  groove: {type: prismatic, between: [wheel/rim, puck]}
  spring: {type: spring-damper, between: [rod/tip, wheel/rim], stiffness: 30, damping: 2}
drivers:
  one: {joint: main, kind: velocity, value: 7}
  two: {joint: elbow, kind: angle, value: 0.5*sin(4*t)}
  three: {joint: bed, kind: position, value: 0.3 + 0.1*sin(5*t)}
  four: {joint: feed, kind: position, value: 0.2*t + 0.05}
  five: {joint: spindle, kind: angle, value: 3*t^2 - 2*t}
  six: {joint: push, kind: position, value: 0.03 + 0.02*cos(6*t)}
  seven: {joint: lift, kind: position, value: 0.02 + 0.04*sin(3*t)}
initial: {joints: {hang: 30 deg, groove: 0.02}, speeds: {hang: 2, groove: -0.4}}
)";

class Reduced : public ::testing::Test {
 protected:
  Reduced() : model_(test::load(everything)), whole_(*model_), start_(assemble(whole_)) {
    free_.begin_at(whole_, start_.state, state_);
    state_.t() = 0.37;
    // The bodies that are left come along to this time.
    StateView view = state_.view();
    Evaluation& e = solver_.evaluation();
    solver_.use_history(state_.h());
    EXPECT_TRUE(solver_.project_position(view)) << solver_.trouble();
    EXPECT_TRUE(solver_.project_velocity(view)) << solver_.trouble();
    EXPECT_TRUE(solver_.accelerate(view, z_rate_)) << solver_.trouble();
    EXPECT_TRUE(free_.evaluate(point(state_), term_position | term_velocity | term_force, e_));
    free_.constraints().fill_driven(e_);
    free_.driven().recover_loads(e_, state_.lambda());
    EXPECT_EQ(e.fault.kind, Fault::Kind::none);
    // The same for the whole mechanism.
    all_ = start_.state;
    all_.t() = state_.t();
    for (int b = 0; b < static_cast<int>(model_->bodies.size()); ++b) {
      for (int i = 0; i < 3; ++i) {
        all_.q()[at(3 * b + i)] = e_.q[at(3 * free_.layout().place(b) + i)];
        all_.v()[at(3 * b + i)] = e_.v[at(3 * free_.layout().place(b) + i)];
      }
    }
    NewtonStageSolver solver(whole_, {});
    solver.use_history(all_.h());
    StateView whole_view = all_.view();
    EXPECT_TRUE(solver.accelerate(whole_view, z_rate_)) << solver.trouble();
  }

  std::unique_ptr<Model> model_;
  System whole_;
  Start start_;
  System free_{*model_, Variant::released, Unknowns::free_bodies};
  State state_{free_.layout(), 0}, all_;
  NewtonStageSolver solver_{free_, {}};
  Evaluation e_{free_};
  Span<double> z_rate_;
};

TEST_F(Reduced, BodiesThatAreLeftAreTheUnknowns) {
  EXPECT_EQ(free_.layout().nv(), 6);  // rod and puck
  EXPECT_EQ(free_.layout().nc(), 4);  // hang and groove
  EXPECT_EQ(free_.layout().all_rows(), whole_.layout().nc());
}

TEST_F(Reduced, EveryConstraintOfTheWholeHolds) {
  Evaluation e(whole_);
  ASSERT_TRUE(whole_.evaluate(point(all_), term_position | term_velocity, e));
  std::vector<double> rate(e.phi.size());
  whole_.jacobian().multiply(e.jacobian, all_.v(), rate);
  for (std::size_t r = 0; r < rate.size(); ++r) {
    EXPECT_NEAR(e.phi[r], 0.0, 1e-14) << r;
    EXPECT_NEAR(rate[r], e.nu[r], 1e-13) << r;
  }
}

TEST_F(Reduced, WhatIsCompletedLaterIsWhatAWholeLookGives) {
  Evaluation whole(free_), part(free_);
  ASSERT_TRUE(free_.evaluate(point(state_),
                             term_position | term_velocity | term_acceleration | term_force | term_coordinate, whole));
  ASSERT_TRUE(free_.evaluate(point(state_), term_position | term_force, part));
  free_.complete_rates(term_velocity, part);
  free_.complete_rates(term_acceleration, part);
  ASSERT_TRUE(free_.joints().evaluate_coordinates(point(state_), term_coordinate, part));
  EXPECT_EQ(part.nu, whole.nu);
  EXPECT_EQ(part.gamma, whole.gamma);
  EXPECT_EQ(part.coordinate, whole.coordinate);
  EXPECT_EQ(part.coordinate_rate, whole.coordinate_rate);
  for (std::size_t m = 0; m < whole.markers.size(); ++m) {
    const MarkerKinematics &a = part.markers[m], &b = whole.markers[m];
    EXPECT_TRUE(std::ranges::equal(a.position, b.position)) << m;
    EXPECT_TRUE(std::ranges::equal(a.rotation, b.rotation)) << m;
    EXPECT_TRUE(std::ranges::equal(a.velocity, b.velocity)) << m;
    EXPECT_TRUE(std::ranges::equal(a.angular_velocity, b.angular_velocity)) << m;
  }
}

TEST_F(Reduced, AfterVelocitiesAloneHaveChangedALookGivesWhatAFreshOneGives) {
  constexpr unsigned equations = term_position | term_velocity | term_acceleration | term_force | term_coordinate;
  for (const unsigned before : {equations, unsigned{term_position}}) {
    Evaluation again(free_), fresh(free_);
    ASSERT_TRUE(free_.evaluate(point(state_), before, again));
    State moved = state_;
    for (std::size_t i = 0; i < moved.v().size(); ++i) moved.v()[i] += 0.1 + 0.01 * static_cast<double>(i);
    for (int times = 0; times < 2; ++times) {
      ASSERT_TRUE(free_.evaluate(point(moved), equations, again));
      ASSERT_TRUE(free_.evaluate(point(moved), equations, fresh));
      EXPECT_EQ(again.phi, fresh.phi);
      EXPECT_EQ(again.jacobian, fresh.jacobian);
      EXPECT_EQ(again.nu, fresh.nu);
      EXPECT_EQ(again.gamma, fresh.gamma);
      EXPECT_EQ(again.force, fresh.force);
    }
    EXPECT_EQ(again.coordinate_rate, fresh.coordinate_rate);
    for (std::size_t m = 0; m < fresh.markers.size(); ++m) {
      EXPECT_TRUE(std::ranges::equal(again.markers[m].position, fresh.markers[m].position)) << m;
      EXPECT_TRUE(std::ranges::equal(again.markers[m].rotation, fresh.markers[m].rotation)) << m;
      EXPECT_TRUE(std::ranges::equal(again.markers[m].velocity, fresh.markers[m].velocity)) << m;
      EXPECT_TRUE(std::ranges::equal(again.markers[m].angular_velocity, fresh.markers[m].angular_velocity)) << m;
    }
  }
}

TEST_F(Reduced, AccelerationsAndLoadsAreThoseOfTheWhole) {
  const int first = free_.layout().free_bodies();
  for (int b = 0; b < static_cast<int>(model_->bodies.size()); ++b) {
    const int place = free_.layout().place(b);
    for (int i = 0; i < 3; ++i) {
      const double a = place < first ? state_.a()[at(3 * place + i)] : e_.driven_a[at(3 * (place - first) + i)];
      EXPECT_NEAR(a, all_.a()[at(3 * b + i)], 1e-11) << model_->bodies[at(b)].name << " " << i;
    }
  }
  for (int j = 0; j < static_cast<int>(model_->joints.size()); ++j) {
    const Slice here = free_.layout().rows(j), there = whole_.layout().rows(j);
    for (int i = 0; i < here.size; ++i) {
      EXPECT_NEAR(state_.lambda()[at(here.offset + i)], all_.lambda()[at(there.offset + i)], 1e-11)
          << model_->joints[at(j)].name << " " << i;
    }
  }
  for (int d = 0; d < static_cast<int>(model_->drivers.size()); ++d) {
    EXPECT_NEAR(state_.lambda()[at(free_.layout().driver_row(d))], all_.lambda()[at(whole_.layout().driver_row(d))],
                1e-11)
        << model_->drivers[at(d)].name;
  }
}

TEST_F(Reduced, ReactionsAreThoseOfTheWhole) {
  Evaluation e(whole_);
  ASSERT_TRUE(whole_.evaluate(point(all_), term_position | term_force, e));
  for (int j = 0; j < static_cast<int>(model_->joints.size()); ++j) {
    double here[6], there[6];
    free_.constraints().reaction(j, e_, state_.lambda(), here);
    whole_.constraints().reaction(j, e, all_.lambda(), there);
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(here[i], there[i], 1e-11) << model_->joints[at(j)].name << " " << i;
  }
}

TEST_F(Reduced, PowerThatDrivenBodiesGiveIsThatOfTheDrivers) {
  // Drivers give what the kinetic energy gains and gravity and the damper take.
  double given = 0.0, gained = 0.0;
  for (int d = 0; d < static_cast<int>(model_->drivers.size()); ++d) {
    given -= state_.lambda()[at(free_.layout().driver_row(d))] * e_.motion[at(d)].rate;
  }
  Evaluation e(whole_);
  ASSERT_TRUE(whole_.evaluate(point(all_), term_position | term_force, e));
  for (std::size_t i = 0; i < all_.v().size(); ++i) {
    gained += (whole_.inertia().mass()[i] * all_.a()[i] - e.force[i]) * all_.v()[i];
  }
  EXPECT_GT(std::abs(given), 1.0);
  EXPECT_NEAR(given, gained, 1e-11);
}

TEST_F(Reduced, ImpulsesAreThoseOfTheWhole) {
  // All drivers jump: what the whole takes for the change of its velocities, the loads of driven bodies take here.
  std::vector<double> change, impulse(at(free_.layout().all_rows()), 0.0);
  const int first = free_.layout().free_bodies();
  for (std::size_t i = at(3 * first); i < e_.v.size(); ++i) change.push_back(0.3 * e_.v[i]);
  for (int r = 0; r < free_.layout().nc(); ++r) impulse[at(r)] = 0.1 + 0.2 * r;
  const std::vector<double> given = impulse;
  free_.driven().recover_impulses(e_, change, impulse);
  for (int r = 0; r < free_.layout().nc(); ++r) EXPECT_EQ(impulse[at(r)], given[at(r)]);
  // On every driven body: M dv + Phi_q^T mu = 0, by Phi_q of the whole.
  Evaluation e(whole_);
  ASSERT_TRUE(whole_.evaluate(point(all_), term_position, e));
  std::vector<double> mu(at(whole_.layout().nc())), sum(all_.v().size(), 0.0);
  for (int j = 0; j < static_cast<int>(model_->joints.size()); ++j) {
    const Slice here = free_.layout().rows(j), there = whole_.layout().rows(j);
    for (int i = 0; i < here.size; ++i) mu[at(there.offset + i)] = impulse[at(here.offset + i)];
  }
  for (int d = 0; d < static_cast<int>(model_->drivers.size()); ++d) {
    mu[at(whole_.layout().driver_row(d))] = impulse[at(free_.layout().driver_row(d))];
  }
  whole_.jacobian().add_transposed(e.jacobian, mu, sum);
  for (int place = first; place < first + static_cast<int>(change.size()) / 3; ++place) {
    const int b = free_.layout().body_at(place);
    for (int i = 0; i < 3; ++i) {
      const double momentum = whole_.inertia().mass()[at(3 * b + i)] * change[at(3 * (place - first) + i)];
      EXPECT_NEAR(momentum + sum[at(3 * b + i)], 0.0, 1e-12) << model_->bodies[at(b)].name << " " << i;
    }
  }
}

TEST(DrivenBodies, KeepTheEnergyOfAWholeRun) {
  const test::ModelRun run(std::string(everything) +
                           "simulation: {end: 0.5, accuracy: 1e-9, integrator: dopri5, output: "
                           "{interval: 0.05}}\n");
  ASSERT_EQ(run.outcome().status, RunStatus::completed) << run.outcome().reason;
  EXPECT_GT(std::abs(run.last("energy.work")), 0.1);
  EXPECT_NEAR(run.last("energy.residual"), 0.0, 1e-8);
}

TEST(DrivenBodies, FixedStepsBookTheWorkOfABlowOnThem) {
  // 2 kg are brought to 1 m/s at once.
  const test::ModelRun run(
      "freeplay: 1\n"
      "bodies: {cart: {mass: 2, inertia: 1}}\n"
      "joints: {guide: {type: prismatic, between: [ground, cart]}}\n"
      "drivers: {motor: {joint: guide, kind: position, value: 'max(0, t - 0.3005)'}}\n"
      "simulation: {end: 1, step: 1 ms, integrator: bathe}\n");
  ASSERT_EQ(run.outcome().status, RunStatus::completed) << run.outcome().reason;
  EXPECT_NEAR(run.last("energy.work"), 1.0, 1e-12);
  EXPECT_NEAR(run.last("energy.residual"), 0.0, 1e-12);
}

}  // namespace
}  // namespace freeplay
