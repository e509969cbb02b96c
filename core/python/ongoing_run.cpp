#include "python/ongoing_run.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "base/version.h"
#include "load/input_file.h"
#include "python/refusal.h"
#include "results/directory.h"
#include "results/input_doubts.h"
#include "results/judgement.h"
#include "results/record_thread.h"
#include "results/summary.h"

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
  if (request.inputs) making.arguments.insert(making.arguments.end(), {"--inputs", request.inputs->string()});
  for (const std::string& plugin : opened.request().plugins)
    making.arguments.insert(making.arguments.end(), {"--plugin", plugin});
  return making;
}

}  // namespace

OngoingRun::OngoingRun(std::shared_ptr<const OpenedModel> model, const RunRequest& request, Tick tick)
    : opened_(std::move(model)),
      model_(opened_->model()),
      channels_(opened_->channels()),
      request_(request),
      tick_(std::move(tick)),
      process_(::getpid()),
      run_(std::make_shared<KeptRun>()),
      has_inputs_(!inputs_of(model_).empty()) {
  try {
    begin();
  } catch (const Error& error) {
    opened_->refuse(error);
  }
}

OngoingRun::~OngoingRun() {
  if (!at_home()) static_cast<void>(recording_.release());  // its thread is in the other process
}

bool OngoingRun::at_home() const { return !recording_ || process_ == ::getpid(); }

void OngoingRun::begin() {
  run_->model = opened_;
  if (request_.out) check_result_directory(*request_.out, request_.force);
  rows_ = std::make_unique<KeptRows>(model_, channels_);
  if (request_.inputs) {
    InputFile file;
    asked_ = read_inputs(request_.inputs->string(), model_, diagnostics_, file);
    if (diagnostics_.has_errors()) throw Refusal(diagnostics_, 3);
  }
  assembled_ = opened_->assemble(diagnostics_);
  require_sound_integrator(assembled_->system);
  if (request_.out) {
    require_thread();
    recording_ =
        std::make_unique<Recording>(*request_.out, request_.force, model_, channels_, making_of(*opened_, request_));
    sinks_ = recording_->sinks();
    begin_log();
  }
  sinks_.push_back(rows_.get());
  sinks_.push_back(&advice_);
  simulation_ = std::make_unique<Simulation>(assembled_->system, assembled_->start, channels_, sinks_);
  hooks_.interrupt = &stop_;
  hooks_.progress = [this](double t, long steps) {
    if (!tick_(t, steps) || (recording_ && !recording_->ok())) stop_ = 1;
  };
  if (request_.profile) hooks_.profile = &profile_;
  simulation_->begin(hooks_);
}

void OngoingRun::begin_log() {
  recording_->log().write("note", fmt::format("freeplay {} runs {} from {:g} s to {:g} s", program_version, model_.file,
                                              model_.settings.start, model_.settings.end));
  for (const std::string& text : warnings_of(diagnostics_, {})) recording_->log().write("warning", text);
}

bool OngoingRun::advance(const RunGoal& goal) {
  try {
    if (!simulation_->advance(goal)) return false;
  } catch (const Error& error) {
    opened_->refuse(error);
  }
  if (has_inputs_ && std::isfinite(goal.until) && std::abs(time() - goal.until) <= 1e-6 * model_.settings.step) {
    note_instant();
  }
  return true;
}

void OngoingRun::run_to_end() {
  for (const InputCourse::Row& row : asked_.rows) {
    if (!advance({.until = row.time})) return;
    set_efforts(row.efforts);
  }
  advance({});
}

// The inputs from now on, so that another run can land here and set them.
void OngoingRun::note_instant() {
  if (course_.rows.empty() || course_.rows.back().time < time()) course_.rows.push_back({time(), {}});
  course_.rows.back().efforts = efforts();
}

void OngoingRun::set_efforts(const std::vector<double>& efforts) {
  if (efforts == this->efforts()) return;
  simulation_->set_efforts(efforts);
  note_instant();
}

bool OngoingRun::read_row(std::span<double> row) {
  try {
    if (!simulation_->know_row()) return false;
  } catch (const Error& error) {
    opened_->refuse(error);
  }
  read_last_row(row);
  return true;
}

void OngoingRun::read_last_row(std::span<double> row) const {
  const std::span<const double> all = simulation_->last_row();
  const std::span<const std::size_t> picked = rows_->picked();
  for (std::size_t i = 0; i < picked.size(); ++i) row[i] = all[picked[i]];
}

void OngoingRun::keep_profile() {
  if (!request_.profile) return;
  for (const auto& [phase, name] : phases) {
    run_->profile.push_back({name, profile_.seconds(phase), profile_.count(phase)});
  }
}

// Ends the files. What could not be written is what the run reports.
void OngoingRun::close(Outcome& outcome) {
  if (!outcome.reason.empty()) {
    recording_->log().write(outcome.exit_code == 0 ? "note" : "error", outcome.reason);
  }
  std::string failure = recording_->close();
  try {
    if (!run_->inputs.empty()) recording_->add("inputs.csv", run_->inputs);
  } catch (const Error& error) {
    if (failure.empty()) failure = error.message();
  }
  if (failure.empty()) return;
  outcome.status = RunStatus::failed;
  outcome.exit_code = 6;
  outcome.reason = failure;
  outcome.rows = recording_->undisturbed() ? recording_->held().count : 0;
}

std::shared_ptr<KeptRun> OngoingRun::finish() {
  try {
    Outcome outcome = simulation_->end();
    rows_->finish();
    keep_profile();
    run_->record = rows_->record();
    run_->bearings = bearing_tables(run_->record.layout, simulation_->clearances());
    if (has_inputs_) run_->inputs = input_text(model_, course_);
    if (recording_) {
      for (const std::string& text : simulation_->warnings()) recording_->log().write("warning", text);
      close(outcome);
    }
    keep_summary(outcome);
    seal(outcome);
    run_->status = status_word(outcome.status);
    run_->reason = outcome.reason;
    run_->exit_code = outcome.exit_code;
  } catch (const Error& error) {
    opened_->refuse(error);
  }
  recording_.reset();
  return run_;
}

void OngoingRun::keep_summary(const Outcome& outcome) {
  RunRecord record{model_,
                   channels_,
                   assembled_->start.facts,
                   outcome,
                   simulation_->statistics(),
                   simulation_->clearances(),
                   simulation_->last_row(),
                   advice_,
                   warnings_of(diagnostics_, simulation_->warnings()),
                   recording_ ? recording_->files() : std::vector<std::string>()};
  if (recording_) recording_->bearing(simulation_->clearances());
  record.hashes = recording_ ? recording_->hashes() : rows_->hashes();
  record.provenance = recording_ ? recording_->provenance() : provenance(model_, making_of(*opened_, request_));
  record.provenance["hashes"] = record.hashes;
  record.extremes = simulation_->extremes();
  record.trust.add(outcome.doubts);
  doubt_input(diagnostics_, record.trust);
  judge(record, record.trust);
  run_->summary = summary(record);
  run_->summary["performance"]["resumed"] = 0;
  run_->summary["performance"]["resumed_from"] = nullptr;
  run_->warnings = std::move(record.warnings);
}

void OngoingRun::seal(const Outcome& outcome) {
  if (!recording_) return;
  try {
    recording_->seal(run_->summary);
  } catch (const Error&) {
    if (outcome.exit_code != 6) throw;
  }
}

}  // namespace freeplay
