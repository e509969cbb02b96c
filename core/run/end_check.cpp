#include "run/end_check.h"

#include <fmt/format.h>

namespace freeplay {

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
