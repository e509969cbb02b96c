// CsvSink: results.csv, one row per output instant.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "base/growing_file.h"
#include "run/sink.h"

namespace freeplay {

/// UTF-8, LF, comma, one header row, no quoting; a value that is NaN is an empty field. Rows are only copied where the
/// run is; they become text in a thread of the sink's own, in their order.
class CsvSink : public Sink {
 public:
  /// `columns`: indices into Channels::all(). Throws Error{file}.
  CsvSink(const std::filesystem::path& path, const Channels& channels, std::vector<std::size_t> columns);
  ~CsvSink() override;

  void row(std::span<const double> values) override;
  void event(const EventRecord&) override {}
  bool ok() const override { return good_.load(std::memory_order_relaxed); }
  void flush_if_due();
  /// Throws Error{file} if anything could not be written.
  void close();
  /// Processor time that the thread took [s], after close().
  double thread_seconds() const { return thread_seconds_; }

 private:
  void hand_over(bool wait);
  void write_rows();
  void serve();
  void stop();

  std::vector<std::size_t> columns_;
  GrowingFile file_;                       // of the thread, from its start to its end
  std::vector<double> waiting_, writing_;  // rows one after the other; the second is the thread's while `busy_`
  std::chrono::steady_clock::time_point handed_over_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool busy_ = false, ending_ = false;
  std::atomic<bool> good_ = true;
  double thread_seconds_ = 0.0;  // written by the thread as it ends
  std::thread writer_;
};

}  // namespace freeplay
