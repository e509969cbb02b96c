#include "cli/study_progress.h"

#include <fmt/format.h>

namespace freeplay {
namespace {
constexpr std::chrono::seconds looked_back{10};
}

void StudyProgress::update(std::uint64_t done, std::uint64_t failed) {
  if (!line_.due()) return;
  const Clock::time_point now = Clock::now();
  while (seen_.size() > 1 && now - seen_.front().first > looked_back) seen_.pop_front();
  seen_.emplace_back(now, done);
  const double seconds = std::chrono::duration<double>(now - seen_.front().first).count();
  const double rate = seconds > 0.0 ? static_cast<double>(done - seen_.front().second) / seconds : 0.0;
  const std::string left =
      rate > 0.0 ? clock_text(static_cast<double>(total_ - std::min(done, total_)) / rate) : "--:--";
  line_.show(fmt::format("{:4} %  {} / {} points  {} failed  {:.3g} /s  left {}",
                         total_ == 0 ? 100 : 100 * done / total_, done, total_, failed, rate, left));
}

}  // namespace freeplay
