#include "results/csv_sink.h"

#include <ctime>

#include "base/number_text.h"

namespace freeplay {
namespace {

constexpr std::size_t many = 1 << 14;  // numbers that are worth waking the thread for
constexpr std::size_t most = 1 << 20;  // numbers that may wait for it
constexpr std::chrono::milliseconds often(100);

}  // namespace

CsvSink::CsvSink(const std::filesystem::path& path, const Channels& channels, std::vector<std::size_t> columns)
    : columns_(std::move(columns)), file_(path), handed_over_(std::chrono::steady_clock::now()) {
  for (const std::size_t& column : columns_) {
    if (&column != &columns_.front()) file_.line() += ',';
    file_.line() += channels.all()[column].name;
  }
  file_.end_line();
  for (auto* rows : {&waiting_, &writing_}) rows->reserve(2 * many + columns_.size());
  writer_ = std::thread([this] { serve(); });
}

CsvSink::~CsvSink() { stop(); }

void CsvSink::row(std::span<const double> values) {
  for (const std::size_t column : columns_) waiting_.push_back(values[column]);
  if (waiting_.size() >= many) {
    hand_over(waiting_.size() >= most);
  } else {
    flush_if_due();
  }
}

void CsvSink::flush_if_due() {
  if (std::chrono::steady_clock::now() - handed_over_ >= often) hand_over(false);
}

// Gives the thread what waits; when it is still busy, later, or with `wait` as soon as it is done.
void CsvSink::hand_over(bool wait) {
  std::unique_lock lock(mutex_);
  if (busy_ && !wait) return;
  changed_.wait(lock, [this] { return !busy_; });
  writing_.swap(waiting_);
  waiting_.clear();
  busy_ = true;
  handed_over_ = std::chrono::steady_clock::now();
  changed_.notify_all();
}

void CsvSink::serve() {
  write_rows();
  timespec used{};
  if (::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used) == 0) {
    thread_seconds_ = static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
  }
}

void CsvSink::write_rows() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return busy_ || ending_; });
    if (!busy_) return;
    lock.unlock();
    for (std::size_t i = 0; i < writing_.size(); ++i) {
      const bool last = (i + 1) % columns_.size() == 0;
      append_number(file_.line(), writing_[i]);
      if (last) {
        file_.end_line();
      } else {
        file_.line() += ',';
      }
    }
    file_.flush_if_due();
    if (!file_.ok()) good_ = false;
    lock.lock();
    busy_ = false;
    changed_.notify_all();
  }
}

void CsvSink::stop() {
  if (!writer_.joinable()) return;
  hand_over(true);
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  writer_.join();
}

void CsvSink::close() {
  stop();
  file_.close();
}

}  // namespace freeplay
