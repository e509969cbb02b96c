// WorkerPool: processes that run points.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "workers/outcome.h"
#include "workers/work.h"

namespace freeplay {

/// Some points of one unit, to be run in order.
struct StudyTask {
  std::uint64_t unit = 0, first = 0, end = 0;  ///< places in the unit
  std::string state{};                         ///< before the first
};

struct PoolOptions {
  int jobs = 1;
  double point_timeout = 0.0;  ///< [s]; 0: none
  bool isolate = false;        ///< a new process for every point
};

class WorkerNotes;
class WorkerProcess;

/// Workers are forked from this process as it is, while it has one thread, and die with it. One that crashes is
/// replaced and costs the point that it was at; one that is killed otherwise does so the second time.
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

  /// Forks some of the workers ahead, for a caller that will have threads when it calls turn().
  void start(std::size_t workers);
  /// A part of run() for a caller that is busy otherwise: workers that are there get more to do, and what they have
  /// done is taken. Waits for nothing. Throws what `take` throws.
  void turn(const Next& next, const Take& take);
  /// Runs all tasks. An outcome is taken before its worker gets more to do. `beat` is called at least every 0.1 s;
  /// where it returns false the points in hand are given up. Throws Error{file} "no-process", and what `take` throws.
  void run(const Next& next, const Take& take, const std::function<bool()>& beat);

  /// Workers that were replaced.
  std::uint64_t lost() const { return lost_; }

 private:
  bool fetch(const Next& next, StudyTask& task);
  bool hungry(WorkerProcess& worker) const;
  void start(WorkerProcess& worker);
  void feed(WorkerProcess& worker, const Next& next, bool may_start);
  Take timed(const Take& take);
  void look_after_all(const Take& take);
  void wait() const;
  void look_after(WorkerProcess& worker, const Take& take);
  void bury(WorkerProcess& worker, const Take& take);
  void blame(StudyTask task, std::uint64_t point, int status, const Take& take);
  void put_back(StudyTask task);

  StudyWork& work_;
  PoolOptions options_;
  std::unique_ptr<WorkerNotes> notes_;
  std::vector<std::unique_ptr<WorkerProcess>> workers_;
  std::vector<StudyTask> again_;  ///< of workers that have ended, the next last
  std::set<std::uint64_t> killed_once_;
  std::set<const WorkerProcess*> late_;
  bool exhausted_ = false;
  std::uint64_t lost_ = 0;
  double point_seconds_ = 0.0;
};

}  // namespace freeplay
