#include "base/growing_file.h"

#include <cerrno>
#include <cstring>
#include <string_view>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"

namespace freeplay {
namespace {

constexpr std::size_t many = 1 << 16;

std::string words(const std::filesystem::path& path, const char* reason) {
  return fmt::format("cannot write '{}': {}", path.string(), reason);
}

/// What another program did to the open file that has `size` bytes by what was written; null: nothing.
const char* disturbance(int descriptor, const std::filesystem::path& path, std::int64_t size) {
  struct stat open {
  }, there{};
  if (::fstat(descriptor, &open) != 0 || !S_ISREG(open.st_mode)) return nullptr;
  if (::stat(path.c_str(), &there) != 0 || there.st_ino != open.st_ino || there.st_dev != open.st_dev) {
    return "it was removed or replaced while it was written";
  }
  if (open.st_size < size) return "another program cut it while it was written";
  return open.st_size > size ? "another program wrote into it while it was written" : nullptr;
}

/// Of a file that lines are appended to.
std::int64_t size_of(int descriptor) {
  const off_t size = ::lseek(descriptor, 0, SEEK_END);
  return size > 0 ? size : 0;
}

}  // namespace

GrowingFile::GrowingFile(std::filesystem::path path, Begin begin)
    : path_(std::move(path)),
      descriptor_(::open(path_.c_str(),
                         O_WRONLY | O_CREAT | O_CLOEXEC | O_APPEND | (begin == Begin::empty ? O_TRUNC : 0), 0666)),
      last_flush_(std::chrono::steady_clock::now()) {
  if (descriptor_ < 0) throw Error(Error::Category::file, "cannot-write", words(path_, std::strerror(errno)));
  size_ = size_of(descriptor_);
  text_.reserve(2 * many);
}

GrowingFile::~GrowingFile() {
  if (descriptor_ < 0) return;
  flush();
  ::close(descriptor_);
}

void GrowingFile::end_line() {
  text_ += '\n';
  if (text_.size() >= many) {
    flush();
  } else {
    flush_if_due();
  }
}

void GrowingFile::flush_if_due() {
  if (std::chrono::steady_clock::now() - last_flush_ >= std::chrono::seconds(1)) flush();
}

void GrowingFile::flush() {
  std::string_view rest = text_;
  if (!rest.empty()) look_after();  // nothing is added to what another program made of it
  while (!rest.empty() && ok()) {
    const ssize_t written = ::write(descriptor_, rest.data(), rest.size());
    if (written > 0) {
      rest.remove_prefix(static_cast<std::size_t>(written));
      size_ += written;
    } else if (errno != EINTR) {
      failure_ = errno;
    }
  }
  if (failure_ != 0 && rest.size() < text_.size()) {
    // A full disk may take part of a line: cut it off, so that only whole rows stay.
    const std::string_view taken = std::string_view(text_).substr(0, text_.size() - rest.size());
    const std::size_t line_end = taken.rfind('\n') + 1;  // npos + 1 is 0: not even one line
    const std::int64_t size = size_ - static_cast<std::int64_t>(taken.size() - line_end);
    if (::ftruncate(descriptor_, size) == 0) {
      size_ = size;
    } else {
      failure_ = errno;
    }
  }
  text_.clear();
  last_flush_ = std::chrono::steady_clock::now();
}

void GrowingFile::sync() {
  flush();
  if (failure_ == 0 && ::fdatasync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) failure_ = errno;
}

void GrowingFile::look_after() {
  if (descriptor_ >= 0 && ok()) disturbed_ = disturbance(descriptor_, path_, size_);
}

std::string GrowingFile::failure() const {
  if (failure_ != 0) return words(path_, std::strerror(failure_));
  return disturbed_ != nullptr ? words(path_, disturbed_) : std::string();
}

void GrowingFile::close() {
  if (descriptor_ >= 0) {
    flush();
    if (failure_ != 0) ::fdatasync(descriptor_);  // what was written before stays, whatever happens to the machine
    look_after();
    if (::close(descriptor_) != 0 && failure_ == 0) failure_ = errno;
    descriptor_ = -1;
  }
  if (!ok()) throw Error(Error::Category::file, "cannot-write", failure());
}

}  // namespace freeplay
