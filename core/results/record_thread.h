// RecordThread: the thread that writes what a run gives.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "results/record.h"

namespace freeplay {

/// Rows and events are only copied where the run is; a thread gives them to the writers in their order, hands them over
/// to the system at least once a second, and sees within two that a file was removed.
class RecordThread {
 public:
  using Writers = std::vector<std::unique_ptr<RecordWriter>>;

  /// `width`: numbers of a row.
  RecordThread(std::size_t width, Writers writers);
  ~RecordThread();
  RecordThread(const RecordThread&) = delete;
  RecordThread& operator=(const RecordThread&) = delete;

  /// One row: the numbers of `values` at `picked`. Waits where far too many have not been written yet.
  void add_row(std::span<const double> values, std::span<const std::size_t> picked);
  void add_event(std::span<const double> numbers);
  /// Once all that was added so far is safe on the disk, calls `then` in the thread, before any more is written. Does
  /// not wait; `then` is not called after a failure of a writer; an Error that it throws is one.
  void when_safe(std::function<void()> then);

  bool ok() const { return good_.load(std::memory_order_relaxed); }
  /// Writes the rest, ends the thread and closes the files. Returns the first failure, empty without.
  std::string close();
  /// After close(): the rows that every file holds, and processor time that the thread took [s].
  HeldRows held() const;
  /// After close(): whether another program removed, replaced or changed a file.
  bool disturbed() const;
  double thread_seconds() const { return thread_seconds_; }

 private:
  /// What waits for the thread, and what is asked for once the first numbers of it are safe.
  struct Asked {
    std::size_t rows, events;
    std::function<void()> then;
  };
  struct Waiting {
    RecordBuffer numbers;
    std::vector<Asked> asked;
  };

  void serve();
  void write_all();
  void write(const Waiting& waiting);
  void attempt(const std::function<void()>& then);
  template <class Act>
  void each(Act&& act);

  std::size_t width_;
  Writers writers_;            // of the thread
  Waiting waiting_, writing_;  // the second is the thread's
  std::mutex mutex_;
  std::condition_variable changed_;
  bool ending_ = false, gone_ = false;  // the second: the thread ended before it was asked to
  std::atomic<bool> good_ = true;
  std::string failure_;  // of the thread, until it ended
  std::string no_memory_ = "cannot write the results: the system gives no more memory";  // none is left to make it then
  double thread_seconds_ = 0.0;
  std::thread thread_;
};

/// Throws std::system_error where the system gives no thread, before anything is made that needs one.
void require_thread();

}  // namespace freeplay
