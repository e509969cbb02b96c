#include "python/stepped_run.h"

#include <utility>

namespace freeplay {

SteppedRun::SteppedRun(const std::shared_ptr<const OpenedModel>& model, const RunRequest& request, RunTick tick)
    : run_(model, request, std::move(tick)), row_(run_.columns()) {}

void SteppedRun::require_going() {
  if (ended_) throw Error(Error::Category::usage, "usage", "the simulation is over (" + ended_->status + ")");
  run_.leave_files_of_others();
}

bool SteppedRun::advance(const RunGoal& goal) {
  if (ended_) return false;
  require_going();
  known_ = false;
  if (!run_.advance(goal)) {
    end();
  } else if (renews_) {
    row(true);
  }
  return ended_ == nullptr;
}

void SteppedRun::close() {
  if (ended_) return;
  require_going();
  end();
}

std::string SteppedRun::checkpoint() {
  require_going();
  return run_.checkpoint();
}

void SteppedRun::end() {
  ended_ = run_.finish();
  run_.read_last_row(row_);
  known_ = true;
}

void SteppedRun::set(std::size_t input, double effort) {
  require_going();
  std::vector<double> efforts = run_.efforts();
  if (efforts[input] == effort) return;
  efforts[input] = effort;
  run_.set_efforts(efforts);
  known_ = false;
  if (renews_) row(true);
}

const std::vector<double>& SteppedRun::row(bool renewed) {
  renews_ = renews_ || renewed;
  if (!known_ && !ended_ && !run_.read_row(row_)) end();  // what was set may fail the run
  known_ = true;
  return row_;
}

}  // namespace freeplay
