#include "study/point_threads.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

namespace freeplay {
namespace {

constexpr int exit_interrupted = 130;
constexpr std::chrono::milliseconds between_beats{50};

class PointThreads {
 public:
  PointThreads(const PointSource& source, const LoadOptions& options, const std::vector<PointUnit>& units,
               std::size_t points)
      : source_(source), options_(options), units_(units), outcomes_(points) {}

  void run(int workers, const std::function<bool(std::size_t)>& beat) {
    const std::size_t most = std::min(units_.size(), static_cast<std::size_t>(std::max(workers, 1)));
    std::vector<std::thread> threads;
    try {
      while (threads.size() < most) {
        const std::lock_guard lock(mutex_);
        threads.emplace_back([this] { work(); });
        ++working_;
      }
    } catch (const std::system_error&) {
      if (threads.empty()) throw;  // fewer do the same
    }
    wait(beat);
    for (std::thread& thread : threads) thread.join();
    if (failure_) std::rethrow_exception(failure_);
  }

  std::vector<std::optional<StudyOutcome>> outcomes() { return std::move(outcomes_); }

 private:
  void wait(const std::function<bool(std::size_t)>& beat) {
    std::unique_lock lock(mutex_);
    while (working_ > 0) {
      changed_.wait_for(lock, between_beats);
      const std::size_t done = done_;
      lock.unlock();
      if (stop_ == 0 && !beat(done)) stop_ = 1;
      lock.lock();
    }
  }

  void work() {
    try {
      Diagnostics known;  // what is wrong with all points was reported before
      PointRunner runner(source_, options_, known);
      for (std::size_t unit = next_++; unit < units_.size() && stop_ == 0; unit = next_++) run_unit(runner, unit);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
      stop_ = 1;
    }
    const std::lock_guard lock(mutex_);
    --working_;
    changed_.notify_one();
  }

  void run_unit(PointRunner& runner, std::size_t unit) {
    std::string state;
    for (const StudyPoint& point : units_[unit]) {
      StudyOutcome outcome = runner.run(point, state, &stop_);
      if (outcome.exit_code == exit_interrupted || stop_ != 0) return;
      state = source_.chained ? outcome.state : std::string();
      outcomes_[point.index] = std::move(outcome);  // a place of its own
      const std::lock_guard lock(mutex_);
      ++done_;
      changed_.notify_one();
    }
  }

  const PointSource& source_;
  const LoadOptions& options_;
  const std::vector<PointUnit>& units_;
  std::vector<std::optional<StudyOutcome>> outcomes_;
  std::atomic<std::size_t> next_{0};
  std::atomic<int> stop_{0};
  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t working_ = 0, done_ = 0;
  std::exception_ptr failure_;
};

}  // namespace

std::vector<std::optional<StudyOutcome>> run_in_threads(const PointSource& source, const LoadOptions& options,
                                                        const std::vector<PointUnit>& units, std::size_t points,
                                                        int workers, const std::function<bool(std::size_t)>& beat) {
  PointThreads threads(source, options, units, points);
  threads.run(workers, beat);
  return threads.outcomes();
}

}  // namespace freeplay
