// WorkerPool: processes that run points.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "study/outcome.h"
#include "study/work.h"

namespace freeplay {

/// Some points of one unit, to be run in order.
struct StudyTask {
  std::uint64_t unit = 0, first = 0, end = 0;  ///< places in the unit
  std::string state;                           ///< before the first
};

struct PoolOptions {
  int jobs = 1;
  double point_timeout = 0.0;  ///< [s]; 0: none
  bool isolate = false;        ///< a new process for every task
};

/// Workers are forked from this process as it is, while it has one thread, and die with it. One that crashes is replaced
/// and costs the point that it was at; one that is killed otherwise does so the second time.
class WorkerPool {
 public:
  /// The next task, or false where nothing is left.
  using Next = std::function<bool(StudyTask&)>;
  /// An outcome, in the process of the caller.
  using Take = std::function<void(std::uint64_t point, const StudyOutcome&)>;

  WorkerPool(StudyWork& work, const PoolOptions& options);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  /// Runs all tasks; `beat` is called at least every 0.1 s, and ends it by returning false. What is taken is taken
  /// before its worker gets more to do. Throws Error{file} "no-process".
  void run(const Next& next, const Take& take, const std::function<bool()>& beat);

  /// Workers that were replaced.
  std::uint64_t lost() const { return lost_; }

 private:
  struct Worker;
  struct Tries;
  void start(Worker& worker);
  void feed(Worker& worker, const Next& next);
  void receive(Worker& worker, const Take& take);
  void look_after(Worker& worker, const Take& take);
  void bury(Worker& worker, int status, const Take& take);
  void end(Worker& worker);
  bool fetch(const Next& next, StudyTask& task);

  StudyWork& work_;
  PoolOptions options_;
  std::vector<std::unique_ptr<Worker>> workers_;
  std::vector<StudyTask> again_;                 ///< of workers that have ended
  std::vector<std::uint64_t> killed_once_;
  bool exhausted_ = false;
  std::uint64_t lost_ = 0;
  double unit_seconds_ = 0.0;
};

}  // namespace freeplay
