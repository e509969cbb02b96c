#include "cli/run_command.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <tuple>

#include <fmt/format.h>

#include "base/message_json.h"
#include "base/number_text.h"
#include "base/processors.h"
#include "base/text.h"
#include "base/version.h"
#include "cli/failure.h"
#include "cli/interrupt.h"
#include "cli/loading.h"
#include "cli/profile_table.h"
#include "cli/progress_line.h"
#include "cli/repeat_runs.h"
#include "cli/run_glance.h"
#include "cli/run_options.h"
#include "cli/run_size.h"
#include "cli/run_table.h"
#include "cli/terminal.h"
#include "cli/twin_run.h"
#include "cli/verify_table.h"
#include "job/resumption.h"
#include "job/verification_record.h"
#include "job/verify_run.h"
#include "load/facts.h"
#include "load/input_file.h"
#include "load/load.h"
#include "results/checkpoints.h"
#include "results/directory.h"
#include "results/input_doubts.h"
#include "results/judgement.h"
#include "results/owner.h"
#include "results/record_thread.h"
#include "results/recording.h"
#include "results/row_memory.h"
#include "results/summary.h"

namespace freeplay {
namespace {

constexpr int runs_disagree = 7;  // exit code of --verify

std::filesystem::path result_path(const RunOptions& options, const Model& model) {
  if (!options.out.empty()) return options.out;
  return std::filesystem::path("results") / result_name(model.name, !options.model_options.ideal.empty());
}

/// Runs to the end and returns it as a record.
class RunJob {
 public:
  /// `from`: where an earlier run ended that this one goes on with, or null.
  RunJob(const LoadedModel& loaded, AssembledModel& assembled, std::filesystem::path path, const RunOptions& options,
         const CommonOptions& common, RepeatRuns* repeats, TwinRun* twin, const Checkpoint* from,
         const InputCourse& inputs)
      : loaded_(loaded),
        inputs_(inputs),
        assembled_(assembled),
        options_(options),
        common_(common),
        repeats_(repeats),
        twin_(twin),
        path_(std::move(path)),
        channels_(*loaded.model),
        recording_(from == nullptr
                       ? Recording(path_, options.force, *loaded.model, channels_,
                                   making(options, common.command, *loaded.model))
                       : Recording::go_on(path_, *loaded.model, channels_,
                                          making(options, common.command, *loaded.model), kept_part_of(*from))),
        sinks_(recording_.sinks()),
        checkpoints_(recording_, path_, made_from(options, common.command, *loaded.model),
                     checkpoint_period(options.checkpoint)) {
    const bool begins = from == nullptr || !from->state;
    begins ? simulation_.emplace(assembled.system, assembled.start, channels_, all_sinks())
           : simulation_.emplace(assembled.system, assembled.start, channels_, all_sinks(), *from->state);
    from == nullptr ? checkpoints_.begin() : checkpoints_.go_on(*from);
  }

  /// `format_note`: why the format is not the usual one, for the log.
  int execute(const std::string& format_note) {
    note(fmt::format("freeplay {} runs {} from {:g} s to {:g} s", program_version, loaded_.model->file,
                     settings().start, settings().end));
    if (!recording_.guarded()) {
      warn(fmt::format("the file system of '{}' has no locks: let no other run write into it meanwhile",
                       path_.string()));
    }
    for (const RegisteredLibrary& library : loaded_.model->instances.libraries()) {
      if (library.path == "built-in") continue;
      note(fmt::format("plugin {} {}, compiler {}, from {}", library.table->name(), library.table->version(),
                       library.table->compiler(), library.path));
    }
    if (!format_note.empty()) recording_.log().write("note", format_note);
    if (checkpoints_.resumed() > 0) note(checkpoints_.resumed_words());
    for (const std::string& text : warnings_of(loaded_.diagnostics, {})) recording_.log().write("warning", text);
    for (const MovedStart& moved : assembled_.start.report.moved) note(sentence(moved));
    if (!options_.inputs.empty()) recording_.add("inputs.csv", input_text(*loaded_.model, inputs_));
    Outcome outcome = run();
    Ended ended = end();
    if (twin_ != nullptr) compare_with_twin(outcome, ended);
    for (const std::string& text : ended.warnings) warn(text);
    note(fmt::format("{} at {:g} s after {} steps, {} rows", status_word(outcome.status), outcome.time, outcome.steps,
                     outcome.rows));
    if (!outcome.reason.empty()) recording_.log().write(outcome.exit_code == 0 ? "note" : "error", outcome.reason);
    std::optional<Verification> verification;
    if (options_.verify && outcome.exit_code == 0) verification = verify(outcome, ended);
    if (verification && verification->agreement == Agreement::disagree) outcome.exit_code = runs_disagree;
    if (options_.verify && outcome.exit_code == 0 && watch_interrupts() != 0) {
      interrupted_beside(outcome, "the second run of --verify");
      recording_.log().write("note", outcome.reason);
    }
    close(outcome);
    return finish(outcome, ended, verification);
  }

 private:
  /// What is reported of a simulation when it is over.
  struct Ended {
    Statistics statistics;
    ClearanceStatistics clearances;
    RunExtremes extremes;
    std::vector<double> last_row;
    std::vector<std::string> warnings;
    std::vector<JointMemory> memory;
    Json twin = nullptr;
  };

  const Settings& settings() const { return loaded_.model->settings; }

  void note(const std::string& text) {
    recording_.log().write("note", text);
    if (common_.verbose) print_messages("freeplay: note: " + text + "\n", common_.no_color);
  }

  void warn(const std::string& text) {
    recording_.log().write("warning", text);
    print_messages("freeplay: warning: " + text + "\n", common_.no_color);
  }

  std::span<Sink* const> all_sinks() {
    if (options_.verify) sinks_.push_back(&rows_.emplace(channels_));
    if (options_.twin_pipe >= 0) sinks_.push_back(&twin_rows_.emplace(options_.twin_pipe, *loaded_.model, channels_));
    if (twin_ != nullptr) sinks_.push_back(&twin_->start(*loaded_.model, channels_));
    return sinks_;
  }

  /// What runs by another method say of this one; nothing of them is written but that.
  std::optional<Verification> verify(const Outcome& outcome, const Ended& ended) {
    std::string trouble;
    const BuildOptions build = build_options(options_);
    const LoadOptions load = loading(common_);
    std::optional<Verification> verification = verify_run(
        {[&](const BuildOptions& other) { return load_model(options_.model, other, load); }, build, load,
         assembled_.system, outcome, ended.statistics, rows_->table(), [] { return watch_interrupts() != 0; }},
        trouble);
    if (!trouble.empty()) warn("--verify: " + trouble);
    if (verification && verification->agreement == Agreement::disagree) {
      warn("--verify: " + agreement_text(*verification));
    }
    return verification;
  }

  /// This run had come to its end, one beside it that its summary needs had not.
  static void interrupted_beside(Outcome& outcome, const char* other) {
    outcome.exit_code = 130;
    outcome.status = RunStatus::interrupted;
    outcome.reason = fmt::format("interrupted during {}: this one had come to its end", other);
  }

  void compare_with_twin(Outcome& outcome, Ended& ended) {
    std::string trouble;
    ended.twin = twin_->finish(trouble);
    if (ended.twin.is_null() && trouble.empty() && outcome.exit_code == 0 && watch_interrupts() != 0) {
      interrupted_beside(outcome, "the run without clearances of --twin");
    }
    if (trouble.empty()) return;
    ended.warnings.push_back("--twin: the run without clearances failed: " + trouble);
  }

  Outcome run() {
    ProgressLine progress(settings().start, settings().end, stderr_is_terminal() && !common_.quiet);
    RunHooks hooks;
    const std::atomic<int>& interrupt = watch_interrupts();
    std::atomic<int> stop{0};
    hooks.interrupt = &stop;
    hooks.stepped = [&] {
      if (first_step_seconds_ == 0.0) first_step_seconds_ = processor_seconds();
      if (repeats_ != nullptr) repeats_->look_after();
      if (interrupt != 0) stop = 1;
      if (interrupt != 0 || checkpoints_.due()) checkpoints_.add(simulation_->save());
    };
    if (options_.profile) hooks.profile = &profile_;
    hooks.progress = [&](double t, long steps) {
      progress.update(t, steps);
      if (!recording_.ok()) stop = 1;
    };
    hooks.notice = [&](const std::string& text) {
      progress.clear();
      warn(text);
    };
    return run_with(*simulation_, hooks, inputs_);
  }

  /// Nothing is claimed that the files do not hold.
  void fail_writing(const std::string& failure, Outcome& outcome) const {
    outcome.status = RunStatus::failed;
    outcome.exit_code = 6;
    outcome.reason = failure;
    outcome.rows = 0;
    if (!recording_.undisturbed()) {
      outcome.reason += "; no row is certain: keep other programs out of the directory and run the model again";
      return;
    }
    const HeldRows held = recording_.held();
    outcome.rows = held.count;
    const std::string rows = held.count > 0 ? fmt::format("rows up to t = {:g} s", held.last_time) : "no rows";
    outcome.reason = fmt::format("{}; {} are safe; free some space and go on with freeplay run --resume {}", failure,
                                 rows, path_.string());
  }

  /// The summary of a large model takes memory, and a second run as much as this one did: matrices go first.
  Ended end() {
    const auto row = simulation_->last_row();
    const auto warnings = simulation_->warnings();
    Ended ended{simulation_->statistics(), simulation_->clearances(),          simulation_->extremes(),
                {row.begin(), row.end()},  {warnings.begin(), warnings.end()}, simulation_->memory()};
    simulation_.reset();
    twin_rows_.reset();
    return ended;
  }

  int finish(Outcome outcome, const Ended& ended, const std::optional<Verification>& verification) {
    RunRecord record{*loaded_.model,    channels_,           assembled_.start.facts,
                     outcome,           ended.statistics,    ended.clearances,
                     ended.last_row,    recording_.advice(), warnings_of(loaded_.diagnostics, ended.warnings),
                     recording_.files()};
    if (verification) add_verification(*verification, record);
    recording_.bearing(ended.clearances);
    record.hashes = recording_.hashes();
    record.provenance = recording_.provenance();
    record.provenance["hashes"] = record.hashes;
    std::tie(record.extremes, record.twin, record.memory) = std::tie(ended.extremes, ended.twin, ended.memory);
    record.trust.add(outcome.doubts);
    doubt_input(loaded_.diagnostics, record.trust);
    judge(record, record.trust);
    Json json = summary(record);
    json["performance"]["resumed"] = checkpoints_.resumed();
    json["performance"]["resumed_from"] = checkpoints_.resumed_from();
    const int exit_code = repeats_ ? add_repeats(record, outcome, json) : outcome.exit_code;
    seal(json, outcome);
    const char* id = outcome.exit_code == 6 ? " [cannot-write]" : "";
    if (outcome.exit_code != 0 && outcome.status == RunStatus::failed)
      print_messages(fmt::format("freeplay: error: {}{}\n", outcome.reason, id), common_.no_color);
    if (common_.json) {
      print_json(json);
    } else if (!common_.quiet) {
      print(run_table(record) + start_text(*loaded_.model, assembled_.start) +
            (verification ? verify_table(*verification) : "") + fmt::format("  results in {}\n", path_.string()) +
            (outcome.exit_code == 6 ? "" : glance(path_, options_.report)));
    }
    if (options_.profile) {
      const std::string table = profile_table(profile_, outcome, first_step_seconds_, recording_.text_seconds());
      common_.json ? print_messages(table, common_.no_color) : print(table);
    }
    return exit_code;
  }

  /// Where a file could not be written, that is what is reported, and no later failure.
  void close(Outcome& outcome) {
    std::string failure = recording_.close();
    try {
      const bool ended = outcome.status == RunStatus::completed || outcome.status == RunStatus::stopped;
      if (failure.empty() && ended) checkpoints_.end(outcome.rows);
    } catch (const Error& error) {
      failure = error.message();
    }
    if (!failure.empty()) fail_writing(failure, outcome);
  }

  void seal(const Json& json, const Outcome& outcome) {
    try {
      recording_.seal(json);
    } catch (const Error&) {
      if (outcome.exit_code != 6) throw;
    }
  }

  /// Waits for the other runs of a repeated one. Returns the exit code of all together.
  int add_repeats(RunRecord& record, Outcome& outcome, Json& json) {
    ProgressLine progress(0.0, 1.0, stderr_is_terminal() && !common_.quiet);
    record.repeat = repeats_->finish(json, outcome, [&](std::size_t ended) {
      progress.update("runs", static_cast<long>(ended), static_cast<long>(repeats_->runs()));
    });
    json["repeat"] = record.repeat;
    if (outcome.exit_code != 0) return outcome.exit_code;
    const Json& failed = record.repeat["failed"];
    const bool all = record.repeat["completed"].get<std::size_t>() + failed.size() == repeats_->runs();
    if (!all) {
      outcome.status = RunStatus::interrupted;
      outcome.exit_code = 130;
      outcome.reason = "interrupted during the other runs of --repeat: the first one had come to its end";
      json["status"] = status_word(outcome.status);
      json["exit_code"] = outcome.exit_code;
      json["stop_reason"] = outcome.reason;
    }
    if (outcome.exit_code != 0) return outcome.exit_code;
    return failed.empty() ? 0 : failed[0]["exit_code"].get<int>();
  }

  const LoadedModel& loaded_;
  const InputCourse& inputs_;
  AssembledModel& assembled_;
  const RunOptions& options_;
  const CommonOptions& common_;
  RepeatRuns* repeats_;  // null: the run is not repeated
  TwinRun* twin_;        // null: it has no twin
  std::filesystem::path path_;
  Channels channels_;
  Recording recording_;
  std::optional<RowMemory> rows_;      // to verify
  std::optional<TwinRows> twin_rows_;  // of a twin
  std::vector<Sink*> sinks_;
  std::optional<Simulation> simulation_;  // until it is over
  Checkpoints checkpoints_;
  Profile profile_;
  double first_step_seconds_ = 0.0;  // of the processor, until the first step had ended
};

int dry_run(const LoadedModel& loaded, const AssembledModel& assembled, const CommonOptions& common) {
  const Model& model = *loaded.model;
  if (common.json) {
    print_json(Json{{"file", model.file},
                    {"ok", true},
                    {"facts", facts_json(model, assembled.start.facts, assembled.start.structure)},
                    {"start", start_json(model, assembled.start)},
                    {"start_changes", start_changes_json(model, assembled.start.report)},
                    {"messages", messages_json(loaded.diagnostics, common.max_errors)}});
  } else if (!common.quiet) {
    print(printable(model.file) + ": ok\n" + facts_text(model, assembled.start.facts) +
          structure_text(assembled.start.structure) + moved_text(model, assembled.start.report));
  }
  return 0;
}

int run(const RunOptions& options, const CommonOptions& common, const Resumption* resumed);

/// The same run with every clearance closed, into the folder `twin` of the result, whatever an earlier one left there.
int run_twin(RunOptions options, CommonOptions common, const std::filesystem::path& path, int pipe) {
  options.model_options.ideal = {"all"};
  options.out = (path / "twin").string();
  options.force = true;  // what an earlier process left of it belongs to this result
  options.verify = options.profile = options.twin = options.report = false;
  options.twin_pipe = pipe;
  common.quiet = true;
  common.verbose = common.json = false;
  return run(options, common, nullptr);
}

int run(const RunOptions& options, const CommonOptions& common, const Resumption* resumed) {
  if (options.model.empty()) throw Error(Error::Category::usage, "missing-argument", "run needs a model file");
  refuse_idle_options(options);
  const RepeatPlan plan = repeat_plan(options.repeat, options.seed);
  LoadedModel loaded = load_model(options.model, build_options(options), loading(common));
  if (resumed != nullptr && options.interval.empty() && loaded.model &&
      loaded.model->settings.interval != resumed->interval) {
    // It follows from the end, which is a later one.
    RunOptions with_interval = options;
    with_interval.interval = fmt::format("{} s", number_text(resumed->interval));
    return run(with_interval, common, resumed);
  }
  if (!loaded.model) return report_failure(loaded.diagnostics, loaded.exit_code, common);
  if (!options.model_name.empty()) loaded.model->name = options.model_name;
  const std::filesystem::path path = result_path(options, *loaded.model);
  if (!options.dry_run && resumed == nullptr) {
    check_result_directory(path, options.force);
    if (options.out.empty() && !options.force) require_no_other_model(path, *loaded.model);
  }
  if (options.twin) require_twin(*loaded.model);
  InputCourse inputs;
  if (!options.inputs.empty()) {
    inputs = read_inputs(options.inputs, *loaded.model, loaded.diagnostics, loaded.model->inputs.emplace_back());
  }
  if (loaded.diagnostics.has_errors()) return report_failure(loaded.diagnostics, 3, common);
  const std::string format_note = settle_format(*loaded.model, options, common);
  if (resumed != nullptr) require_same_making(resumed->checkpoint, provenance(*loaded.model, {}));
  const Checkpoint* from = resumed != nullptr && resumed->goes_on ? &resumed->checkpoint : nullptr;
  if (!options.dry_run) announce_size(*loaded.model, path, from != nullptr ? from->rows() : 0, options, common);
  const auto assembled = assemble_model(loaded);
  if (!assembled) return report_failure(loaded.diagnostics, loaded.exit_code, common);
  print_messages(loaded.diagnostics.format(common.max_errors), common.no_color);
  // What it refuses is reported before the directory is cleared of an earlier result.
  require_sound_integrator(assembled->system);
  loaded.document.reset();  // nothing asks for it any more, and that of a large model is large
  if (options.dry_run) return dry_run(loaded, *assembled, common);
  const auto repeats = plan.runs > 0 ? std::make_unique<RepeatRuns>(*loaded.model, plan, processor_count()) : nullptr;
  std::unique_ptr<TwinRun> twin;
  if (options.twin) {
    require_no_owner(path / "twin");
    twin = std::make_unique<TwinRun>([&](int pipe) { return run_twin(options, common, path, pipe); });
  }
  require_thread();
  watch_interrupts();  // a result directory that is begun gets its summary
  const int exit_code =
      RunJob(loaded, *assembled, path, options, common, repeats.get(), twin.get(), from, inputs).execute(format_note);
  if (options.report && exit_code != 6) write_report_of(path, common);
  return exit_code;
}

int resume(const CLI::App& app, const RunOptions& asked, CommonOptions& common) {
  refuse_other_options(app);
  checkpoint_period(asked.checkpoint);
  const Resumption resumption = read_resumption(asked.resume, asked.end);
  if (!resumption.nothing_to_do.empty()) {
    const std::string text = "nothing to do: " + resumption.nothing_to_do;
    common.json ? print_json(Json{{"directory", asked.resume}, {"resumed", false}, {"reason", text}})
                : print(text + "\n");
    return 0;
  }
  RunOptions options = asked;
  static_cast<KeptWords&>(options) = resumption.words;
  options.model = resumption.model;
  options.model_name = resumption.model_name;
  options.out = asked.resume;
  options.resume.clear();
  options.force = !resumption.goes_on;
  common.recorded_plugins = resumption.recorded_plugins;
  common.strict = options.strict;
  return run(options, common, &resumption);
}

}  // namespace

Command add_run_command(CLI::App& program, CommonOptions& common) {
  CLI::App* app = add_command(program, "run", "Simulate a model and write its results");
  const auto options = std::make_shared<RunOptions>();
  add_run_options(*app, *options);
  add_common_options(*app, common);
  return {app, [app, options, &common] {
            options->plugins = common.plugins;
            options->strict = common.strict;
            return options->resume.empty() ? run(*options, common, nullptr) : resume(*app, *options, common);
          }};
}

}  // namespace freeplay
