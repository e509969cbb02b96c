#include "cli/analysis_watch.h"

#include <algorithm>

#include "cli/interrupt.h"

namespace freeplay {

AnalysisWatch::AnalysisWatch(bool shown)
    : interrupts_(watch_interrupts()), shown_(shown), began_(std::chrono::steady_clock::now()) {}

Tick AnalysisWatch::begin(const char* what, std::size_t total) {
  what_ = what;
  total_ = static_cast<long>(total);
  done_ = 0;
  line_.emplace(shown_);
  return [this](long done) { count(done); };
}

void AnalysisWatch::count(long done) {
  if (interrupts_.load(std::memory_order_relaxed) > 0) throw Interrupted();
  const long all = done_.fetch_add(done, std::memory_order_relaxed) + done;
  constexpr long seldom = 64;
  if (!shown_ || (done > 0 && total_ > 10 * seldom && all % seldom != 0)) return;
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock || std::chrono::steady_clock::now() - began_ < std::chrono::milliseconds(500)) return;
  line_->update(what_, std::max(all - 1, 0L), total_);  // the last one is at work
}

}  // namespace freeplay
