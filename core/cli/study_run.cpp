#include "cli/study_run.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <sys/resource.h>

#include "base/error.h"
#include "base/processors.h"
#include "base/text.h"
#include "cli/failure.h"
#include "cli/interrupt.h"
#include "cli/study_keep.h"
#include "cli/study_progress.h"
#include "cli/study_table.h"
#include "cli/terminal.h"
#include "study/old_rows.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_listed_failures = 10;

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// Processor time of this program and of all workers that have ended [s].
double tree_seconds() {
  double sum = 0.0;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage{};
    if (::getrusage(who, &usage) == 0) sum += seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
  }
  return sum;
}

/// The first file that is not as it was, and the first line there.
std::string difference(const StudyPlan& plan, const StudyFolder& folder) {
  const std::vector<KeptFile> files = plan.kept_files();
  for (const KeptFile& file : files) {
    if (file.path == "inputs/study.json") continue;
    std::ifstream stream(folder.path() / file.path, std::ios::binary);
    const std::string old{std::istreambuf_iterator<char>(stream), {}};
    if (old == file.bytes) continue;
    const auto [ours, theirs] = std::mismatch(file.bytes.begin(), file.bytes.end(), old.begin(), old.end());
    return fmt::format("{} differs from line {} on", file.path, 1 + std::count(file.bytes.begin(), ours, '\n'));
  }
  const Json copies = folder.record().value("copies", Json::object());
  for (const auto& copy : copies.items()) {
    const auto is_it = [&](const KeptFile& file) { return file.path == copy.key(); };
    if (std::ranges::none_of(files, is_it)) return fmt::format("{} is not read any more", copy.key());
  }
  return "what the command line sets differs";
}

class StudyRun {
 public:
  StudyRun(StudyInFolder& opened, const StudyOptions& options, const CommonOptions& common)
      : options_(options),
        common_(common),
        study_(*opened.study),
        plan_(study_.plan()),
        folder_(opened.folder),
        by_folder_(opened.kept),
        began_(std::chrono::steady_clock::now()),
        mark_(study_.mark()) {
    read_options();
    results_.emplace(options_, common_, study_, folder_);
    open_folder();
    table_.emplace(study_, folder_);
    table_->look(mark_, schedule_.only ? Shard{} : schedule_.shard, warn_of_damage(common));
  }

  int run() {
    compute();
    if (interrupts_ == 0) keep();
    const bool interrupted = interrupts_ != 0;
    const bool whole = options_.shard.empty() && !interrupted && table_->done() >= table_->wanted();
    if (whole && (report_.ran > 0 || !folder_.is_merged())) table_->merge();
    tell(whole);
    warn_of_stop();
    if (interrupted) return 130;
    return failed() > 0 && !options_.allow_failed ? 4 : 0;
  }

 private:
  void read_options();
  void open_folder();
  void refuse_changed();
  void extend();
  void keep();
  void compute();
  void tell(bool whole) const;
  void warn_of_stop() const;
  Json report_json(bool whole) const;

  /// Of this shard.
  std::uint64_t total() const { return options_.shard.empty() ? table_->wanted() : shard_points_; }
  std::uint64_t done() const { return table_->done(); }
  std::uint64_t failed() const { return table_->failed(); }
  double wall() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count(); }
  double busy() const { return running_ > 0.0 ? std::min(1.0, report_.busy_seconds / running_ / pool_.jobs) : 0.0; }

  const StudyOptions& options_;
  const CommonOptions& common_;
  OpenStudy& study_;
  const StudyPlan& plan_;
  const StudyFolder& folder_;
  bool by_folder_;  ///< DIR was given, not FILE
  std::chrono::steady_clock::time_point began_;
  StudyMark mark_;
  PoolOptions pool_;
  ScheduleOptions schedule_;
  double sync_ = 1.0, running_ = 0.0;
  std::optional<StudyTable> table_;
  std::optional<KeptResults> results_;
  std::uint64_t shard_points_ = 0;
  EngineReport report_;
  const std::atomic<int>& interrupts_ = watch_interrupts();
};

void StudyRun::read_options() {
  pool_.jobs = options_.jobs.empty() ? processor_count() : static_cast<int>(whole_number("--jobs", options_.jobs, 1));
  pool_.isolate = options_.isolate;
  if (!options_.point_timeout.empty()) {
    pool_.point_timeout = positive_quantity("--point-timeout", options_.point_timeout, dimension::time);
  }
  if (!options_.sync.empty() && options_.sync != "0") {
    sync_ = positive_quantity("--sync", options_.sync, dimension::time);
  } else if (options_.sync == "0") {
    sync_ = 0.0;
  }
  if (!options_.shard.empty()) schedule_.shard = shard_of(options_.shard);
  if (options_.only) schedule_.only = point_ranges("--only", *options_.only, plan_.points());
  schedule_.retry_failed = options_.retry_failed;
  if (options_.extend && options_.restart) {
    throw Error(Error::Category::usage, "usage", "--extend and --restart exclude each other");
  }
}

void StudyRun::open_folder() {
  folder_.require_room();
  if (folder_.holds_study()) {
    if (options_.restart) {
      folder_.forget_extended();
      folder_.set_aside();
    } else if (folder_.record()["study"] != mark_.study || folder_.record()["rows"] != mark_.columns) {
      options_.extend ? extend() : refuse_changed();
    } else if (kept_mark(folder_).program() != mark_.program() && folder_.segments().empty()) {
      folder_.set_aside();  // no rows of another program
    }
  }
  folder_.begin(plan_, mark_, study_record(plan_, mark_, study_.columns()));
}

// Rows of other columns say nothing of these.
void StudyRun::refuse_changed() {
  const std::vector<fs::path> segments = folder_.segments();
  const bool same_columns = folder_.record()["rows"] == mark_.columns;
  const OldRows rows(same_columns ? segments : std::vector<fs::path>{}, study_.layout(), warn_of_damage(common_));
  const bool other_columns = folder_.record()["study"] == mark_.study;
  const std::string what = other_columns ? "its table has other columns" : difference(plan_, folder_);
  throw Error(Error::Category::input, "study-changed",
              by_folder_ && !other_columns
                  ? edited_text(folder_)
                  : fmt::format("the study is not the one of '{}': {}", folder_.path().string(), what),
              {},
              fmt::format("{}--extend keeps {} of {} points, --restart none{}", by_folder_ ? "put it back; " : "",
                          rows.kept(plan_), plan_.points(), by_folder_ ? "" : ", and another --out both"));
}

// The rows that stay are whole on the disk before anything is moved, so that a kill loses none; those of a call that
// was cut short count as well.
void StudyRun::extend() {
  std::vector<fs::path> segments;
  if (folder_.record()["rows"] == mark_.columns) segments = folder_.segments();
  for (const fs::path& segment : folder_.segments()) {
    SegmentReader reader(segment, warn_of_damage(common_));
    if (!reader.header()) continue;
    StudyMark old = mark_;
    old.study = reader.header()->study;
    require_same(*reader.header(), segment, old);
  }
  for (const fs::path& segment : folder_.extending_segments()) {
    const SegmentReader reader(segment, warn_of_damage(common_));
    if (!reader.header() || reader.header()->study != mark_.study) continue;
    require_same(*reader.header(), segment, mark_);
    segments.push_back(segment);
  }
  const OldRows rows(segments, study_.layout(), warn_of_damage(common_));
  std::error_code exists;
  fs::create_directories(folder_.extended(), exists);
  SegmentWriter segment(folder_.extended(),
                        {mark_.study, mark_.program(), mark_.arithmetic, Shard{}, host_name(), utc_now()}, sync_);
  rows.write(plan_, segment);
  folder_.set_aside();
}

void StudyRun::keep() {
  const auto has_row = [&](std::uint64_t point) {
    return table_->is_wanted(point) && table_->scan().done().has(point) && !table_->scan().killed().has(point);
  };
  const auto failed = [&](std::uint64_t point) { return table_->scan().failed().has(point); };
  results_->make(schedule_, has_row, failed, pool_, interrupts_);
}

void StudyRun::compute() {
  Schedule schedule(study_.work(), table_->scan(), schedule_);
  shard_points_ = schedule.points();
  SegmentWriter segment(
      folder_.rows(), {mark_.study, mark_.program(), mark_.arithmetic, schedule_.shard, host_name(), utc_now()}, sync_);
  StudyProgress progress(total(), stderr_is_terminal() && !common_.quiet);
  const auto start = std::chrono::steady_clock::now();
  report_ = run_points(study_.work(), study_.layout(), schedule, table_->scan(), segment, pool_, table_->watch(),
                       [&](const EngineReport&) {
                         progress.update(table_->scan().done().count(), table_->scan().failed().count());
                         return interrupts_ == 0;
                       });
  running_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Json StudyRun::report_json(bool whole) const {
  return {{"name", plan_.name()},
          {"dir", folder_.path().string()},
          {"points", total()},
          {"done", done()},
          {"failed", failed()},
          {"ran", report_.ran},
          {"left", total() - std::min(total(), done())},
          {"jobs", pool_.jobs},
          {"wall_seconds", wall()},
          {"cpu_seconds", tree_seconds()},
          {"busy", busy()},
          {"workers_lost", report_.workers_lost},
          {"table", whole ? Json(folder_.table().string()) : Json(nullptr)}};
}

void StudyRun::tell(bool whole) const {
  if (common_.json) return print_json(report_json(whole));
  if (common_.quiet) return;
  std::string text = fmt::format(
      "{}: {} of {} points done, {} failed, {:.1f} s, {:.3g} points/s, workers busy {:.2f}\n", plan_.name(), done(),
      total(), failed(), wall(), running_ > 0.0 ? static_cast<double>(report_.ran) / running_ : 0.0, busy());
  const auto failures = table_->scan().first_failures(most_listed_failures);
  if (!failures.empty()) {
    text += "  failed ";
    for (const auto& [point, error] : failures) text += fmt::format("  {:>4} {}", point, error);
    text += "\n";
  }
  text += results_->message();
  if (whole) text += fmt::format("  table      {}\n", folder_.table().string());
  print(text);
}

void StudyRun::warn_of_stop() const {
  const auto& rule = table_->rule();
  if (!rule || !rule->end() || rule->reached()) return;
  double widest = 0.0;
  for (const StopInterval& interval : rule->intervals()) widest = std::max(widest, interval.half_width);
  const StopOptions& stop = rule->options();
  print_messages(
      fmt::format("freeplay: warning: `stop` is not reached: after all {} samples '{}' has intervals of up to "
                  "+- {:.3g}, not {} {:g}\n      = it takes more `points`, or a wider interval\n",
                  *rule->end(), stop.reducer, widest, stop.half_width ? "`half_width`" : "`relative`",
                  stop.half_width ? *stop.half_width : stop.relative.value_or(0.0)),
      common_.no_color);
}

}  // namespace

int study_run(const StudyOptions& options, const CommonOptions& common) {
  StudyInFolder opened = open_in_folder(only_study(options, "run", "FILE or DIR"), options, common);
  if (!opened.study) return opened.exit_code;
  return StudyRun(opened, options, common).run();
}

}  // namespace freeplay
