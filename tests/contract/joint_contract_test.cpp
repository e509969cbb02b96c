// The joint suite finds what is wrong with a joint, and nothing in one that is right.
#include "contract/joint_contract.h"

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

#include "allocation_counter.h"
#include "broken_joints.h"
#include "findings_text.h"

namespace freeplay::test {
namespace {

const Conditions joint_conditions{.seed = 3, .allocations = &allocations};

template <class J>
Findings judge(const J& joint, const J& twin) {
  return check_joint({handle(joint), handle(twin), Space::planar, true}, joint_conditions);
}

/// In space: the x axis of a stands at a right angle to the y axis of b, Phi = x_a.y_b.
class Square final : public Joint {
 public:
  explicit Square(double centripetal = 1.0) : centripetal_(centripetal) {}
  void declare(JointLayout& layout) const override { layout.constraint_rows = 1; }
  void constrain(const JointInput& in, ConstraintRows& rows) const override {
    const Eigen::Vector3d x = rotation(*in.a).col(0), y = rotation(*in.b).col(1);
    const Eigen::Vector3d wa = vector3(in.a->angular_velocity), wb = vector3(in.b->angular_velocity);
    rows.phi[0] = x.dot(y);
    Eigen::Map<Eigen::Vector3d>(rows.jacobian.data + 3) = x.cross(y);
    Eigen::Map<Eigen::Vector3d>(rows.jacobian.data + 9) = y.cross(x);
    rows.gamma[0] = -centripetal_ * (wa.cross(wa.cross(x)).dot(y) + x.dot(wb.cross(wb.cross(y)))) -
                    2.0 * wa.cross(x).dot(wb.cross(y));
  }

 private:
  double centripetal_;
};

TEST(JointContract, JudgesMotionInSpace) {
  const Square sound, flat(0.0);
  const auto findings = [](const Square& joint) {
    return check_joint({handle(joint), handle(joint), Space::spatial, true}, joint_conditions);
  };
  EXPECT_TRUE(findings(sound).held()) << broken_rules(findings(sound));
  EXPECT_TRUE(findings(flat).broken("gamma")) << broken_rules(findings(flat));
}

struct Case {
  Flaw flaw;
  const char* rule;
};

template <class J>
void expect_found(std::initializer_list<Case> cases) {
  for (const auto& [flaw, rule] : cases) {
    const J joint(flaw), twin(flaw);
    const Findings findings = judge(joint, twin);
    EXPECT_TRUE(findings.broken(rule)) << rule << " is not reported, but\n" << broken_rules(findings);
  }
}

TEST(JointContract, HoldsForSoundJoints) {
  EXPECT_TRUE(judge(Tether(), Tether()).held()) << broken_rules(judge(Tether(), Tether()));
  EXPECT_TRUE(judge(Swivel(), Swivel()).held()) << broken_rules(judge(Swivel(), Swivel()));
  EXPECT_TRUE(judge(Cage(), Cage()).held()) << broken_rules(judge(Cage(), Cage()));
  const Cage relaxing(Flaw::none, true);
  EXPECT_TRUE(judge(relaxing, relaxing).held()) << broken_rules(judge(relaxing, relaxing));
}

TEST(JointContract, GivesEqualFindingsForEqualSeeds) {
  const Cage cage(Flaw::derivative_entry);
  EXPECT_EQ(broken_rules(judge(cage, cage)), broken_rules(judge(cage, cage)));
}

TEST(JointContract, FindsWrongRows) {
  expect_found<Tether>({{Flaw::jacobian_entry, "jacobian"},
                        {Flaw::jacobian_lever, "jacobian"},
                        {Flaw::jacobian_lever, "constraint-balance"},
                        {Flaw::nu, "nu"},
                        {Flaw::gamma, "gamma"},
                        {Flaw::coordinate_row, "coordinate"},
                        {Flaw::coordinate_bias, "coordinate-bias"},
                        {Flaw::twice_the_same_row, "rows-independent"},
                        {Flaw::writes_beside_rows, "stays-in-span"},
                        {Flaw::negative_rows, "declares-sanely"}});
}

TEST(JointContract, FindsWrongPlaces) {
  expect_found<Swivel>({{Flaw::place_off_the_rows, "place"},
                        {Flaw::place_off_the_coordinate, "place"},
                        {Flaw::place_stretches, "place"}});
}

TEST(JointContract, FindsFaultsFarFromTheOrdinaryLong) {
  for (const Flaw flaw : {Flaw::wrong_when_turned, Flaw::wrong_when_turning, Flaw::wrong_when_fast,
                          Flaw::wrong_when_late, Flaw::wrong_when_far}) {
    const Swivel joint(flaw);
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const Findings findings = check_joint({handle(joint), handle(joint), Space::planar, true}, {.seed = seed});
      EXPECT_TRUE(findings.broken("jacobian")) << static_cast<int>(flaw) << " with seed " << seed;
    }
  }
}

TEST(JointContract, FindsAPinThatDoesNotHold) { expect_found<Tether>({{Flaw::no_pin, "pin"}}); }

TEST(JointContract, FindsRowsOtherThanDeclared) {
  expect_found<Swivel>({{Flaw::other_rows, "planar-rows"}, {Flaw::wrong_when_fast, "planar-rows"}});
  expect_found<Tether>({{Flaw::other_coordinate, "planar-rows"}});
}

TEST(JointContract, FindsADeclarationThatChanges) {
  expect_found<Swivel>({{Flaw::declares_in_turn, "declares-sanely"}});
}

/// A force at a right angle to the speed of b, which does no work: F_b = c z x v_b.
struct Powerless final : Joint {
  void declare(JointLayout& layout) const override { layout.forces = 1; }
  void apply(const JointInput& in, JointForces& out) const override {
    const Vector2 v = xy(in.b->velocity) - xy(in.a->velocity), force(-20.0 * v[1], 20.0 * v[0]);
    const Vector2 arm = xy(in.b->position) - xy(in.a->position);
    for (int i = 0; i < 2; ++i) {
      out.wrench_b[i] = force[i];
      out.wrench_a[i] = -force[i];
    }
    out.wrench_a[5] = arm[1] * force[0] - arm[0] * force[1];
  }
};

TEST(JointContract, DoesNotJudgeTheRoundingOfAForceWithoutPower) {
  const Powerless joint;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Findings findings = check_joint({handle(joint), handle(joint), Space::planar, true}, {.seed = seed});
    EXPECT_FALSE(findings.broken("energy-cycle")) << "seed " << seed << "\n" << broken_rules(findings);
  }
}

TEST(JointContract, FindsWrongForces) {
  expect_found<Cage>({{Flaw::no_reaction, "balance"},
                      {Flaw::no_moment, "balance"},
                      {Flaw::negative_damping, "energy"},
                      {Flaw::negative_damping, "energy-cycle"},
                      {Flaw::silent_potential, "energy"},
                      {Flaw::potential_rate, "potential-rate"},
                      {Flaw::derivative_entry, "derivatives"},
                      {Flaw::derivative_by_speed, "derivatives"},
                      {Flaw::force_with_derivatives, "unused-derivatives"},
                      {Flaw::undeclared_forces, "declares-sanely"}});
}

TEST(JointContract, FindsWrongInternalVariables) {
  const Cage slope(Flaw::derivative_by_z, true), push(Flaw::bristle_pushes, true);
  EXPECT_TRUE(judge(slope, slope).broken("derivatives")) << broken_rules(judge(slope, slope));
  EXPECT_TRUE(judge(push, push).broken("energy-cycle")) << broken_rules(judge(push, push));
}

TEST(JointContract, FindsHiddenState) {
  expect_found<Cage>(
      {{Flaw::counts_calls, "no-hidden-state"}, {Flaw::keeps_contact, "rollback"}, {Flaw::event_rate, "event-rate"}});
  const Cage soft(Flaw::none, false, 2e4), stiff(Flaw::none, false, 3e4);
  EXPECT_TRUE(judge(soft, stiff).broken("same-twin"));
}

/// A torsional spring that yields at a tenth of a radian when a step is accepted, and says so in part.
class Settling final : public Joint {
 public:
  explicit Settling(double said) : said_(said) {}
  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;
    layout.coordinate = Coordinate::angle;
    layout.history = layout.forces = 1;
  }
  void coordinate(const JointInput& in, CoordinateRow& row) const override { Swivel().coordinate(in, row); }
  void apply(const JointInput& in, JointForces& out) const override {
    const double bend = in.coordinate - in.history[0];
    out.wrench_a[5] = bend;
    out.wrench_b[5] = -bend;
    out.potential = 0.5 * bend * bend;
    out.potential_rate = bend * in.coordinate_rate;
  }
  void commit(const JointInput& in, Span<const double>, Span<double> history) const override {
    const double bend = in.coordinate - history[0], kept = std::clamp(bend, -0.1, 0.1);
    history[0] = in.coordinate - kept;
    *in.dissipated += said_ * 0.5 * (bend * bend - kept * kept);
  }

 private:
  double said_;
};

TEST(JointContract, FindsWhatCommitLosesInSilence) {
  const Settling sound(1.0), silent(0.0), wild(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(judge(sound, sound).held()) << broken_rules(judge(sound, sound));
  EXPECT_TRUE(judge(silent, silent).broken("history-loss")) << broken_rules(judge(silent, silent));
  EXPECT_TRUE(judge(wild, wild).broken("finite")) << broken_rules(judge(wild, wild));
}

TEST(JointContract, FindsWrongCalls) {
  expect_found<Cage>({{Flaw::not_a_number, "finite"},
                      {Flaw::throws, "answers"},
                      {Flaw::allocates, "allocation"},
                      {Flaw::writes_beside_rates, "stays-in-span"},
                      {Flaw::writes_beside_history, "stays-in-span"},
                      {Flaw::step_limit_zero, "step-limit"},
                      {Flaw::free_too_far, "free-distance"},
                      {Flaw::bounds_too_wide, "play-bounds"},
                      {Flaw::timed_force, "time-scale"},
                      {Flaw::earlier_corner, "next-corner"},
                      {Flaw::wandering_corner, "next-corner"},
                      {Flaw::offset_nowhere, "initial-offset"}});
}

/// What a joint says of its contact: distance of the origins along x, how hard they press, and events.
struct Roles {
  ChannelRole first = ChannelRole::eccentricity_x, second = ChannelRole::normal_force;
  const char* unit = "N";
  double pressed = 1.0, shift = 0.0, contact = 1.0;
  EventRole left = EventRole::contact_end;
};

/// A joint without forces that declares roles.
class Touching final : public Joint {
 public:
  explicit Touching(const Roles& roles)
      : roles_(roles),
        channels_{{"along", "m"}, {"press", roles.unit}, {"on", "1"}},
        channel_roles_{roles.first, roles.second, ChannelRole::in_contact},
        event_roles_{EventRole::contact_begin, roles.left} {}
  void declare(JointLayout& layout) const override {
    static constexpr Event events[] = {{"met", Crossing::rising, 0, {}}, {"left", Crossing::falling, 0, {}}};
    layout.events = events;
    layout.channels = channels_;
    layout.channel_roles = channel_roles_;
    layout.event_roles = event_roles_;
    layout.time_scale = unbounded;
  }
  void events(const JointInput& in, Span<double> g, Span<double> rate) const override {
    g[0] = g[1] = in.b->position[0] - in.a->position[0];
    rate[0] = rate[1] = in.b->velocity[0] - in.a->velocity[0];
  }
  void observe(const JointInput& in, Span<const double>, Span<double> channels) const override {
    channels[0] = in.b->position[0] - in.a->position[0] + roles_.shift;
    channels[1] = roles_.pressed;
    channels[2] = roles_.contact;
  }

 private:
  Roles roles_;
  Channel channels_[3];
  ChannelRole channel_roles_[3];
  EventRole event_roles_[2];
};

TEST(JointContract, FindsChannelsAndEventsThatAreNotWhatTheirRolesSay) {
  const auto findings = [](const Roles& roles) {
    const Touching joint(roles);
    return judge(joint, joint);
  };
  EXPECT_TRUE(findings({}).held()) << broken_rules(findings({}));
  const Roles wrong[] = {{.unit = "mN"},
                         {.second = ChannelRole::penetration},
                         {.pressed = -1.0},
                         {.shift = 1e-6},
                         {.first = ChannelRole::eccentricity_y},
                         {.contact = 0.5},
                         {.left = EventRole::none},
                         {.left = EventRole::contact_begin}};
  for (const Roles& roles : wrong) {
    EXPECT_TRUE(findings(roles).broken("roles")) << &roles - wrong << "\n" << broken_rules(findings(roles));
  }
  EXPECT_TRUE(findings({.second = ChannelRole::none, .pressed = -1.0}).held()) << "no role says nothing";
}

TEST(JointContract, LetsDrivenJointsBringEnergy) {
  const Cage cage(Flaw::negative_damping);
  const Findings findings = check_joint({handle(cage), handle(cage), Space::planar, false}, joint_conditions);
  EXPECT_FALSE(findings.broken("energy"));
  EXPECT_FALSE(findings.broken("energy-cycle"));
}

}  // namespace
}  // namespace freeplay::test
