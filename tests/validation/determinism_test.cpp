#include <cstring>

#include "freeplay/plugin.h"
#include "puck.h"

namespace freeplay::test {
namespace {

/// Rows and events alike to the last bit, NaN included.
void expect_same_bits(const ModelRun& a, const ModelRun& b) {
  const auto same = [](const std::vector<double>& x, const std::vector<double>& y) {
    return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(double)) == 0;
  };
  EXPECT_TRUE(same(a.kept().numbers(), b.kept().numbers()));
  ASSERT_EQ(a.events().size(), b.events().size());
  for (std::size_t i = 0; i < a.events().size(); ++i) {
    EXPECT_EQ(a.events()[i].time, b.events()[i].time);
    EXPECT_EQ(a.events()[i].joint, b.events()[i].joint);
    EXPECT_TRUE(same(a.events()[i].fields, b.events()[i].fields));
  }
}

struct Repeated {
  const char* model;
  double end, step;
};
class RepeatedRun : public ::testing::TestWithParam<Repeated> {};

TEST_P(RepeatedRun, GivesTheSameBits) {
  const Repeated& what = GetParam();
  const BuildOptions options{.set = {}, .ideal = {}, .end = what.end, .step = what.step, .integrator = {}};
  const ModelRun first(mechanism(what.model), options), second(mechanism(what.model), options);
  ASSERT_GT(first.rows(), 1u);
  EXPECT_EQ(first.events().empty(), first.model().clearance_joints() == 0);
  expect_same_bits(first, second);
}
void PrintTo(const Repeated& what, std::ostream* out) { *out << what.model; }
INSTANTIATE_TEST_SUITE_P(Models, RepeatedRun,
                         ::testing::Values(Repeated{"3-rrr", 8e-3, 2e-6}, Repeated{"4-rrr", 8e-3, 2e-6},
                                           Repeated{"slider-crank", 1e-3, 1e-6}, Repeated{"pendulum", 2.0, 1e-3},
                                           Repeated{"four-bar", 2.0, 1e-3}));

// --- rejected attempts -----------------------------------------------------------------------------------------------

/// Implicit Euler. Longer steps than `longest` are refused after the attempt has written nonsense over the state.
class Refusing final : public Integrator {
 public:
  explicit Refusing(const Parameters& p) : longest_(p.number("longest")) {}
  void declare(IntegratorLayout& layout) const override {
    layout.scratch = layout.sizes.nq + 2 * layout.sizes.nv + layout.sizes.nz;
    layout.memory = 3;
  }
  void restart(StateView& state, StageSolver&) const override {
    for (std::size_t i = 0; i < 3; ++i) state.memory[i] = 1.0 / static_cast<double>(i + 1);
  }
  Attempt attempt(double dt, StateView& to, Span<double> scratch, StageSolver& solver) const override {
    if (dt > longest_) {
      const double nonsense = std::numeric_limits<double>::quiet_NaN();
      *to.t = nonsense;
      for (Span<double>* all : {&to.q, &to.v, &to.a, &to.lambda, &to.z, &to.memory}) {
        std::fill(all->begin(), all->end(), nonsense);
      }
      return {.converged = 0, .error = 0.0};
    }
    // What the memory holds must have survived: its sum, 11/6, enters the step in a way that shows.
    const double one = to.memory[0] + to.memory[1] + to.memory[2] - 5.0 / 6.0;
    const std::size_t nq = to.q.size, nv = to.v.size;
    Span<double> q = scratch.part(0, nq), v = scratch.part(nq, nv), increment = scratch.part(nq + nv, nv);
    Span<double> z = scratch.part(nq + 2 * nv, to.z.size);
    std::copy(to.q.begin(), to.q.end(), q.begin());
    std::copy(to.v.begin(), to.v.end(), v.begin());
    std::copy(to.z.begin(), to.z.end(), z.begin());
    for (std::size_t i = 0; i < nv; ++i) increment[i] = dt * one * v[i];
    const Stage stage{.t = *to.t + dt,
                      .q_base = q,
                      .increment_known = increment,
                      .v_known = v,
                      .z_known = z,
                      .beta_q = dt * dt,
                      .beta_v = dt,
                      .beta_z = dt,
                      .level = ConstraintLevel::position};
    if (solver.solve(stage, to).converged == 0) return {.converged = 0, .error = 0.0};
    solver.project_velocity(to);
    solver.accelerate(to, {});
    return {.converged = 1, .error = 0.0};
  }

 private:
  double longest_;
};

const Registry& types_with_refusing() {
  static constexpr Parameter parameters[] = {{.name = "longest", .unit = "s", .default_value = 1.0}};
  static const Component components[] = {integrator<Refusing>({.name = "refusing", .parameters = parameters})};
  static const Registry registry = [] {
    Registry all = Registry::with_builtins();
    all.add([](const Host* host,
               Manifest* manifest) noexcept { return publish(*host, *manifest, "refusing", "1", components); },
            "test");
    return all;
  }();
  return registry;
}

ModelRun run_refusing(const std::string& text, double step, double longest) {
  const std::string section = "integrator: {type: refusing, longest: " + number(longest) + "}, step: " + number(step);
  return ModelRun(replaced(text, "step: 0", section), {}, {}, types_with_refusing());
}

// Steps are powers of two, so that instants are the same numbers on both ways. A step that is refused is made as two
// halves: if the refused attempt left a trace, in the state or in a joint's history, the bits would differ.
TEST(RejectedAttempt, LeavesTheAcceptedStateAndHistoryAsTheyWere) {
  Puck puck;
  puck.contact = "{law: lankarani-nikravesh, restitution: 0.9}";
  puck.more = ", friction: {law: ambrosio, mu: 0.1, v0: 1e-4, v1: 1e-3}";
  puck.inertia = 2.4e-6;
  puck.vx = 0.05;
  puck.sections = "gravity: [0, -9.81]\n";
  const double step = std::ldexp(1.0, -18);
  puck.end = 2048 * step;
  std::string text = puck.text();
  text = replaced(text, "step: " + number(puck.step) + ", integrator: bathe", "step: 0");
  text = replaced(text, "interval: " + number(puck.end), "interval: " + number(step));
  const ModelRun halved = run_refusing(text, step, 0.75 * step);
  const ModelRun fine = run_refusing(text, 0.5 * step, step);
  EXPECT_EQ(halved.outcome().rejected, 2048);
  EXPECT_EQ(fine.outcome().rejected, 0);
  EXPECT_EQ(halved.outcome().steps, 4096);
  EXPECT_FALSE(halved.events().empty());
  expect_same_bits(halved, fine);
}

TEST(RejectedAttempt, LeavesMultipliersAndTurnsAsTheyWere) {
  std::string text = replaced(mechanism("four-bar"), "{end: 2 s, step: 1 ms}",
                              "{end: 1 s, step: 0, output: {interval: " + number(std::ldexp(1.0, -8)) + "}}");
  const double step = std::ldexp(1.0, -8);
  const ModelRun halved = run_refusing(text, step, 0.75 * step), fine = run_refusing(text, 0.5 * step, step);
  EXPECT_EQ(halved.outcome().rejected, 256);
  expect_same_bits(halved, fine);
}

TEST(RejectedAttempt, StepsThatNeverSucceedEndTheRunAndKeepItsRows) {
  const ModelRun run =
      run_refusing(replaced(mechanism("pendulum"), "{end: 2 s, step: 1 ms}", "{end: 2 s, step: 0}"), 1e-3, 1e-9);
  EXPECT_EQ(run.outcome().status, RunStatus::failed);
  EXPECT_EQ(run.outcome().exit_code, 4);
  EXPECT_EQ(run.rows(), 1u);
  EXPECT_GT(run.outcome().rejected, 5);
  EXPECT_NE(run.outcome().reason.find("no step"), std::string::npos) << run.outcome().reason;
}

}  // namespace
}  // namespace freeplay::test
