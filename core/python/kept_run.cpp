#include "python/kept_run.h"

#include <algorithm>
#include <atomic>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "base/version.h"
#include "python/refusal.h"
#include "results/contact_advice.h"
#include "results/directory.h"
#include "results/input_doubts.h"
#include "results/judgement.h"
#include "results/record_thread.h"
#include "results/recording.h"
#include "results/summary.h"
#include "results/text_writers.h"
#include "run/simulation.h"

namespace freeplay {
namespace {

constexpr std::pair<Phase, const char*> phases[] = {
    {Phase::start, "start"},       {Phase::assembly, "assembly"},
    {Phase::joints, "joints"},     {Phase::factorization, "factorization"},
    {Phase::solution, "solution"}, {Phase::integrator, "integrator"},
    {Phase::events, "events"},     {Phase::statistics, "statistics"},
    {Phase::output, "output"},     {Phase::rest, "rest"}};

/// What makes the same run on the command line.
Making making_of(const OpenedModel& opened, const RunRequest& request) {
  Making making{.made = "run",
                .command = request.call,
                .arguments = arguments_of(opened.model(), opened.request().words),
                .build = FREEPLAY_BUILD};
  for (const std::string& plugin : opened.request().plugins)
    making.arguments.insert(making.arguments.end(), {"--plugin", plugin});
  return making;
}

class KeptRunJob {
 public:
  KeptRunJob(const std::shared_ptr<const OpenedModel>& opened, const RunRequest& request)
      : model_(opened->model()), channels_(opened->channels()), request_(request), run_(std::make_shared<KeptRun>()) {
    run_->model = opened;
    if (request.out) check_result_directory(*request.out, request.force);
    rows_ = std::make_unique<KeptRows>(model_, channels_);
    assembled_ = opened->assemble(diagnostics_);
    require_sound_integrator(assembled_->system);
    if (request.out) {
      require_thread();
      recording_.emplace(*request.out, request.force, model_, channels_, making_of(*opened, request));
      sinks_ = recording_->sinks();
    }
    sinks_.push_back(rows_.get());
    sinks_.push_back(&advice_);
  }

  std::shared_ptr<KeptRun> execute(const std::function<bool(double, long)>& tick) {
    if (recording_) begin_log();
    Simulation simulation(assembled_->system, assembled_->start, channels_, sinks_);
    Profile profile;
    std::atomic<int> stop{0};
    RunHooks hooks;
    hooks.interrupt = &stop;
    hooks.progress = [&](double t, long steps) {
      if (!tick(t, steps) || (recording_ && !recording_->ok())) stop = 1;
    };
    if (request_.profile) hooks.profile = &profile;
    Outcome outcome = simulation.run(hooks);
    rows_->finish();
    if (request_.profile) keep_profile(profile);
    run_->bearings = bearing_tables(rows_->layout(), simulation.clearances());
    finish(simulation, outcome);
    return run_;
  }

 private:
  void begin_log() {
    recording_->log().write("note", fmt::format("freeplay {} runs {} from {:g} s to {:g} s", program_version,
                                                model_.file, model_.settings.start, model_.settings.end));
    for (const std::string& text : warnings_of(diagnostics_, {})) recording_->log().write("warning", text);
  }

  void keep_profile(const Profile& profile) {
    for (const auto& [phase, name] : phases) {
      run_->profile.push_back({name, profile.seconds(phase), profile.count(phase)});
    }
  }

  /// Ends the files. What could not be written is what the run reports.
  void close(Outcome& outcome) {
    if (!outcome.reason.empty()) {
      recording_->log().write(outcome.exit_code == 0 ? "note" : "error", outcome.reason);
    }
    const std::string failure = recording_->close();
    if (failure.empty()) return;
    outcome.status = RunStatus::failed;
    outcome.exit_code = 6;
    outcome.reason = failure;
    outcome.rows = recording_->undisturbed() ? recording_->held().count : 0;
  }

  void finish(const Simulation& simulation, Outcome& outcome) {
    if (recording_) {
      for (const std::string& text : simulation.warnings()) recording_->log().write("warning", text);
      close(outcome);
    }
    RunRecord record{model_,
                     channels_,
                     assembled_->start.facts,
                     outcome,
                     simulation.statistics(),
                     simulation.clearances(),
                     simulation.last_row(),
                     advice_,
                     warnings_of(diagnostics_, simulation.warnings()),
                     recording_ ? recording_->files() : std::vector<std::string>()};
    if (recording_) recording_->bearing(simulation.clearances());
    record.hashes = recording_ ? recording_->hashes() : rows_->hashes();
    record.provenance = recording_ ? recording_->provenance() : provenance(model_, making_of(*run_->model, request_));
    record.provenance["hashes"] = record.hashes;
    record.extremes = simulation.extremes();
    record.trust.add(outcome.doubts);
    doubt_input(diagnostics_, record.trust);
    judge(record, record.trust);
    run_->summary = summary(record);
    run_->summary["performance"]["resumed"] = 0;
    run_->summary["performance"]["resumed_from"] = nullptr;
    seal(outcome);
    run_->status = status_word(outcome.status);
    run_->reason = outcome.reason;
    run_->exit_code = outcome.exit_code;
    run_->warnings = std::move(record.warnings);
    run_->rows = std::move(rows_);
  }

  void seal(const Outcome& outcome) {
    if (!recording_) return;
    try {
      recording_->seal(run_->summary);
    } catch (const Error&) {
      if (outcome.exit_code != 6) throw;
    }
  }

  const Model& model_;
  const Channels& channels_;
  const RunRequest& request_;
  std::shared_ptr<KeptRun> run_;
  Diagnostics diagnostics_;
  std::unique_ptr<AssembledModel> assembled_;
  std::unique_ptr<KeptRows> rows_;
  ContactAdvice advice_{model_};
  std::optional<Recording> recording_;
  std::vector<Sink*> sinks_;
};

/// Writes rows and events of `run` in blocks.
void write_rows(const KeptRun& run, std::span<const std::unique_ptr<RecordWriter>> writers) {
  constexpr std::size_t rows_at_once = 1024;
  const ColumnBlock& block = run.rows->block();
  std::vector<double> rows;
  for (std::size_t row = 0; row < block.rows(); ++row) {
    for (std::size_t column = 0; column < block.columns(); ++column) rows.push_back(block.at(row, column));
    if ((row + 1) % rows_at_once != 0 && row + 1 < block.rows()) continue;
    for (const auto& writer : writers) writer->write({rows, {}});
    rows.clear();
  }
  for (const auto& writer : writers) {
    writer->write({{}, run.rows->events()});
    writer->close();
    if (!writer->failure().empty()) throw Error(Error::Category::file, "cannot-write", writer->failure());
  }
}

}  // namespace

std::shared_ptr<KeptRun> run_model(const std::shared_ptr<const OpenedModel>& model, const RunRequest& request,
                                   const std::function<bool(double, long)>& tick) {
  try {
    return KeptRunJob(model, request).execute(tick);
  } catch (const Error& error) {
    model->refuse(error);
  }
}

void save_run(const KeptRun& run, const std::filesystem::path& path, bool force, ResultFormat format) {
  const Model& model = run.model->model();
  check_result_directory(path, force);
  const ResultDirectory directory(path, force);
  directory.write(model_copy_name(model), model.text);
  for (const InputFile& input : model.inputs) directory.write("inputs/" + input.name, input.text);
  const RecordLayout& layout = run.rows->layout();
  RecordLayout whole = layout;
  std::vector<std::unique_ptr<RecordWriter>> writers;
  writers.push_back(std::make_unique<EventTextWriter>(directory.file("events.csv"), layout));
  if (format != ResultFormat::hdf5) {
    writers.push_back(std::make_unique<RowTextWriter>(directory.file("results.csv"), layout));
  }
  Hdf5Writer* hdf5 = nullptr;
  if (format != ResultFormat::csv) {
    whole.attributes = attributes_of(model, run.summary.value("provenance", Json()));
    auto writer = std::make_unique<Hdf5Writer>(
        directory.file("results.h5"), whole,
        Hdf5Writer::Options{.expected_rows = std::max<std::size_t>(run.rows->block().rows(), 1)});
    hdf5 = writer.get();
    writers.push_back(std::move(writer));
  }
  write_rows(run, writers);
  Json summary = run.summary;
  std::vector<std::string> files = directory.files();
  files.insert(std::ranges::lower_bound(files, "summary.json"), "summary.json");
  summary["files"] = files;
  if (hdf5 != nullptr) {
    hdf5->finish(run.bearings, json_text(summary));
    if (!hdf5->failure().empty()) throw Error(Error::Category::file, "cannot-write", hdf5->failure());
  }
  directory.write("summary.json", json_text(summary));
}

}  // namespace freeplay
