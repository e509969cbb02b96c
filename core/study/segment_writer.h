// SegmentWriter: appends rows to a segment of its own.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "study/segment_header.h"

namespace freeplay {

/// A file is made with the first row, and another one after 64 MiB or ten minutes: a closed one never changes again.
/// Every put() is one write(2), so that rows are in the kernel when it returns.
class SegmentWriter {
 public:
  /// `sync`: longest time until rows are on the disk [s]; 0: each time.
  SegmentWriter(std::filesystem::path folder, SegmentHeader header, double sync);
  ~SegmentWriter();
  SegmentWriter(const SegmentWriter&) = delete;
  SegmentWriter& operator=(const SegmentWriter&) = delete;

  /// Whole lines of one or more points. Throws Error{file} "cannot-write"; what is half written is cut off.
  void put(std::string_view lines);
  /// Tells the disk if it is time. Throws Error{file} "cannot-write".
  void sync_if_due();
  /// The same at once, and closes the file.
  void close();

 private:
  using Clock = std::chrono::steady_clock;
  void open();
  void sync();
  [[noreturn]] void fail(int reason) const;

  std::filesystem::path folder_, path_;
  SegmentHeader header_;
  double sync_every_;
  int descriptor_ = -1;
  std::size_t size_ = 0;
  bool dirty_ = false;
  Clock::time_point opened_, synced_;
};

}  // namespace freeplay
