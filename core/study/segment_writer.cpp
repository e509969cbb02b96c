#include "study/segment_writer.h"

#include <cerrno>
#include <cstring>
#include <ctime>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "base/error.h"
#include "base/whole_file.h"

namespace freeplay {
namespace {

constexpr std::size_t most_of_a_segment = std::size_t{64} << 20;
constexpr std::chrono::minutes longest_segment{10};

}  // namespace

SegmentWriter::SegmentWriter(std::filesystem::path folder, SegmentHeader header, double sync)
    : folder_(std::move(folder)), header_(std::move(header)), sync_every_(sync) {}

SegmentWriter::~SegmentWriter() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void SegmentWriter::fail(int reason) const {
  throw Error(Error::Category::file, "cannot-write",
              fmt::format("cannot write '{}': {}", path_.string(), std::strerror(reason)));
}

/// Names count seconds: where one is taken, by this process itself, the next one is.
void SegmentWriter::open() {
  for (std::time_t seconds = std::time(nullptr);; ++seconds) {
    path_ = folder_ / fmt::format("{}-of-{}.{}.{}.{}.rows", header_.shard.part, header_.shard.parts, header_.host,
                                  ::getpid(), seconds);
    descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0666);
    if (descriptor_ >= 0) break;
    if (errno != EEXIST) fail(errno);
  }
  size_ = 0;
  opened_ = synced_ = Clock::now();
}

void SegmentWriter::put(std::string_view lines) {
  if (descriptor_ >= 0 && (size_ >= most_of_a_segment || Clock::now() - opened_ >= longest_segment)) close();
  std::string first;
  if (descriptor_ < 0) {
    open();
    first = header_.text();
    lines = first.append(lines);
  }
  const std::size_t before = size_;
  while (!lines.empty()) {
    const ssize_t written = ::write(descriptor_, lines.data(), lines.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const int reason = errno;
      // Rows that are half written are none, but a row after them would not be the last line.
      [[maybe_unused]] const int uncut = ::ftruncate(descriptor_, static_cast<off_t>(before));
      fail(reason);
    }
    size_ += static_cast<std::size_t>(written);
    lines.remove_prefix(static_cast<std::size_t>(written));
  }
  if (!dirty_) synced_ = Clock::now();
  dirty_ = true;
  if (sync_every_ <= 0.0) sync();
}

void SegmentWriter::sync_if_due() {
  if (dirty_ && std::chrono::duration<double>(Clock::now() - synced_).count() >= sync_every_) sync();
}

void SegmentWriter::sync() {
  if (::fdatasync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) fail(errno);
  dirty_ = false;
}

void SegmentWriter::close() {
  if (descriptor_ < 0) return;
  if (dirty_) sync();
  if (::close(std::exchange(descriptor_, -1)) != 0) fail(errno);
  sync_folder_of(path_);
}

}  // namespace freeplay
