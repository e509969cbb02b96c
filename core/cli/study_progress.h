// StudyProgress: how far a study is, on a terminal.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <utility>

#include "cli/progress_line.h"

namespace freeplay {

class StudyProgress {
 public:
  StudyProgress(std::uint64_t total, bool shown) : total_(total), line_(shown) {}

  void update(std::uint64_t done, std::uint64_t failed);

 private:
  using Clock = std::chrono::steady_clock;

  std::uint64_t total_;
  ProgressLine line_;
  std::deque<std::pair<Clock::time_point, std::uint64_t>> seen_;  // of the last 10 s
};

}  // namespace freeplay
