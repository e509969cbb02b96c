#include "results/record_thread.h"

#include <algorithm>
#include <ctime>
#include <utility>

#include "base/error.h"

namespace freeplay {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t worth_waking = 1 << 14;  // numbers
constexpr std::size_t too_many = 1 << 20;      // numbers that may wait for the thread
constexpr std::chrono::milliseconds look_again(200), flush_again(700);
constexpr std::size_t often_up_to = 2000;  // columns; with more, flushes take longer and come less often

}  // namespace

RecordThread::RecordThread(std::size_t width, Start start)
    : width_(width),
      writers_(std::move(start.writers)),
      given_(start.rows),
      rows_(start.rows),
      time_given_(start.last_time),
      last_time_(start.last_time) {
  for (RecordBlock* block : {&waiting_, &writing_}) {
    block->rows.reserve(2 * worth_waking + width_);
    block->events.reserve(worth_waking);
  }
  thread_ = std::thread([this] { serve(); });
}

RecordThread::~RecordThread() { close(); }

void RecordThread::add_row(std::span<const double> values, std::span<const std::size_t> picked) {
  std::unique_lock lock(mutex_);
  if (gone_) return;
  for (const std::size_t index : picked) waiting_.rows.push_back(values[index]);
  if (waiting_.rows.size() < worth_waking) return;
  changed_.notify_all();
  changed_.wait(lock, [this] { return gone_ || waiting_.rows.size() < std::max(too_many, 2 * width_); });
}

void RecordThread::add_event(std::span<const double> numbers) {
  const std::lock_guard lock(mutex_);
  if (gone_) return;
  waiting_.events.insert(waiting_.events.end(), numbers.begin(), numbers.end());
}

void RecordThread::when_safe(std::function<void()> then) {
  const std::lock_guard lock(mutex_);
  asked_.push_back(std::move(then));
  changed_.notify_all();
}

void RecordThread::serve() {
  try {
    write_all();
  } catch (const std::exception&) {  // only memory can be missing here
    if (failure_.empty()) failure_.swap(no_memory_);
    good_ = false;
    const std::lock_guard lock(mutex_);
    gone_ = true;
  }
  changed_.notify_all();
  timespec used{};
  if (::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used) == 0) {
    thread_seconds_ = static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
  }
}

// A writer that failed is left alone, the others go on.
template <class Act>
void RecordThread::each(Act&& act) {
  for (const auto& writer : writers_) {
    if (!writer->failure().empty()) continue;
    act(*writer);
    if (writer->failure().empty()) continue;
    if (failure_.empty()) failure_ = writer->failure();
    good_ = false;
  }
}

/// What a file took of a flush that another one refused does not count.
void RecordThread::note_safe() {
  if (!good_) return;
  rows_ = given_;
  last_time_ = time_given_;
}

void RecordThread::attempt(const std::function<void()>& then) {
  try {
    then();
  } catch (const Error& error) {
    failure_ = error.message();
    good_ = false;
  }
}

void RecordThread::write_all() {
  const auto flush_every = flush_again * static_cast<int>(1 + width_ / often_up_to);
  Clock::time_point flushed = Clock::now();
  each([](RecordWriter& writer) { writer.flush(); });  // makes files whose making takes long
  for (bool last = false; !last;) {
    {
      std::unique_lock lock(mutex_);
      changed_.wait_for(lock, look_again,
                        [this] { return waiting_.rows.size() >= worth_waking || !asked_.empty() || ending_; });
      last = ending_;
      std::swap(waiting_, writing_);
      std::swap(asked_, asking_);
    }
    changed_.notify_all();
    each([this](RecordWriter& writer) { writer.write(writing_); });
    if (!writing_.rows.empty()) {
      given_ += static_cast<long>(writing_.rows.size() / width_);
      time_given_ = writing_.rows[writing_.rows.size() - width_];
    }
    if (!asking_.empty()) {
      each([](RecordWriter& writer) { writer.sync(); });
      note_safe();
    }
    for (const auto& then : asking_) {
      if (good_) attempt(then);
    }
    if (last || Clock::now() - flushed >= flush_every) {
      flushed = Clock::now();
      each([](RecordWriter& writer) { writer.look_after(); });
      each([](RecordWriter& writer) { writer.flush(); });
      note_safe();
    }
    writing_.rows.clear();
    writing_.events.clear();
    asking_.clear();
  }
  each([](RecordWriter& writer) { writer.close(); });
}

std::string RecordThread::close() {
  if (thread_.joinable()) {
    {
      const std::lock_guard lock(mutex_);
      ending_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  return failure_;
}

void require_thread() {
  std::thread([] {}).join();
}

}  // namespace freeplay
