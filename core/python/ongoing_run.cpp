#include "python/ongoing_run.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "base/archive.h"
#include "base/sha256.h"
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

}  // namespace

KeptWords kept_words(const OpenedModel& opened, const RunRequest& request) {
  KeptWords words;
  static_cast<RunWords&>(words) = opened.request().words;
  words.inputs = request.inputs;
  words.repeat = request.repeat;
  words.seed = request.seed;
  words.plugins = opened.request().load.plugins;
  words.verify = request.verify;
  words.twin = request.twin;
  words.strict = opened.request().load.strict;
  return words;
}

OngoingRun::OngoingRun(std::shared_ptr<const OpenedModel> model, const RunRequest& request, RunTick tick)
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

OngoingRun::~OngoingRun() { leave_files_of_others(); }

void OngoingRun::leave_files_of_others() {
  if (!recording_ || process_ == ::getpid()) return;
  files_.leave();
  checkpoints_.reset();
  static_cast<void>(recording_.release());  // its thread is in the other process
}

void OngoingRun::begin() {
  run_->model = opened_;
  beside_ = std::make_unique<RunsBeside>(*opened_, request_);
  const double period = checkpoint_period(request_.checkpoint);
  if (request_.out && request_.resumed == nullptr) check_result_directory(*request_.out, request_.force);
  rows_ = std::make_unique<KeptRows>(model_, channels_);
  if (!request_.inputs.empty()) {
    given_ = read_inputs(request_.inputs, model_, diagnostics_, run_->asked);
    if (diagnostics_.has_errors()) throw Refusal(diagnostics_, 3);
  }
  assembled_ = opened_->assemble(diagnostics_);
  require_sound_integrator(assembled_->system);
  const Making making = freeplay::making(kept_words(*opened_, request_), request_.call, model_);
  provenance_ = provenance(model_, making);
  add_asked(provenance_);
  if (request_.resumed != nullptr) require_same_making(request_.resumed->checkpoint, provenance_);
  if (request_.state) read_state();
  if (request_.out) begin_recording(making);
  begin_simulation();
  if (state_) restore();
  if (recording_ && !request_.stepped) {
    Json made = made_from(kept_words(*opened_, request_), request_.call, model_);
    made["provenance"] = provenance_;
    checkpoints_.emplace(*recording_, *request_.out, std::move(made), period);
    from() == nullptr ? checkpoints_->begin() : checkpoints_->go_on(*from());
    if (checkpoints_->resumed() > 0) recording_->log().write("note", checkpoints_->resumed_words());
  }
  hooks_.interrupt = checkpoints_ ? &stop_ : &asked_;
  if (checkpoints_) hooks_.stepped = [this] { look_up(); };
  hooks_.progress = [this](double t, long steps) {
    if (!tick_(t, steps)) asked_ = 1;
    if (recording_ && !recording_->ok()) (checkpoints_ ? stop_ : asked_) = 1;
  };
  if (request_.profile) hooks_.profile = &profile_;
  simulation_->begin(hooks_);
}

// Where the run was interrupted it can go on.
void OngoingRun::look_up() {
  const bool asked = asked_ != 0;
  if (asked || checkpoints_->due()) checkpoints_->add(simulation_->save());
  if (asked) stop_ = 1;
}

/// Where the run goes on; null: at its start.
const Checkpoint* OngoingRun::from() const {
  if (state_) return &*state_;
  return request_.resumed != nullptr && request_.resumed->goes_on ? &request_.resumed->checkpoint : nullptr;
}

void OngoingRun::begin_recording(const Making& making) {
  require_thread();
  if (from() == nullptr) {
    recording_ = std::make_unique<Recording>(*request_.out, request_.force, model_, channels_, making);
  } else {
    // NOLINTNEXTLINE(modernize-make-unique): a recording cannot be moved, and go_on() makes it in its place
    recording_.reset(new Recording(Recording::go_on(*request_.out, model_, channels_, making, kept_part_of(*from()))));
  }
  files_.begin(recording_->sinks());
  sinks_.push_back(&files_);
  if (!run_->asked.name.empty()) recording_->add("inputs/" + run_->asked.name, run_->asked.text);
  begin_log();
}

void OngoingRun::begin_simulation() {
  sinks_.push_back(rows_.get());
  sinks_.push_back(&advice_);
  for (Sink* const sink : beside_->sinks()) sinks_.push_back(sink);
  if (request_.also != nullptr) sinks_.push_back(request_.also);
  if (from() != nullptr && from()->state) {
    simulation_ =
        std::make_unique<Simulation>(assembled_->system, assembled_->start, channels_, sinks_, *from()->state);
  } else {
    simulation_ = std::make_unique<Simulation>(assembled_->system, assembled_->start, channels_, sinks_);
  }
}

namespace {

Json settings_of_run(const Model& model) {
  Json settings = settings_json(model);
  settings["channels"] = model.settings.channels;
  return settings;
}

}  // namespace

std::string OngoingRun::checkpoint() const {
  Checkpoint out{.made = {{"program", program_of_checkpoints()},
                          {"settings", settings_of_run(model_)},
                          {"provenance", provenance_}},
                 .state = simulation_->save()};
  std::vector<double> course;
  for (const InputCourse::Row& row : course_.rows) {
    course.push_back(row.time);
    course.insert(course.end(), row.efforts.begin(), row.efforts.end());
  }
  ArchiveWriter write(out.files);
  write(*rows_, advice_);
  write.list(course);
  write.list(efforts());
  return bytes_of(out);
}

void OngoingRun::read_state() {
  state_ = checkpoint_of(*request_.state, "checkpoint");
  require_same_program(*state_);
  require_same_making(*state_, provenance_);
  require_same_settings(*state_, settings_of_run(model_));
}

void OngoingRun::restore() {
  std::vector<double> course, efforts;
  ArchiveReader read(state_->files);
  read(*rows_, advice_);
  read.list(course);
  read.list(efforts);
  read.finish();
  const std::size_t inputs = this->efforts().size();
  ArchiveReader::require(efforts.size() == inputs && course.size() % (inputs + 1) == 0);
  for (auto row = course.begin(); row != course.end(); row += static_cast<std::ptrdiff_t>(inputs) + 1) {
    course_.rows.push_back({*row, {row + 1, row + 1 + static_cast<std::ptrdiff_t>(inputs)}});
  }
  simulation_->set_efforts(efforts);
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
  for (const InputCourse::Row& row : given_.rows) {
    if (row.time < time()) continue;  // set before the run was interrupted
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

// The table of inputs is one of the files that the run was made from.
void OngoingRun::add_asked(Json& record) {
  InputFile& asked = run_->asked;
  if (asked.name.empty()) return;
  while (std::ranges::find(model_.inputs, asked.name, &InputFile::name) != model_.inputs.end()) {
    asked.name.insert(0, "run-");
  }
  record["inputs"].push_back({{"name", asked.name}, {"sha256", sha256(asked.text)}});
}

// What a script set, for `reproduce`.
void OngoingRun::keep_course() {
  if (!has_inputs_) return;
  run_->inputs = input_text(model_, given_.rows.empty() ? course_ : given_);
  if (!request_.stepped || course_.rows.empty()) return;
  run_->asked = {"inputs.csv", run_->inputs};
  add_asked(provenance_);
  for (const char* const word : {"--inputs", "inputs.csv"}) provenance_["arguments"].push_back(word);
}

// Ends the files. What could not be written is what the run reports.
void OngoingRun::close(Outcome& outcome) {
  if (!outcome.reason.empty()) {
    recording_->log().write(outcome.exit_code == 0 ? "note" : "error", outcome.reason);
  }
  std::string failure = recording_->close();
  try {
    const bool ended = outcome.status == RunStatus::completed || outcome.status == RunStatus::stopped;
    if (checkpoints_ && failure.empty() && ended) checkpoints_->end(outcome.rows);
    if (!run_->inputs.empty()) recording_->add("inputs.csv", run_->inputs);
    if (request_.stepped && !run_->asked.name.empty()) recording_->add("inputs/" + run_->asked.name, run_->asked.text);
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
    keep_course();
    beside_->run_twin(outcome, tick_);
    beside_->verify(assembled_->system, outcome, simulation_->statistics(), tick_);
    if (recording_) {
      for (const std::string& text : warnings()) recording_->log().write("warning", text);
      close(outcome);
    }
    keep_summary(outcome);
    beside_->repeat(outcome, run_->summary, tick_);
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

// Met on the way, and by the runs beside.
std::vector<std::string> OngoingRun::warnings() const {
  const std::span<const std::string> met = simulation_->warnings();
  std::vector<std::string> all(met.begin(), met.end());
  all.insert(all.end(), beside_->warnings().begin(), beside_->warnings().end());
  return all;
}

void OngoingRun::keep_summary(const Outcome& outcome) {
  RunRecord record{model_,
                   channels_,
                   assembled_->start.facts,
                   outcome,
                   simulation_->statistics(),
                   simulation_->clearances(),
                   simulation_->last_row(),
                   recording_ ? recording_->advice() : advice_,
                   warnings_of(diagnostics_, warnings()),
                   recording_ ? recording_->files() : std::vector<std::string>()};
  if (beside_->verification()) add_verification(*beside_->verification(), record);
  if (recording_) recording_->bearing(simulation_->clearances());
  record.hashes = recording_ ? recording_->hashes() : rows_->hashes();
  record.provenance = provenance_;
  record.provenance["hashes"] = record.hashes;
  record.extremes = simulation_->extremes();
  record.twin = beside_->twin();
  record.memory = simulation_->memory();
  record.trust.add(outcome.doubts);
  doubt_input(diagnostics_, record.trust);
  judge(record, record.trust);
  run_->summary = summary(record);
  run_->summary["performance"]["resumed"] = checkpoints_ ? checkpoints_->resumed() : 0;
  run_->summary["performance"]["resumed_from"] = checkpoints_ ? checkpoints_->resumed_from() : Json();
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
