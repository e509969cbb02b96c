#include "system/state.h"

#include <cstring>

#include "validation/run_model.h"

namespace freeplay {
namespace {

bool same_bits(const State& a, const State& b) {
  return a.block().size() == b.block().size() &&
         std::memcmp(a.block().data(), b.block().data(), a.block().size() * sizeof(double)) == 0;
}

void scribble(State& state) {
  double value = 0.1;
  state.t() = -1.0;
  for (const auto part : {state.q(), state.v(), state.a(), state.lambda(), state.z(), state.h(), state.memory()}) {
    for (double& x : part) x = value += 0.7;
  }
}

TEST(State, PartsDoNotOverlapAndFillTheBlock) {
  const auto model = test::load(test::mechanism("3-rrr"));
  const Layout layout(*model, Variant::released);
  State state(layout, 5);
  scribble(state);
  const std::size_t parts = 1 + state.q().size() + state.v().size() + state.a().size() + state.lambda().size() +
                            state.z().size() + state.h().size() + state.memory().size();
  EXPECT_EQ(state.block().size(), parts);
  // Every number but the time was written once, each larger than the one before.
  for (std::size_t i = 2; i < state.block().size(); ++i) EXPECT_GT(state.block()[i], state.block()[i - 1]);
  EXPECT_EQ(state.q().size(), 21u);
  EXPECT_EQ(state.lambda().size(), 9u);
  EXPECT_EQ(state.memory().size(), 5u);
}

TEST(State, AssigningRestoresEveryBit) {
  const auto model = test::load(test::mechanism("3-rrr"));
  const Layout layout(*model, Variant::released);
  State accepted(layout, 3);
  scribble(accepted);
  const State copy = accepted;
  State trial(layout, 3);
  trial.assign(accepted);
  EXPECT_TRUE(same_bits(trial, accepted));
  for (double& x : trial.q()) x = NAN;
  for (double& x : trial.h()) x = NAN;
  EXPECT_TRUE(same_bits(accepted, copy));
  trial.assign(accepted);
  EXPECT_TRUE(same_bits(trial, copy));
}

TEST(State, SeesAWritePastItsEndUntilItIsMadeAnew) {
  const auto model = test::load(test::mechanism("pendulum"));
  const Layout layout(*model, Variant::released);
  for (const int memory : {0, 3}) {
    State state(layout, memory);
    const State untouched(layout, 2);
    scribble(state);
    state.assign(untouched);
    EXPECT_TRUE(state.intact()) << "a state of other size was assigned";
    double* end = state.memory().data() + state.memory().size();
    *end = 0.0;
    EXPECT_FALSE(state.intact());
  }
}

TEST(State, AssigningLeavesMemoryThatTheOtherLacks) {
  const auto model = test::load(test::mechanism("pendulum"));
  const Layout layout(*model, Variant::released);
  State start(layout, 0), running(layout, 2);
  scribble(start);
  running.memory()[1] = 42.0;
  running.assign(start);
  EXPECT_EQ(running.memory()[1], 42.0);
  EXPECT_EQ(running.q()[2], start.q()[2]);
}

TEST(State, ViewsPointIntoTheBlock) {
  const auto model = test::load(test::mechanism("four-bar"));
  State state(Layout(*model, Variant::released), 1);
  StateView view = state.view();
  *view.t = 3.0;
  view.lambda[0] = 4.0;
  view.memory[0] = 5.0;
  EXPECT_EQ(state.t(), 3.0);
  EXPECT_EQ(state.lambda()[0], 4.0);
  EXPECT_EQ(state.memory()[0], 5.0);
}

}  // namespace
}  // namespace freeplay
