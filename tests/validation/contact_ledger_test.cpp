// Impulses and losses of contacts, and what joints with play go through, against closed forms and balances.
#include "puck.h"

namespace freeplay::test {
namespace {

double sum_of(const BearingTable::Column& column) {
  double sum = 0.0;
  for (const double value : column) sum += value;
  return sum;
}

struct Impact {
  const char* name;
  const char* law;
  const char* integrator;
  const char* step;
  double tolerance;
};
class PuckImpact : public ::testing::TestWithParam<Impact> {};

// Nothing else acts: the impulse is the change of momentum, what is lost that of kinetic energy.
TEST_P(PuckImpact, ImpulseAndLossAreThoseOfMomentumAndEnergy) {
  const Impact& want = GetParam();
  Puck puck;
  puck.contact = want.law;
  puck.y = -0.09e-3;
  puck.vy = -0.1;
  puck.end = 1e-3;
  puck.integrator = want.integrator;
  const ModelRun run(replaced(puck.text(), "step: " + number(puck.step), want.step));
  const auto all = contacts(run);
  ASSERT_GE(all.size(), 1u);
  const Contact& first = all[0];
  ASSERT_TRUE(first.end.contact);
  const ContactRecord& record = *first.end.contact;
  const double before = first.begin.fields[speed], after = first.end.fields[speed];
  EXPECT_EQ(record.approach_speed, before);
  EXPECT_EQ(record.impact, 1.0);
  EXPECT_NEAR(record.begin, first.begin.time, 1e-15);
  const double impulse = 0.2 * (before + after), lost = 0.1 * (before * before - after * after);
  test::record("impulse_error", record.impulse / impulse - 1.0);
  test::record("loss_error", record.energy_lost / (0.1 * before * before) - lost / (0.1 * before * before));
  EXPECT_NEAR(record.impulse, impulse, want.tolerance * impulse);
  EXPECT_NEAR(record.energy_lost, lost, want.tolerance * 0.1 * before * before);
  EXPECT_EQ(record.tangential_impulse, 0.0);
}
void PrintTo(const Impact& impact, std::ostream* out) { *out << impact.name; }

// A contact of about 110 steps in fixed steps, of 20 to 60 where the error chooses them.
INSTANTIATE_TEST_SUITE_P(Laws, PuckImpact,
                         ::testing::Values(Impact{"hertz", "hertz", "bathe", "step: 1 us", 2e-4},
                                           Impact{"lankarani_nikravesh", "{law: lankarani-nikravesh, restitution: 0.8}",
                                                  "bathe", "step: 1 us", 5e-4},
                                           Impact{"jump_at_the_begin", "{law: kelvin-voigt, K: 1e8 N/m, D: 1e3 N*s/m}",
                                                  "bathe", "step: 1 us", 1e-2},
                                           Impact{"error_control", "{law: lankarani-nikravesh, restitution: 0.8}",
                                                  "dopri5", "accuracy: 1e-10", 5e-4}),
                         [](const auto& made) { return std::string(made.param.name); });

/// A puck that falls and bounces until it lies.
std::string bouncing(const std::string& step, double end = 0.05) {
  Puck puck;
  puck.contact = "{law: lankarani-nikravesh, restitution: 0.5}";
  puck.more = ", friction: {law: ambrosio, mu: 0.1, v0: 1e-4, v1: 1e-3}, length: 8 mm";
  puck.x = 0.02e-3;
  puck.vx = 0.02;
  puck.end = end;
  puck.sections = "gravity: [0, -9.81]\n";
  return replaced(puck.text(), "step: " + number(puck.step), step);
}

TEST(ContactLedger, ContactsLoseTogetherWhatTheAccountSays) {
  for (const char* step : {"step: 2 us", "step: 20 us", "accuracy: 1e-9"}) {
    // Up to the middle of a flight: what a contact has lost that goes on is not in the list.
    const auto bounces = contacts(ModelRun(bouncing(step)));
    ASSERT_GE(bounces.size(), 6u);
    const ModelRun run(bouncing(step, 0.5 * (bounces[4].end.time + bounces[5].begin.time)));
    double lost = 0.0;
    int ended = 0;
    for (const Event& event : run.events()) {
      if (!event.contact) continue;
      lost += event.contact->energy_lost;
      ++ended;
    }
    const double account = run.last("energy.dissipated");
    EXPECT_EQ(ended, 5) << step;
    EXPECT_NEAR(lost, account, 1e-12 * account) << step;
    EXPECT_EQ(run.statistics().joint(0).dissipated, account);
  }
}

// Of what contacts lost that end in the time that counts, or are on at its end, some is from before it.
TEST(ContactLedger, ContactsThatAreOnAtEitherEndOfTheTimeAreInItsBalance) {
  for (const char* step : {"step: 2 us", "step: 20 us", "accuracy: 1e-9"}) {
    const auto bounces = contacts(ModelRun(bouncing(step)));
    ASSERT_GE(bounces.size(), 6u);
    const auto inside = [&](std::size_t i) { return 0.6 * bounces[i].begin.time + 0.4 * bounces[i].end.time; };
    for (const bool discards : {false, true}) {
      std::string text = bouncing(step, inside(4));
      if (discards) text = replaced(text, "output: {", "output: {discard: " + number(inside(1)) + ", ");
      const ModelRun run(text);
      double ended = 0.0, open = 0.0, listed = 0.0;
      int open_contacts = 0;
      for (const Event& event : run.events()) {
        if (!event.contact) continue;
        listed += event.contact->energy_lost;
        if (event.time < (discards ? inside(1) : 0.0)) continue;
        (event.kind == "contact_open" ? open : ended) += event.contact->energy_lost;
        if (event.kind != "contact_open") continue;
        ++open_contacts;
        EXPECT_TRUE(std::isnan(event.contact->impact));
        EXPECT_GT(event.contact->impulse, 0.0);
        EXPECT_NEAR(event.contact->begin, bounces[4].begin.time, 1e-12);
      }
      const double account = run.last("energy.dissipated"), counted = run.statistics().joint(0).dissipated;
      const PlayFigures play = run.clearances().figures(0);
      EXPECT_EQ(open_contacts, 1) << step;
      EXPECT_GT(open, 0.0);
      EXPECT_NEAR(listed, account, 1e-12 * account) << step;
      EXPECT_EQ(play.carried_out, open);
      EXPECT_EQ(play.carried_in > 0.0, discards);
      EXPECT_NEAR(ended + play.carried_out - play.carried_in, counted, 1e-12 * account) << step;
    }
  }
}

TEST(ContactLedger, LastingContactIsNoImpact) {
  const ModelRun run(bouncing("step: 2 us"));
  const auto all = contacts(run);
  ASSERT_GE(all.size(), 3u);
  EXPECT_EQ(all[0].end.contact->impact, 1.0);
  const PlayFigures play = run.clearances().figures(0);
  EXPECT_GT(play.impacts, 2);
  EXPECT_GT(play.lasting, 0.2);
  EXPECT_NEAR(play.flight + play.impact + play.lasting, 1.0, 1e-15);
  EXPECT_NEAR(play.max_approach_speed, all[0].begin.fields[speed], 1e-15);
}

TEST(ClearanceStatistics, SectorsAddUpToTheJoint) {
  for (const char* step : {"step: 2 us", "accuracy: 1e-9"}) {
    const ModelRun run(bouncing(step));
    const PlayFigures play = run.clearances().figures(0);
    const BearingTable table = run.clearances().table(0);
    EXPECT_NEAR(sum_of(table.work), play.work, 1e-12 * play.work);
    EXPECT_NEAR(sum_of(table.sliding), play.sliding, 1e-12 * play.sliding);
    EXPECT_NEAR(sum_of(table.pv_mean), play.pv_mean, 1e-12 * play.pv_mean);
    EXPECT_NEAR(sum_of(table.impulse), play.mean_normal_force * 0.05, 1e-12);
    EXPECT_NEAR(sum_of(table.contact_time), (1.0 - play.flight) * 0.05, 1e-14);
    EXPECT_EQ(*std::ranges::max_element(table.pv_max), play.pv_max);
  }
}

// A journal of 0.2 kg lies in a bearing that is turned by 30 degrees and turns with 10 rad/s without friction: slip is
// R_J w, the load m g straight down, which in the axes of the bearing is at -120 degrees.
TEST(ClearanceStatistics, JournalThatTurnsAtRestHasTheFiguresOfItsLoad) {
  const ModelRun run(
      "freeplay: 1\ngravity: [0, -9.81]\n"
      "bodies: {ground: {frames: {ring: {position: [0, 0], angle: 30 deg}}}, shaft: {mass: 0.2, inertia: 1e-4}}\n"
      "joints: {pin: {type: revolute, between: [ground/ring, shaft], clearance: {bearing_radius: 5 mm, "
      "radial_clearance: 0.1 mm, length: 8 mm, material: {E: 207 GPa, nu: 0.3}, contact: hertz, initial: loaded}}}\n"
      "initial: {speeds: {pin: 10 rad/s}}\n"
      "simulation: {end: 10 ms, step: 10 us, integrator: bathe, output: {interval: 1 ms, discard: 2 ms}}\n");
  const double load = 0.2 * 9.81, slip = 4.9e-3 * 10.0, time = 8e-3, pressure = load / (2.0 * 5e-3 * 8e-3);
  const PlayFigures play = run.clearances().figures(0);
  constexpr double rounding_of_steps = 1e-13;  // of the sum of a thousand of them
  EXPECT_NEAR(play.flight, 0.0, rounding_of_steps);
  EXPECT_NEAR(play.impact, 0.0, 1e-15);
  EXPECT_NEAR(play.lasting, 1.0, rounding_of_steps);
  EXPECT_EQ(play.impacts, 0);
  EXPECT_TRUE(std::isnan(play.max_approach_speed));
  EXPECT_NEAR(play.mean_normal_force, load, 1e-9 * load);
  EXPECT_NEAR(play.load_angle, -2.0 * M_PI / 3.0, 1e-9);
  EXPECT_NEAR(play.load_concentration, 1.0, 1e-12);
  EXPECT_NEAR(play.sliding, slip * time, 1e-9 * slip * time);
  EXPECT_NEAR(play.work, load * slip * time, 1e-9 * load * slip * time);
  EXPECT_NEAR(play.pv_mean, pressure * slip, 1e-9 * pressure * slip);
  EXPECT_NEAR(play.pv_max, pressure * slip, 1e-9 * pressure * slip);
  const BearingTable table = run.clearances().table(0);
  EXPECT_NEAR(table.work[47] + table.work[48], play.work, 1e-12 * play.work);  // 240 degrees is their border
  EXPECT_NEAR(run.last("joint.pin.vt"), slip, 1e-9 * slip);
}

// A ball of 0.2 kg lies where gravity presses it: in the axes of its socket, which is turned by 90 degrees about z, at
// (-4, 3, -12)/13. It turns with 10 rad/s about z without friction: slip is R_J w 5/13.
TEST(ClearanceStatistics, BallThatTurnsAtRestHasTheFiguresOfItsLoad) {
  const ModelRun run(
      "freeplay: 1\nspace: spatial\ngravity: [-3, -4, -12]\n"
      "bodies: {ground: {frames: {cup: {position: [0, 0, 0], rpy: [0, 0, 90 deg]}}}, ball: {mass: 0.2, inertia: [1e-4, "
      "1e-4, 1e-4], velocity: {angular: [0, 0, 10]}}}\n"
      "joints: {eye: {type: spherical, between: [ground/cup, ball], clearance: {bearing_radius: 5 mm, "
      "radial_clearance: 0.1 mm, contact: {law: hertz, K: 1e9}, initial: loaded}}}\n"
      "simulation: {end: 10 ms, step: 10 us, integrator: bathe, output: {interval: 1 ms, discard: 2 ms}}\n");
  const double load = 0.2 * 13.0, slip = 4.9e-3 * 10.0 * 5.0 / 13.0, time = 8e-3;
  const PlayFigures play = run.clearances().figures(0);
  EXPECT_NEAR(play.mean_normal_force, load, 1e-6 * load);
  EXPECT_NEAR(play.load_angle, std::atan2(3.0, -4.0), 1e-6);
  EXPECT_NEAR(play.load_concentration, 1.0, 1e-12);
  EXPECT_NEAR(play.load_elevation, std::atan2(-12.0, 5.0), 1e-6);
  EXPECT_NEAR(play.work, load * slip * time, 1e-5 * load * slip * time);
  ASSERT_TRUE(run.clearances().has_table(0));
  const BearingTable table = run.clearances().table(0);
  EXPECT_NEAR(table.work[28], play.work, 1e-12 * play.work);  // 140 to 145 degrees
  EXPECT_EQ(sum_of(table.work), table.work[28]);
}

}  // namespace
}  // namespace freeplay::test
