#include "study/point_runner.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <deque>
#include <filesystem>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "format/parameter_scope.h"
#include "format/run_override.h"
#include "load/load.h"
#include "load/plugins.h"
#include "results/contact_advice.h"
#include "results/summary.h"
#include "run/play_start.h"
#include "run/requirements.h"
#include "run/simulation.h"
#include "study/chain_state.h"
#include "study/point_analysis.h"
#include "study/point_message.h"
#include "study/point_reducers.h"
#include "study/reducer_entry.h"
#include "study/summary_numbers.h"

namespace freeplay {
namespace {

/// Processor time of this thread [s].
double processor_time() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// A point that has failed, by its exit code, message id and text.
struct PointFailure {
  int exit_code;
  std::string id, message;
};

[[noreturn]] void fail(const Diagnostics& diagnostics, int exit_code) {
  for (const Diagnostic& diagnostic : diagnostics.sorted()) {
    if (diagnostic.severity == Severity::error) throw PointFailure{exit_code, diagnostic.id, diagnostic.message};
  }
  throw PointFailure{exit_code, "invalid", "the model is wrong at this point"};
}

/// "... [id]" at the end of a reason says what kind of failure it is.
PointFailure failure_of(const Outcome& outcome) {
  const std::size_t open = outcome.reason.rfind(" [");
  if (open != std::string::npos && outcome.reason.ends_with(']')) {
    return {outcome.exit_code, outcome.reason.substr(open + 2, outcome.reason.size() - open - 3),
            outcome.reason.substr(0, open)};
  }
  return {outcome.exit_code, outcome.exit_code == 5 ? "plugin-failed" : "numerical", outcome.reason};
}

BuildOptions build_options(BuildOptions options, const std::vector<StudySetting>& settings) {
  options.without_study = true;
  for (const StudySetting& setting : settings) options.set.emplace_back(setting.target, setting.text);
  return options;
}

}  // namespace

struct PointRunner::Impl {
  Impl(PointSource source_of_all, const LoadOptions& options, Diagnostics& diagnostics)
      : source(std::move(source_of_all)) {
    reading.diagnostics = &diagnostics;
    const int before = diagnostics.errors();
    for (const Document* document : source.models) registries.push_back(load_registry(options, document));
    if (source.reducers != nullptr) {
      entries =
          read_reducers(CheckedValue(reading, *source.reducers, nullptr, "study.reducers"), source.analysis != nullptr);
    }
    if (source.analysis != nullptr) {
      analysis = read_analysis_words(CheckedValue(reading, *source.analysis, nullptr, "study.do"));
    }
    if (diagnostics.errors() == before) check(diagnostics);
  }

  /// Of the models.
  std::vector<std::string> folders() const {
    std::vector<std::string> folders;
    for (const Document* document : source.models) {
      folders.push_back(std::filesystem::path(document->file_name()).parent_path().string());
    }
    return folders;
  }
  void check(Diagnostics& diagnostics);
  void check_summaries(const Model& model, const Channels& channels);
  PointReducers bind(const Model& model, const Channels& channels, PointReducers::Lacking lacking) {
    scope.emplace(used);
    for (const auto& [name, value] : model.parameters) scope->add_constant(name, value);
    reading.scope = &*scope;
    return PointReducers(entries, columns, model, channels, lacking);
  }
  void check_analysis(Model& model, PointReducers& reducers);
  void run_point(const StudyPoint& point, const std::string& state_before, StudyOutcome& outcome);
  void simulate(LoadedModel& loaded, const Channels& channels, PointReducers& reducers, const std::string& state_before,
                StudyOutcome& outcome);

  PointSource source;
  std::deque<Registry> registries;
  UsedKeys used;
  std::optional<ParameterScope> scope{used};
  Reading reading{.diagnostics = nullptr, .scope = &*scope};
  std::vector<ReducerEntry> entries;
  std::optional<AnalysisWords> analysis;
  ReducerColumns columns{{}, {}};
  const std::atomic<int>* interrupt = nullptr;  // of the point in hand
};

void PointRunner::Impl::check(Diagnostics& diagnostics) {
  std::deque<LoadedModel> loaded;
  std::vector<const Model*> models;
  if (analysis) require_sense(*analysis);
  for (std::size_t i = 0; i < source.models.size(); ++i) {
    LoadedModel& one =
        loaded.emplace_back(load_document(*source.models[i], build_options(source.build, source.set), registries[i]));
    for (const Diagnostic& diagnostic : one.diagnostics.sorted()) diagnostics.add(diagnostic);
    if (one.model) models.push_back(one.model.get());
  }
  if (models.size() < source.models.size()) return;
  columns = ReducerColumns(entries, models);
  for (LoadedModel& one : loaded) {
    const Channels channels(*one.model);
    PointReducers reducers = bind(*one.model, channels, PointReducers::Lacking::mistake);
    if (reducers.needs_summary()) check_summaries(*one.model, channels);
    if (!analysis || diagnostics.has_errors()) continue;
    check_analysis(*one.model, reducers);
    bind(*one.model, channels, PointReducers::Lacking::mistake);  // formulas, now that columns have units
  }
}

// Its table has the columns of every point. What no table can be made of at the values of the file may be good at the
// points.
void PointRunner::Impl::check_analysis(Model& model, PointReducers& reducers) {
  try {
    reducers.finish(analysis_of(model, *analysis));
  } catch (const Error& error) {
    if (error.category() == Error::Category::usage) throw;
  }
}

// What a summary would have, a run that has not begun says.
void PointRunner::Impl::check_summaries(const Model& model, const Channels& channels) {
  System system(model);
  const Start start{State(system.layout(), 0), count_facts(model), {}, {}};
  const Outcome outcome;
  const std::vector<double> row(channels.all().size(), 0.0);
  const SummaryNumbers numbers(summary({model,
                                        channels,
                                        start.facts,
                                        outcome,
                                        Statistics(model, channels),
                                        ClearanceStatistics(model, system.joints(), channels),
                                        row,
                                        ContactAdvice(model),
                                        {},
                                        {}}));
  for (const ReducerEntry& entry : entries) {
    if (entry.source != ReducerEntry::Source::summary) continue;
    const std::string path = entry.text();
    if (!numbers.has(path)) {
      entry.subject.fail("unknown-name", fmt::format("a summary has no number '{}'", path), numbers.nearest_to(path));
    }
    const bool several = path.find('*') != std::string::npos;
    if (several != entry.over.has_value()) {
      entry.subject.fail(
          several ? "missing-key" : "conflicting-keys",
          several ? "a path with '*' needs `over`: max, min, sum or mean" : "`over` is for a path with '*'");
    }
  }
}

void PointRunner::Impl::run_point(const StudyPoint& point, const std::string& state_before, StudyOutcome& outcome) {
  LoadedModel loaded =
      load_document(*source.models[point.model], build_options(source.build, point.settings), registries[point.model]);
  if (!loaded.model) fail(loaded.diagnostics, loaded.exit_code);
  const Channels channels(*loaded.model);
  Diagnostics diagnostics;
  reading.diagnostics = &diagnostics;
  PointReducers reducers = bind(*loaded.model, channels, PointReducers::Lacking::no_value);
  if (diagnostics.has_errors()) fail(diagnostics, 3);
  if (analysis) {
    const double before = processor_time();
    const AnalysisTable table = analysis_of(*loaded.model, *analysis);
    outcome.run = processor_time() - before;
    reducers.finish(table);
    if (diagnostics.has_errors()) fail(diagnostics, 3);
  } else {
    simulate(loaded, channels, reducers, state_before, outcome);
  }
  outcome.values = std::move(reducers.values());
  outcome.samples = std::move(reducers.samples());
}

void PointRunner::Impl::simulate(LoadedModel& loaded, const Channels& channels, PointReducers& reducers,
                                 const std::string& state_before, StudyOutcome& outcome) {
  System system(*loaded.model);
  const StartChoice choice = start_choice(*loaded.model);
  Start begin = assemble_bare_in_play(system, choice.seed, choice.repeat - 1);
  require_attainable_accuracy(system);
  if (source.chained) outcome.start = state_before.empty() ? "cold" : "warm";
  if (!state_before.empty()) start_from(system, chain_motion(state_before), begin);
  ContactAdvice advice(*loaded.model);
  std::vector<Sink*> sinks(reducers.sinks().begin(), reducers.sinks().end());
  if (reducers.needs_summary()) sinks.push_back(&advice);
  Simulation simulation(system, begin, channels, sinks);
  RunHooks hooks;
  if (reducers.needs_steps()) hooks.steps = &reducers;
  hooks.interrupt = interrupt;
  const double before = processor_time();
  const Outcome end = simulation.run(hooks);
  outcome.run = processor_time() - before;
  if (end.exit_code != 0) throw failure_of(end);
  reducers.finish(simulation.statistics(), [&] {
    RunRecord record{
        *loaded.model,         channels, begin.facts, end, simulation.statistics(), simulation.clearances(),
        simulation.last_row(), advice,   {},          {}};
    record.extremes = simulation.extremes();
    return summary(record);
  });
  if (source.chained) outcome.state = chain_text(simulation.motion());
}

PointRunner::PointRunner(PointSource source, const LoadOptions& options, Diagnostics& diagnostics)
    : impl_(std::make_unique<Impl>(std::move(source), options, diagnostics)) {}
PointRunner::~PointRunner() = default;
PointRunner::PointRunner(PointRunner&&) noexcept = default;

const std::vector<StudyColumn>& PointRunner::columns() const { return impl_->columns.all(); }
const std::vector<StudyColumn>& PointRunner::sample_columns() const { return impl_->columns.samples(); }

std::vector<std::string> PointRunner::plugin_files() const {
  std::set<std::string> files;
  for (const Registry& registry : impl_->registries) {
    for (const RegisteredLibrary& library : registry.libraries()) {
      if (library.path != "built-in") files.insert(library.path);
    }
  }
  return {files.begin(), files.end()};
}

void PointRunner::try_settings(const StudyPoint& point) const {
  load_document(*impl_->source.models[point.model], build_options(impl_->source.build, point.settings),
                impl_->registries[point.model]);
}

StudyOutcome PointRunner::run(const StudyPoint& point, const std::string& state_before,
                              const std::atomic<int>* interrupt) {
  impl_->interrupt = interrupt;
  const auto begin = std::chrono::steady_clock::now();
  const double before = processor_time();
  StudyOutcome outcome;
  const auto fail_with = [&](const PointFailure& failure) {
    outcome.exit_code = failure.exit_code;
    outcome.error = failure.id;
    outcome.message = point_message(failure.message, impl_->folders());
  };
  try {
    impl_->run_point(point, state_before, outcome);
  } catch (const PointFailure& failure) {
    fail_with(failure);
  } catch (const Error& error) {
    // What the command line would refuse is a mistake of the study here.
    fail_with({error.category() == Error::Category::usage ? 3 : error.exit_code(), error.id(), error.message()});
  } catch (const std::bad_alloc&) {
    fail_with({4, "no-memory", "the system gives no more memory"});
  }
  if (outcome.exit_code != 0) {
    outcome.values.assign(columns().size(), std::numeric_limits<double>::quiet_NaN());
    outcome.samples.assign(sample_columns().size(), {});
  }
  outcome.cpu = processor_time() - before;
  outcome.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return outcome;
}

}  // namespace freeplay
