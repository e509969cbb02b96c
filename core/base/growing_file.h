// GrowingFile: a text file that grows line by line while a run goes on.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace freeplay {

/// Collects whole lines and writes them when there are many, when a second has passed, and at the end, so that a reader
/// never sees half a line and waits at most a second. Lines do not allocate once the longest one was seen. The first
/// failure to write is kept; what was written before it stays, cut to whole lines.
class GrowingFile {
 public:
  enum class Begin { empty, append };
  /// Makes the file where there is none; else empties it, or goes on at its end. Throws Error{file} "cannot-write".
  explicit GrowingFile(std::filesystem::path path, Begin begin = Begin::empty);
  ~GrowingFile();
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;

  /// Text of the line in hand, to append to.
  std::string& line() { return text_; }
  /// Ends the line in hand.
  void end_line();
  /// Writes if the last time was a second ago.
  void flush_if_due();
  /// Writes what was collected.
  void flush();
  /// The same, and tells the disk.
  void sync();
  /// Notes as a failure that another program removed, replaced, cut or wrote the file.
  void look_after();
  /// Writes everything. Throws Error{file} "cannot-write" for the first failure of all, and where another program
  /// changed it.
  void close();

  bool ok() const { return failure_ == 0 && disturbed_ == nullptr; }
  /// Whether another program removed, replaced, cut or wrote it.
  bool disturbed() const { return disturbed_ != nullptr; }
  /// Whether lines wait to be written.
  bool waits() const { return !text_.empty(); }
  /// "cannot write 'FILE': REASON"; empty while all is well.
  std::string failure() const;

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  int failure_ = 0;                  // errno of the first failure
  const char* disturbed_ = nullptr;  // what another program did to it
  std::int64_t size_ = 0;            // bytes that it has
  std::string text_;
  std::chrono::steady_clock::time_point last_flush_;
};

}  // namespace freeplay
