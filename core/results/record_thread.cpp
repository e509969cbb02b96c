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

RecordThread::RecordThread(std::size_t width, Writers writers) : width_(width), writers_(std::move(writers)) {
  for (Waiting* waiting : {&waiting_, &writing_}) {
    waiting->numbers.rows.reserve(2 * worth_waking + width_);
    waiting->numbers.events.reserve(worth_waking);
  }
  thread_ = std::thread([this] { serve(); });
}

RecordThread::~RecordThread() { close(); }

void RecordThread::add_row(std::span<const double> values, std::span<const std::size_t> picked) {
  std::unique_lock lock(mutex_);
  if (gone_) return;
  std::vector<double>& rows = waiting_.numbers.rows;
  rows.resize(rows.size() + picked.size());
  double* to = rows.data() + rows.size() - picked.size();
  for (const std::size_t index : picked) *to++ = values[index];
  if (rows.size() < worth_waking) return;
  changed_.notify_all();
  changed_.wait(lock, [&] { return gone_ || rows.size() < std::max(too_many, 2 * width_); });
}

void RecordThread::add_event(std::span<const double> numbers) {
  const std::lock_guard lock(mutex_);
  if (gone_) return;
  waiting_.numbers.events.insert(waiting_.numbers.events.end(), numbers.begin(), numbers.end());
}

void RecordThread::when_safe(std::function<void()> then) {
  const std::lock_guard lock(mutex_);
  waiting_.asked.push_back({waiting_.numbers.rows.size(), waiting_.numbers.events.size(), std::move(then)});
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

void RecordThread::attempt(const std::function<void()>& then) {
  try {
    then();
  } catch (const Error& error) {
    failure_ = error.message();
    good_ = false;
  }
}

void RecordThread::write(const Waiting& waiting) {
  const std::span<const double> rows = waiting.numbers.rows, events = waiting.numbers.events;
  std::size_t row = 0, event = 0;  // numbers written
  const auto write_until = [&](std::size_t row_end, std::size_t event_end) {
    const RecordBlock block{rows.subspan(row, row_end - row), events.subspan(event, event_end - event)};
    each([&](RecordWriter& writer) { writer.write(block); });
    row = row_end;
    event = event_end;
  };
  for (const Asked& asked : waiting.asked) {
    write_until(asked.rows, asked.events);
    each([](RecordWriter& writer) { writer.sync(); });
    if (good_) attempt(asked.then);
  }
  write_until(rows.size(), events.size());
}

void RecordThread::write_all() {
  const auto flush_every = flush_again * static_cast<int>(1 + width_ / often_up_to);
  Clock::time_point flushed = Clock::now();
  each([](RecordWriter& writer) { writer.flush(); });  // makes files whose making takes long
  for (bool last = false; !last;) {
    {
      std::unique_lock lock(mutex_);
      changed_.wait_for(lock, look_again, [this] {
        return waiting_.numbers.rows.size() >= worth_waking || !waiting_.asked.empty() || ending_;
      });
      last = ending_;
      std::swap(waiting_, writing_);
    }
    changed_.notify_all();
    write(writing_);
    if (last || Clock::now() - flushed >= flush_every) {
      flushed = Clock::now();
      each([](RecordWriter& writer) { writer.look_after(); });
      each([](RecordWriter& writer) { writer.flush(); });
    }
    writing_.numbers.rows.clear();
    writing_.numbers.events.clear();
    writing_.asked.clear();
  }
  if (!good_) each([](RecordWriter& writer) { writer.sync(); });  // what is there is to stay
  each([](RecordWriter& writer) { writer.close(); });
}

HeldRows RecordThread::held() const {
  const HeldRows* least = nullptr;
  for (const auto& writer : writers_) {
    const HeldRows* held = writer->held();
    if (held != nullptr && (least == nullptr || held->count < least->count)) least = held;
  }
  return least != nullptr ? *least : HeldRows{};
}

bool RecordThread::disturbed() const {
  return std::ranges::any_of(writers_, [](const auto& writer) { return writer->disturbed(); });
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
