// A run that goes on from a saved state ends bit for bit where the uninterrupted one ends.
#include <algorithm>
#include <atomic>
#include <cstring>
#include <filesystem>
#include <random>
#include <set>

#include "run_model.h"

namespace freeplay::test {
namespace {

/// One kind of run of one model.
struct Resumption {
  std::string model;       ///< below mechanisms/, without its ending
  std::string integrator;  ///< empty: that of the model
  enum Steps { own, fixed, adaptive } steps = own;
  long most_steps = 1500;
  int rows_in_contact = 0;
  std::string text = "";  ///< of a model that is not below mechanisms/

  std::string source() const { return text.empty() ? mechanism(model) : text; }
};
void PrintTo(const Resumption& c, std::ostream* out) {
  constexpr const char* kinds[] = {"", " fixed", " adaptive"};
  *out << c.model << ' ' << c.integrator << kinds[c.steps];
  if (c.rows_in_contact > 0) *out << ' ' << c.rows_in_contact << " rows in contact";
}

bool same_bits(std::span<const double> a, std::span<const double> b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

/// A model that is assembled, each time from its text.
struct Prepared {
  explicit Prepared(const Resumption& what) : model(model_of(what)), system(*model) { start = assemble(system); }
  static std::unique_ptr<Model> model_of(const Resumption& what) {
    std::unique_ptr<Model> model = load(what.source(), options(what));
    model->settings.rows_in_contact = what.rows_in_contact;
    return model;
  }
  static BuildOptions options(const Resumption& what) {
    BuildOptions out;
    if (!what.integrator.empty()) out.integrator = what.integrator;
    if (what.steps == Resumption::own) return out;
    const std::unique_ptr<Model> model = load(what.source(), out);
    const Settings& own = model->settings;
    const bool is_adaptive = own.adaptive || own.accuracy > 0.0;
    if (what.steps == Resumption::fixed && is_adaptive) out.step = 2.5e-4 * (own.end - own.start);
    if (what.steps == Resumption::adaptive && !is_adaptive) out.accuracy = 1e-6;
    return out;
  }

  std::unique_ptr<Model> model;
  System system;
  Start start;
};

/// What a run of so many steps, from its start or from a state, wrote, and what it was at its end.
struct Result {
  std::vector<double> numbers;
  std::vector<Event> events;
  Outcome outcome;
  std::vector<std::string> warnings;
  std::vector<double> last_row;
  RunState end;  ///< the last that could be saved
};

/// Saves a state and how many events were written before it.
struct Saved {
  RunState state;
  std::size_t events = 0;
};

Result run_on(Prepared& prepared, long most_steps, const RunState* from,
              const std::function<void(const Simulation&, const RowKeeper&, long)>& each_step) {
  const Channels channels(*prepared.model);
  RowKeeper keeper(*prepared.model, channels, {});
  Sink* const sinks[] = {&keeper};
  std::unique_ptr<Simulation> simulation =
      from == nullptr ? std::make_unique<Simulation>(prepared.system, prepared.start, channels, sinks)
                      : std::make_unique<Simulation>(prepared.system, prepared.start, channels, sinks, *from);
  Result out;
  std::atomic<int> interrupt{0};
  RunHooks hooks;
  hooks.interrupt = &interrupt;
  long steps = from == nullptr ? 0 : static_cast<long>(from->steps);
  hooks.stepped = [&] {
    ++steps;
    if (each_step) each_step(*simulation, keeper, steps);
    if (steps < most_steps) return;
    out.end = simulation->save();
    interrupt = 1;
  };
  out.outcome = simulation->run(hooks);
  out.numbers = keeper.numbers();
  out.events = keeper.events();
  out.warnings.assign(simulation->warnings().begin(), simulation->warnings().end());
  out.last_row.assign(simulation->last_row().begin(), simulation->last_row().end());
  if (steps < most_steps) out.end = simulation->save();
  return out;
}

/// States at seeded random steps, early and late ones, and two where a contact acts or is just over.
std::vector<Saved> save_on_the_way(Prepared& prepared, const Resumption& what, Result& whole) {
  std::seed_seq seed(what.model.begin(), what.model.end());
  std::mt19937 random(seed);
  const auto between = [&](long low, long high) { return std::uniform_int_distribution<long>(low, high)(random); };
  std::set<long> at{between(1, 5), between(6, 40), between(41, what.most_steps / 2),
                    between(what.most_steps / 2, what.most_steps - 1)};
  const long after_event = between(1, 12);
  std::vector<Saved> saved;
  bool met = false;
  whole = run_on(prepared, what.most_steps, nullptr, [&](const Simulation& run, const RowKeeper& keeper, long step) {
    if (!met && !keeper.events().empty()) {
      met = true;
      at.insert({step, step + after_event});
    }
    if (at.contains(step)) saved.push_back({run.save(), keeper.events().size()});
  });
  return saved;
}

void expect_same_end(const Result& whole, const Saved& from, const Result& rest, std::size_t columns) {
  const std::size_t before = static_cast<std::size_t>(from.state.rows) * columns;
  ASSERT_LE(before, whole.numbers.size());
  EXPECT_TRUE(same_bits(std::span(whole.numbers).subspan(before), rest.numbers)) << "rows";
  ASSERT_EQ(whole.events.size() - from.events, rest.events.size());
  for (std::size_t i = 0; i < rest.events.size(); ++i) {
    const Event &a = whole.events[from.events + i], &b = rest.events[i];
    EXPECT_TRUE(a.time == b.time && a.joint == b.joint && a.kind == b.kind && same_bits(a.fields, b.fields));
  }
  EXPECT_EQ(whole.outcome.status, rest.outcome.status);
  EXPECT_EQ(whole.outcome.reason, rest.outcome.reason);
  EXPECT_EQ(whole.outcome.time, rest.outcome.time);
  EXPECT_EQ(whole.outcome.steps, rest.outcome.steps);
  EXPECT_EQ(whole.outcome.rejected, rest.outcome.rejected);
  EXPECT_EQ(whole.outcome.iterations, rest.outcome.iterations);
  EXPECT_EQ(whole.outcome.factorizations, rest.outcome.factorizations);
  EXPECT_EQ(whole.outcome.rows, rest.outcome.rows);
  EXPECT_EQ(whole.outcome.events, rest.outcome.events);
  EXPECT_EQ(whole.outcome.doubts.size(), rest.outcome.doubts.size());
  EXPECT_EQ(whole.warnings, rest.warnings);
  EXPECT_TRUE(same_bits(whole.last_row, rest.last_row)) << "last row";
  // Statistics and all that later steps would depend on.
  EXPECT_TRUE(whole.end == rest.end) << "state at the end";
}

/// From one saved state to the next one.
void expect_same_stretch(const Result& whole, const Saved& from, const Saved& to, const Result& rest,
                         std::size_t columns) {
  const std::size_t begin = static_cast<std::size_t>(from.state.rows) * columns;
  const std::size_t end = static_cast<std::size_t>(to.state.rows) * columns;
  ASSERT_LE(end, whole.numbers.size());
  ASSERT_LE(end - begin, rest.numbers.size());
  EXPECT_TRUE(
      same_bits(std::span(whole.numbers).subspan(begin, end - begin), std::span(rest.numbers).first(end - begin)));
  EXPECT_EQ(to.events - from.events, rest.events.size());
  EXPECT_TRUE(to.state == rest.end) << "state at the next";
}

enum class Until { end, next };  ///< how far a run goes on from each saved state

void resume_everywhere(const Resumption& what, Until until = Until::end) {
  Prepared prepared(what), fresh(what);
  Result whole;
  const std::vector<Saved> saved = save_on_the_way(prepared, what, whole);
  const std::size_t columns = Channels(*prepared.model).all().size();
  for (std::size_t i = 0; i < saved.size(); ++i) {
    const Saved& from = saved[i];
    SCOPED_TRACE("from step " + std::to_string(from.state.steps));
    if (until == Until::next && i + 1 < saved.size()) {
      const Saved& to = saved[i + 1];
      expect_same_stretch(whole, from, to, run_on(fresh, static_cast<long>(to.state.steps), &from.state, {}), columns);
    } else {
      expect_same_end(whole, from, run_on(fresh, what.most_steps, &from.state, {}), columns);
    }
  }
  EXPECT_TRUE(!saved.empty() || whole.outcome.status == RunStatus::failed);
}

// Its formulas have many forms and narrow places, which are looked at inside of steps.
const Resumption detents{"detents",
                         "verner7",
                         Resumption::own,
                         1500,
                         0,
                         "freeplay: 1\n"
                         "bodies: {m: {mass: 1, inertia: 0.01, pose: {position: [0.35, 0]}}}\n"
                         "joints: {rail: {type: prismatic, between: [ground, m]}}\n"
                         "forces:\n"
                         "  s: {type: spring-damper, between: [ground, m], stiffness: 100 N/m, free_length: 0.2 m, "
                         "damper: \"0.1 N*sign(v)\",\n"
                         "      spring: \"2 N*tanh((x - 0.05 m)/(0.1 mm)) + 4 N*exp(-((x + 0.08 m)/(0.5 mm))^2)\"}\n"
                         "simulation: {end: 2 s, accuracy: 1 um, output: {interval: 50 ms}}\n"};

class ResumedRun : public ::testing::TestWithParam<Resumption> {};
TEST_P(ResumedRun, EndsBitForBitWhereTheWholeRunEnds) { resume_everywhere(GetParam()); }
INSTANTIATE_TEST_SUITE_P(Models, ResumedRun,
                         ::testing::Values(Resumption{"3-rrr", "", Resumption::own, 4000},
                                           Resumption{"slider-crank", "bathe", Resumption::adaptive},
                                           Resumption{"slider-crank", "dopri5", Resumption::adaptive},
                                           Resumption{"3-rpr", "generalized-alpha", Resumption::fixed},
                                           Resumption{"spatial/bricard", "", Resumption::own},
                                           Resumption{"spatial/stewart", "", Resumption::own},
                                           Resumption{"spatial/slider-crank", "bathe", Resumption::fixed},
                                           Resumption{"validation/cradle-5", "", Resumption::own},
                                           Resumption{"3-rrr", "", Resumption::own, 4000, 3},
                                           Resumption{"slider-crank", "dopri5", Resumption::adaptive, 1500, 10},
                                           Resumption{"spatial/slider-crank", "", Resumption::adaptive, 1500, 5},
                                           detents));

std::vector<std::string> shipped_models() {
  const std::filesystem::path folder = std::string(source_folder()) + "/mechanisms";
  std::vector<std::string> out;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::filesystem::path name = std::filesystem::relative(entry.path(), folder);
    if (name.extension() != ".yaml" || *name.begin() == "studies") continue;
    out.push_back((name.parent_path() / name.stem()).string());
  }
  std::ranges::sort(out);
  return out;
}

/// Events come late in a run; what a model without any keeps from step to step is there after a few.
long most_steps_of(const std::string& name) {
  const std::unique_ptr<Model> model = load(mechanism(name), {});
  const bool has_events =
      std::ranges::any_of(model->joints, [](const JointElement& joint) { return !joint.layout.events.empty(); });
  return has_events ? 1000 : 200;
}

class ResumedModel : public ::testing::TestWithParam<std::string> {};
TEST_P(ResumedModel, EndsBitForBitWithEveryIntegratorLong) {
  std::vector<std::string> integrators{""};
  for (const RegisteredComponent& type : builtin_types().components()) {
    if (type.component->kind == ComponentKind::integrator) integrators.push_back(type.component->description.name);
  }
  ASSERT_GT(integrators.size(), 7u);
  const long most_steps = most_steps_of(GetParam());
  for (const std::string& integrator : integrators) {
    for (const Resumption::Steps steps : {Resumption::own, Resumption::fixed, Resumption::adaptive}) {
      if (integrator.empty() != (steps == Resumption::own)) continue;
      const Resumption what{GetParam(), integrator, steps, most_steps};
      SCOPED_TRACE(::testing::PrintToString(what));
      try {
        resume_everywhere(what, Until::next);  // each state is reached again from the one before: together, to the end
      } catch (const Error& error) {           // as of steps that an integrator does not take
        EXPECT_EQ(error.category(), Error::Category::input) << error.what();
      }
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Shipped, ResumedModel, ::testing::ValuesIn(shipped_models()));

TEST(SavedState, IsRefusedByAnotherModel) {
  const Resumption one{"pendulum", "", Resumption::own, 5}, other{"four-bar", "", Resumption::own, 5};
  Prepared pendulum(one), four_bar(other);
  const RunState state = run_on(pendulum, 5, nullptr, {}).end;
  const Channels channels(*four_bar.model);
  try {
    Simulation(four_bar.system, four_bar.start, channels, {}, state);
    ADD_FAILURE() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.id(), "state-mismatch");
  }
}

TEST(SavedState, IsRefusedWhereNumbersAreMissing) {
  const Resumption what{"slider-crank", "", Resumption::own, 50};
  Prepared prepared(what);
  const RunState state = run_on(prepared, 50, nullptr, {}).end;
  const Channels channels(*prepared.model);
  for (const bool of_reals : {true, false}) {
    RunState shorter = state;
    of_reals ? shorter.numbers.reals.pop_back() : shorter.numbers.integers.pop_back();
    EXPECT_THROW(Simulation(prepared.system, prepared.start, channels, {}, shorter), Error);
  }
}

}  // namespace
}  // namespace freeplay::test
