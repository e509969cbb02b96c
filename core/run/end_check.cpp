#include "run/end_check.h"

#include <fmt/format.h>

#include "base/index.h"

namespace freeplay {

EndCheck::EndCheck(RunContext& run, Recorder& recorder) : run_(run), recorder_(recorder) {
  for (const StopCondition& stop : run.settings.stop) stop_columns_.push_back(run.channels.find(stop.channel));
}

bool EndCheck::check_stop() {
  for (std::size_t i = 0; i < run_.settings.stop.size(); ++i) {
    const StopCondition& stop = run_.settings.stop[i];
    if (stop_columns_[i] < 0 || run_.accepted.t() < stop.after) continue;
    if (!recorder_.know_row()) return false;
    const double value = recorder_.row()[at(stop_columns_[i])];
    if (stop.above ? value <= stop.limit : value >= stop.limit) continue;
    run_.outcome.status = RunStatus::stopped;
    run_.outcome.reason = fmt::format("{} = {:.9g} is {} {:.9g} at t = {:.9g} s", stop.channel, value,
                                      stop.above ? "above" : "below", stop.limit, run_.accepted.t());
    return false;
  }
  return true;
}

bool EndCheck::check_interrupt(const RunHooks& hooks) {
  if (hooks.interrupt && hooks.interrupt->load(std::memory_order_relaxed) != 0) {
    run_.outcome.status = RunStatus::interrupted;
    run_.outcome.exit_code = 130;
    run_.outcome.reason = fmt::format("interrupted at t = {:.9g} s", run_.accepted.t());
    return false;
  }
  if (hooks.progress && run_.outcome.steps % 16 == 0) {
    const double now = seconds();
    if (now - last_progress_ >= 0.1) {
      last_progress_ = now;
      hooks.progress(run_.accepted.t(), run_.outcome.steps);
    }
  }
  return true;
}

}  // namespace freeplay
