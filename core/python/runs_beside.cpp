#include "python/runs_beside.h"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <thread>

#include <fmt/format.h>

#include "base/caught_error.h"
#include "base/error.h"
#include "base/processors.h"
#include "job/verification_record.h"
#include "python/ongoing_run.h"
#include "python/refusal.h"
#include "results/repeat_summary.h"
#include "results/summary.h"
#include "run/play_start.h"

namespace freeplay {
namespace {

constexpr int runs_disagree = 7;                // exit code
constexpr double same_instant_of_twins = 1e-9;  // of the interval

/// The run had come to its end, one beside it that its summary needs had not.
void interrupted_beside(Outcome& outcome, const char* other) {
  outcome.exit_code = 130;
  outcome.status = RunStatus::interrupted;
  outcome.reason = fmt::format("interrupted during {}: this one had come to its end", other);
}

std::string words_of(const std::exception& exception) {
  const auto* refusal = dynamic_cast<const Refusal*>(&exception);
  if (refusal == nullptr) return error_of(exception).message();
  const Json& messages = refusal->messages();
  return messages.empty() ? refusal->text() : messages.back().value("message", refusal->text());
}

}  // namespace

void TwinMemory::row(std::span<const double> values) {
  all_.resize(all_.size() + width());
  numbers_.pick(values, std::span(all_).last(width()));
}

RunsBeside::RunsBeside(const OpenedModel& opened, const RunRequest& request)
    : opened_(opened), request_(request), plan_(repeat_plan(request.repeat, request.seed)) {
  const KeptWords words = kept_words(opened, request);
  require_together(words);
  if (request.twin) require_twin(opened.model());
  if (plan_.runs > 0) require_repeatable(opened.model());
  if (request.verify) rows_.emplace(opened.channels());
  if (request.twin) twin_rows_.emplace(opened.model(), opened.channels());
}

std::vector<Sink*> RunsBeside::sinks() {
  std::vector<Sink*> sinks;
  if (rows_) sinks.push_back(&*rows_);
  if (twin_rows_) sinks.push_back(&*twin_rows_);
  return sinks;
}

Json RunsBeside::compare(const TwinMemory& other) const {
  const double same = same_instant_of_twins * opened_.model().settings.interval;
  const std::size_t width = other.width();
  const std::span<const double> mine(twin_rows_->numbers()), theirs(other.numbers());
  TwinComparison comparison(opened_.model());
  std::size_t next = 0;
  for (std::size_t i = 0; i < mine.size(); i += width) {
    // One of the two may have rows that the other has not.
    while (next < theirs.size() && theirs[next] < mine[i] - same) next += width;
    if (next >= theirs.size() || theirs[next] > mine[i] + same) continue;
    comparison.add(mine.subspan(i, width), theirs.subspan(next, width));
    next += width;
  }
  return comparison.json();
}

void RunsBeside::run_twin(Outcome& outcome, const RunTick& tick) {
  if (!twin_rows_ || outcome.status == RunStatus::interrupted) return;
  std::string trouble;
  try {
    const std::shared_ptr<const OpenedModel> model = opened_.twin();
    TwinMemory rows(model->model(), model->channels());
    RunRequest request{.call = request_.call, .inputs = request_.inputs, .also = &rows};
    if (request_.out) request.out = *request_.out / "twin";
    request.force = true;  // what an earlier run left of it belongs to this result
    OngoingRun run(model, request, tick);
    run.run_to_end();
    const std::shared_ptr<KeptRun> ended = run.finish();
    if (ended->exit_code == 0) twin_ = compare(rows);
    if (ended->exit_code == 130) return interrupted_beside(outcome, "the run without clearances of --twin");
    if (ended->exit_code != 0) trouble = ended->reason;
  } catch (const std::exception& exception) {
    trouble = words_of(exception);
  }
  if (!trouble.empty()) warnings_.push_back("--twin: the run without clearances failed: " + trouble);
}

void RunsBeside::verify(const System& system, Outcome& outcome, const Statistics& statistics, const RunTick& tick) {
  if (!rows_ || outcome.exit_code != 0) return;
  const BuildOptions build = build_options(opened_.request().words);
  const LoadOptions load{opened_.request().load};
  bool cut = false;
  const VerifiedRun run{[&](const BuildOptions& other) { return opened_.read_with(other); },
                        build,
                        load,
                        system,
                        outcome,
                        statistics,
                        rows_->table(),
                        [&] { return cut = cut || !tick(outcome.time, outcome.steps); }};
  std::string trouble;
  verification_ = verify_run(run, trouble);
  if (!trouble.empty()) warnings_.push_back("--verify: " + trouble);
  if (verification_ && verification_->agreement == Agreement::disagree) {
    warnings_.push_back("--verify: " + agreement_text(*verification_));
    outcome.exit_code = runs_disagree;
  }
  if (cut && outcome.exit_code == 0) interrupted_beside(outcome, "the second run of --verify");
}

void RunsBeside::repeat(Outcome& outcome, Json& summary, const RunTick& tick) {
  if (plan_.runs == 0) return;
  std::atomic<int> stop{outcome.status == RunStatus::interrupted ? 1 : 0};
  RepeatWork work(opened_.model(), plan_, &stop);
  RepeatSummary found(plan_.runs, plan_.seed, start_change(opened_.model()));
  std::mutex mutex;  // of `found`
  std::atomic<std::uint64_t> next{0}, working{0};
  const auto run = [&] {
    for (std::uint64_t point = next++; point < work.points() && stop == 0; point = next++) {
      const StudyOutcome one = work.run(point, {});
      const std::lock_guard lock(mutex);
      if (one.exit_code == 0) found.add(point + 1, one.values);
      if (one.exit_code != 0 && stop == 0) found.fail(point + 1, one.exit_code, one.message);
    }
    --working;
  };
  const auto threads = std::min<std::uint64_t>(static_cast<std::uint64_t>(processor_count()), work.points());
  working = threads;
  {
    std::vector<std::jthread> pool;
    for (std::uint64_t i = 0; i < threads; ++i) pool.emplace_back(run);
    for (int waits = 0; working > 0; ++waits) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      if (waits % 5 == 4 && stop == 0 && !tick(outcome.time, outcome.steps)) stop = 1;
    }
  }
  const bool came_to_its_end = outcome.status == RunStatus::completed || outcome.status == RunStatus::stopped;
  if (came_to_its_end) found.add(0, RepeatSummary::values_of(summary));
  if (outcome.status == RunStatus::failed) found.fail(0, outcome.exit_code, outcome.reason);
  summary["repeat"] = found.json(summary);
  if (outcome.exit_code != 0) return;
  if (stop != 0) {
    interrupted_beside(outcome, "the other runs of --repeat");
    outcome.reason = "interrupted during the other runs of --repeat: the first one had come to its end";
    summary["status"] = status_word(outcome.status);
    summary["exit_code"] = outcome.exit_code;
    summary["stop_reason"] = outcome.reason;
  } else if (!summary["repeat"]["failed"].empty()) {
    outcome.exit_code = summary["repeat"]["failed"][0]["exit_code"].get<int>();
  }
}

}  // namespace freeplay
