// WorkerProcess: one process that runs the tasks which come through a pipe.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

#include "workers/outcome.h"
#include "workers/work.h"
#include "workers/worker_pool.h"

namespace freeplay {

/// Where a worker is, seen by both processes.
struct WorkerNote;

/// The notes of all workers, in memory that is shared with them.
class WorkerNotes {
 public:
  /// Throws Error{file} "no-process".
  explicit WorkerNotes(std::size_t count);
  ~WorkerNotes();
  WorkerNotes(const WorkerNotes&) = delete;
  WorkerNotes& operator=(const WorkerNotes&) = delete;

  WorkerNote& operator[](std::size_t i);

 private:
  std::size_t count_;
  WorkerNote* notes_;
};

class WorkerProcess {
 public:
  explicit WorkerProcess(WorkerNote& note) : note_(note) {}
  /// Kills it.
  ~WorkerProcess();
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  /// Forks. The child closes the pipes of `others` and leaves after one point where `one_point`. Throws Error{file}
  /// "no-process".
  void start(StudyWork& work, bool one_point, const std::vector<WorkerProcess*>& others);
  bool runs() const { return process_ > 0; }

  void give(StudyTask task);
  /// Tasks that are not done, what has been done of the first one taken away.
  std::deque<StudyTask>& tasks() { return tasks_; }

  int incoming() const { return from_; }
  int outgoing() const { return to_; }
  bool has_to_send() const { return !sending_.empty(); }
  void send();
  /// Takes in what has come. False once the process has ended.
  bool receive(const WorkerPool::Take& take);

  /// Seconds since the point in hand has begun; 0 between two.
  double at_work() const;
  /// Number of the point in hand; false between two.
  bool in_hand(std::uint64_t& point) const;
  /// Ends it, takes in what it has still sent, and returns how it ended (waitpid).
  int end(const WorkerPool::Take& take);
  void kill() const;

 private:
  [[noreturn]] void live(StudyWork& work, bool one_point, int parent, int tasks, int results);
  void take_in(const WorkerPool::Take& take);
  void close_pipes();

  WorkerNote& note_;
  StudyWork* work_ = nullptr;
  pid_t process_ = -1;
  int to_ = -1, from_ = -1;
  std::deque<StudyTask> tasks_;
  std::string sending_, received_;
};

}  // namespace freeplay
