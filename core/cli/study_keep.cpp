#include "cli/study_keep.h"

#include <system_error>

#include <fmt/format.h>

#include "base/error.h"
#include "base/option_value.h"
#include "base/text.h"
#include "cli/failure.h"
#include "cli/own_program.h"
#include "cli/study_progress.h"
#include "cli/terminal.h"
#include "study/point_words.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t most_kept = 10'000;  // result directories without --yes
constexpr int code_of_unwritten = 6;         // exit code

}  // namespace

KeptResults::KeptResults(const StudyOptions& options, const CommonOptions& common, OpenStudy& study,
                         const StudyFolder& folder)
    : common_(common), study_(study), folder_(folder) {
  if (options.keep.empty()) return;
  require_word("--keep", options.keep, {"none", "failed", "all"});
  if (options.keep != "failed" && options.keep != "all") return;
  which_ = options.keep == "all" ? Which::all : Which::failed;
  const StudyPlan& plan = study.plan();
  if (plan.chained() || plan.section().analysis != nullptr) {
    throw Error(Error::Category::usage, "bad-value",
                "--keep is for points that are runs of their own, not for chains or analyses");
  }
  if (which_ == Which::all && plan.points() > most_kept && !options.yes) {
    throw Error(Error::Category::usage, "too-large",
                fmt::format("--keep all would make {} result directories", plan.points()), {}, "--yes makes them");
  }
}

fs::path KeptResults::place(std::uint64_t point) const {
  return folder_.path() / "kept" / fmt::format("{:04}", point / 1000) / fmt::format("{}", point);
}

bool KeptResults::is_there(std::uint64_t point) const {
  std::error_code ignored;
  return fs::exists(place(point) / "summary.json", ignored);
}

std::vector<std::uint64_t> KeptResults::lacking(const ScheduleOptions& schedule, const Question& has_row,
                                                const Question& failed) {
  std::vector<std::uint64_t> points;
  const StudyPlan& plan = study_.plan();
  for (std::uint64_t unit = schedule.shard.part - 1; unit < plan.units(); unit += schedule.shard.parts) {
    const std::uint64_t point = plan.unit_point(unit, 0);
    if (schedule.only && !holds(*schedule.only, point)) continue;
    if (!has_row(point) || (which_ == Which::failed && !failed(point))) continue;
    ++wanted_;
    if (is_there(point)) {
      ++there_;
    } else {
      points.push_back(point);
    }
  }
  return points;
}

StudyOutcome KeptResults::run(const StudyPoint& point) const {
  std::vector<std::string> words = point_words(study_.plan(), fs::absolute(folder_.path()), point, common_.plugins);
  words.insert(words.end(), {"--quiet", "--allow-plugins", "--force", "--out", place(point.index).string()});
  const ProgramEnd end = run_own_program(words, false);
  StudyOutcome outcome;
  outcome.exit_code = end.exit_code;
  outcome.message = end.messages;
  return outcome;
}

void KeptResults::make(const ScheduleOptions& schedule, const Question& has_row, const Question& failed,
                       const PoolOptions& pool_options, const std::atomic<int>& interrupts) {
  if (which_ == Which::none) return;
  const std::vector<std::uint64_t> points = lacking(schedule, has_row, failed);
  study_.work().do_instead([this](const StudyPoint& point) { return run(point); });
  WorkerPool pool(study_.work(), pool_options);
  StudyProgress progress(points.size(), stderr_is_terminal() && !common_.quiet);
  std::size_t given = 0, ended = 0;
  std::string unwritten;
  pool.run(
      [&](StudyTask& task) {
        if (given == points.size() || !unwritten.empty()) return false;
        const UnitPlace at = study_.plan().place_of(points[given++]);
        task = {at.unit, at.place, at.place + 1, {}};
        return true;
      },
      [&](std::uint64_t point, const StudyOutcome& outcome) {
        ++ended;
        ++(is_there(point) ? there_ : fruitless_);
        if (outcome.exit_code == code_of_unwritten && unwritten.empty()) unwritten = outcome.message + " ";
      },
      [&] {
        progress.update(ended, 0);
        return interrupts == 0;
      });
  if (unwritten.empty()) return;
  throw Error(Error::Category::file, "cannot-write",
              fmt::format("the result of a point cannot be kept: {}", printable(unwritten)));
}

std::string KeptResults::message() const {
  if (which_ == Which::none) return {};
  std::string text = fmt::format("  kept       {} of {} in {}", there_, wanted_, (folder_.path() / "kept").string());
  if (fruitless_ > 0) text += fmt::format("; {} fail before there is a result", fruitless_);
  return text + "\n";
}

}  // namespace freeplay
