// What a joint loses as its history changes, in the account of energy: a spring that breaks or yields, and friction
// whose memory stores energy.
#include <cmath>
#include <string>

#include "freeplay/kit/planar_contacts.h"
#include "freeplay/kit/wall_play.h"
#include "validation/run_model.h"

namespace freeplay {
namespace {

using test::ModelRun;

/// A spring along x from the ground. `breaks` at the stretch `limit`, by an event, or its rest moves at the end of
/// steps so that the stretch is no more than that.
class WeakSpring final : public Joint {
 public:
  explicit WeakSpring(const Parameters& p)
      : stiffness_(p.number("stiffness")),
        limit_(p.number("limit")),
        breaks_(p.word("breaks") == 0),
        says_(p.word("says") == 0) {}
  void declare(JointLayout& layout) const override {
    layout.time_scale = unbounded;
    layout.forces = 1;
    layout.history = 1;  // where it is at rest
    if (breaks_) layout.events = events_;
  }
  void apply(const JointInput& in, JointForces& out) const override {
    const double force = stiffness_ * stretch(in, in.history[0]);
    out.wrench_b[0] = -force;
    out.wrench_a[0] = force;
    out.wrench_a[5] = -in.b->position[1] * force;
    out.potential = stored(stretch(in, in.history[0]));
    out.potential_rate = force * in.b->velocity[0];
  }
  void events(const JointInput& in, Span<double> g, Span<double> rate) const override {
    g[0] = stretch(in, in.history[0]) - limit_;
    rate[0] = in.b->velocity[0];
  }
  void on_event(int, const JointInput& in, Span<double>, Span<double> history, Span<double>) const override {
    lose(in, stretch(in, 0.0), history);
  }
  void commit(const JointInput& in, Span<const double>, Span<double> history) const override {
    const double more = stretch(in, history[0]) - limit_;
    if (!breaks_ && more > 0.0) lose(in, history[0] + more, history);
  }

 private:
  static constexpr Event events_[] = {{"breaks", Crossing::rising, 1, {}}};
  static double stretch(const JointInput& in, double rest) { return in.b->position[0] - in.a->position[0] - rest; }
  double stored(double by) const { return 0.5 * stiffness_ * by * by; }
  void lose(const JointInput& in, double rest, Span<double> history) const {
    if (says_) *in.dissipated += stored(stretch(in, history[0])) - stored(stretch(in, rest));
    history[0] = rest;
  }
  double stiffness_, limit_;
  bool breaks_, says_;
};

/// The ground below, for a point of b: one contact of the kit.
struct FlatGround {
  static constexpr std::size_t contacts = 1;
  template <class T>
  play::ContactPlace<T> place(const play::PlanarMotion<T>& m, std::size_t) const {
    return {-m.d.y, {T(0.0), T(-1.0)}, {T(0.0), T(0.0)}};
  }
  static std::array<double, 2> stand(const play::PlanarMotion<double>& m) { return {m.d.x, m.d.y}; }
  static constexpr bool between_walls() { return false; }
  double play = 1e-2;
};
class PointOnFloor final : public play::PlanarContacts<FlatGround> {
 public:
  explicit PointOnFloor(const Parameters& p)
      : PlanarContacts(
            {}, {p.contact_law("contact", play::at_wall(SurfaceShape::corner, 1e-2)), p.friction_law("friction")}) {}
  void declare(JointLayout& layout) const override {
    declare_contacts(layout);
    layout.clearance = 0.0;
    layout.events = events_;
    layout.event_roles = play::begin_and_end;
    layout.channels = channels_;
  }

 private:
  static constexpr Event events_[] = {{"contact_begin", Crossing::rising, 1, play::event_fields},
                                      {"contact_end", Crossing::falling, 1, play::event_fields}};
  static constexpr Channel channels_[] = {{"x", "m"},  {"y", "m"},     {"delta", "m"},   {"fn", "N"},
                                          {"ft", "N"}, {"power", "W"}, {"contact", "1"}, {"vt", "m/s"}};
};

/// F_T = -k z, z' = v, z = z_0 at the start: an elastic brush that never slips.
class Brush final : public FrictionLaw {
 public:
  explicit Brush(const Parameters& p)
      : stiffness_(p.number("stiffness")), start_(p.number("start")), kept_(p.word("reset") == 1) {}
  int internal_variables() const override { return 1; }
  void memory(Span<double> start, Span<MemoryReset> resets) const override {
    start[0] = start_;
    if (kept_) resets[0] = MemoryReset::never;
  }
  double stored(Span<const double> z, Span<double> slopes) const override {
    slopes[0] = kept_ ? 0.0 : stiffness_ * z[0];
    return kept_ ? 0.0 : 0.5 * stiffness_ * (z[0] * z[0] - start_ * start_);
  }
  FrictionForce evaluate(const FrictionState& s, Span<double> rate) const override {
    rate[0] = s.slip_speed;
    return {-stiffness_ * s.internal[0], 0.0, 0.0};
  }

 private:
  double stiffness_, start_;
  bool kept_;
};

const Registry& weak_types() {
  static constexpr Parameter spring[] = {
      {.name = "stiffness", .unit = "N/m"},
      {.name = "limit", .unit = "m"},
      {.name = "breaks", .kind = ParameterKind::choice, .default_value = 0, .choices = "by-event|by-step"},
      {.name = "says", .kind = ParameterKind::choice, .default_value = 0, .choices = "loss|nothing"}};
  static constexpr Parameter floor[] = {{.name = "contact", .kind = ParameterKind::contact_law},
                                        {.name = "friction", .kind = ParameterKind::friction_law}};
  static constexpr Parameter brush[] = {
      {.name = "stiffness", .unit = "N/m"},
      {.name = "start", .unit = "m", .default_value = 0.0},
      {.name = "reset", .kind = ParameterKind::choice, .default_value = 0, .choices = "each|never"}};
  static const Component components[] = {
      joint<WeakSpring>({.name = "weak-spring", .space = Space::planar, .parameters = spring}),
      joint<PointOnFloor>({.name = "floor", .space = Space::planar, .parameters = floor}),
      friction_law<Brush>({.name = "brush", .parameters = brush})};
  static const Registry registry = [] {
    Registry all = Registry::with_builtins();
    all.add([](const Host* host,
               Manifest* manifest) noexcept { return publish(*host, *manifest, "weak", "1", components); },
            "test");
    return all;
  }();
  return registry;
}

constexpr double puck_mass = 2.0, spring_stiffness = 800.0, spring_limit = 0.05, puck_speed = 1.5;

ModelRun run_spring(const std::string& keys, const std::string& settings) {
  return ModelRun(
      "freeplay: 1\nbodies: {puck: {mass: 2, inertia: 0.01, velocity: {linear: [1.5, 0]}}}\n"
      "joints: {spring: {type: weak-spring, between: [ground, puck], stiffness: 800, limit: 0.05, " +
          keys + "}}\nsimulation: {end: 80 ms, output: {interval: 1 ms}, " + settings + "}\n",
      {}, {}, weak_types());
}

// It has stored k limit^2/2 when it breaks: with every integrator, whether it carries the account along or not.
TEST(HistoryLoss, OfASpringThatBreaksIsWhatItStored) {
  const double lost = 0.5 * spring_stiffness * spring_limit * spring_limit;
  for (const char* settings :
       {"accuracy: 1e-8", "accuracy: 1e-8, integrator: dopri5", "accuracy: 1e-6, integrator: generalized-alpha"}) {
    const ModelRun run = run_spring("breaks: by-event", settings);
    ASSERT_EQ(run.outcome().exit_code, 0) << run.outcome().reason;
    EXPECT_EQ(run.at(0, "energy.dissipated"), 0.0);
    EXPECT_NEAR(run.last("energy.dissipated"), lost, 1e-6 * lost) << settings;
    EXPECT_NEAR(run.last("energy.residual"), 0.0, 1e-6 * lost) << settings;
    // x = v_0/w sin(w t), w^2 = k/m, and from the break on the same again with the speed that was left.
    const double w = std::sqrt(spring_stiffness / puck_mass), broke = std::asin(w * spring_limit / puck_speed) / w;
    const double left = std::sqrt(puck_speed * puck_speed - 2.0 * lost / puck_mass);
    EXPECT_NEAR(run.last("body.puck.x"), spring_limit + left / w * std::sin(w * (80e-3 - broke)), 1e-6) << settings;
    // Without its word the energy is missing.
    EXPECT_NEAR(run_spring("breaks: by-event, says: nothing", settings).last("energy.residual"), -lost, 1e-6 * lost);
  }
}

// Between steps its force is beyond the limit by the way of a step, so that the account errs by the first power
// of that.
TEST(HistoryLoss, OfASpringThatYieldsIsBookedStepByStep) {
  const auto residual = [](const char* step) {
    const ModelRun run = run_spring("breaks: by-step", step);
    EXPECT_EQ(run.outcome().exit_code, 0) << run.outcome().reason;
    // k limit (x - limit) of work beyond the limit is lost.
    const double expected = spring_stiffness * spring_limit * (run.last("body.puck.x") - spring_limit);
    EXPECT_NEAR(run.last("energy.dissipated"), expected, 0.02 * expected) << step;
    EXPECT_GT(expected, 0.5);
    return std::abs(run.last("energy.residual"));
  };
  const double coarse = residual("step: 0.1 ms"), fine = residual("step: 0.05 ms");
  EXPECT_LT(coarse, 0.02);
  EXPECT_NEAR(coarse / fine, 2.0, 0.2);
}

// A state that was saved after the loss goes on to the same bytes.
TEST(HistoryLoss, IsPartOfASavedState) {
  const std::string text =
      "freeplay: 1\nbodies: {puck: {mass: 2, inertia: 0.01, velocity: {linear: [1.5, 0]}}}\n"
      "joints: {spring: {type: weak-spring, between: [ground, puck], stiffness: 800, limit: 0.05, breaks: by-step}}\n"
      "simulation: {end: 0.05 s, output: {interval: 1 ms}, step: 0.1 ms}\n";
  const std::unique_ptr<Model> model = test::load(text, {}, weak_types());
  System system(*model);
  const Start start = assemble(system);
  const Channels channels(*model);
  test::RowKeeper all(*model, channels, {}), rest(*model, channels, {});
  Sink* const sinks[] = {&all};
  Simulation whole(system, start, channels, sinks);
  RunState saved;
  RunHooks hooks;
  hooks.stepped = [&] {
    if (saved.steps == 0 && all.rows() == 41) saved = whole.save();
  };
  ASSERT_EQ(whole.run(hooks).exit_code, 0);
  ASSERT_GT(saved.steps, 0);
  ASSERT_GT(all.at(40, "energy.dissipated"), 0.1);
  Sink* const others[] = {&rest};
  Simulation going_on(system, start, channels, others, saved);
  ASSERT_EQ(going_on.run({}).exit_code, 0);
  const std::span<const double> expected(all.numbers()), found(rest.numbers());
  ASSERT_EQ(found.size(), 10u * all.names().size());
  EXPECT_TRUE(std::ranges::equal(found, expected.last(found.size())));
}

ModelRun run_brush(const std::string& keys) {
  return ModelRun(
      "freeplay: 1\ngravity: [0, -9.81]\n"
      "bodies: {ball: {mass: 1, inertia: 0.01, pose: {position: [0, 1 mm]}, velocity: {linear: [1, -0.5]}}}\n"
      "joints: {floor: {type: floor, between: [ground, ball], contact: {law: hertz, K: 1e8},\n"
      "  friction: {law: brush, stiffness: 2e4" +
          keys + "}}}\nsimulation: {end: 0.15 s, accuracy: 1e-9, output: {interval: 0.05 ms}}\n",
      {}, {}, weak_types());
}

// While it touches the brush gives back; when it lets go it has k z^2/2, with z the way that it was drawn along.
TEST(FrictionMemory, LosesWhatItStoresWhenItsContactEnds) {
  const ModelRun run = run_brush("");
  ASSERT_EQ(run.outcome().exit_code, 0) << run.outcome().reason;
  double begin = 0.0, booked = 0.0;
  bool touched = false;
  int contacts = 0;
  for (std::size_t k = 0; k < run.rows(); ++k) {
    const bool touches = run.at(k, "joint.floor.contact") > 0.5;
    EXPECT_NEAR(run.at(k, "energy.residual"), 0.0, 1e-6);
    if (touches && !touched) begin = run.at(k, "body.ball.x");
    if (!touches && touched) {
      // The rows are 0.05 ms beside the events, of which the contact lasts 2 ms.
      const double drawn = run.at(k, "body.ball.x") - begin, here = 0.5 * 2e4 * drawn * drawn;
      ++contacts;
      EXPECT_NEAR(run.at(k, "energy.dissipated") - booked, here, 0.1 * here);
      EXPECT_GT(here, 1e-3);
      booked = run.at(k, "energy.dissipated");
    } else {
      EXPECT_NEAR(run.at(k, "energy.dissipated"), booked, 1e-7);
    }
    touched = touches;
  }
  EXPECT_GE(contacts, 1);
}

// Force at the first row of a contact: -k z_0 for one that begins anew each time, more where memory stays.
TEST(FrictionMemory, StartsWhereTheLawSaysAndIsResetAsItSays) {
  const auto first_forces = [](const ModelRun& run) {
    std::vector<double> forces;
    bool touched = false;
    for (std::size_t k = 0; k < run.rows(); ++k) {
      const bool touches = run.at(k, "joint.floor.fn") > 0.0;
      if (touches && !touched) forces.push_back(run.at(k, "joint.floor.ft"));
      touched = touches;
    }
    return forces;
  };
  // In the 0.05 ms to the first row it may be drawn 0.05 mm, 1 N; in a contact of 2.3 ms 2 mm, 40 N.
  const std::vector<double> zero = first_forces(run_brush("")), anew = first_forces(run_brush(", start: 0.4 mm")),
                            kept = first_forces(run_brush(", start: 0.4 mm, reset: never"));
  for (const auto* forces : {&zero, &anew, &kept}) ASSERT_EQ(forces->size(), 2u);
  EXPECT_NEAR(zero[0], 0.0, 1.1);
  EXPECT_NEAR(zero[1], 0.0, 1.1);
  EXPECT_NEAR(anew[0], -8.0, 1.1);
  EXPECT_NEAR(anew[1], -8.0, 1.1);
  EXPECT_NEAR(kept[0], -8.0, 1.1);
  EXPECT_LT(kept[1], -40.0);
}

}  // namespace
}  // namespace freeplay
