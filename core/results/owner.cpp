#include "results/owner.h"

#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <string>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include "base/error.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

/// "process 4711", by the system's list of locks; a process of another machine is not in it.
std::string holder(int descriptor) {
  struct stat status {};
  std::ifstream locks("/proc/locks");
  if (::fstat(descriptor, &status) != 0 || !locks) return "another process";
  const std::string file = fmt::format("{:02x}:{:02x}:{}", major(status.st_dev), minor(status.st_dev), status.st_ino);
  for (std::string number, kind, mode, access, process, where, rest; locks >> number >> kind;) {
    if (kind == "->") continue;  // one that waits, in the place of the holder
    if (!(locks >> mode >> access >> process >> where) || !std::getline(locks, rest)) break;
    if (kind == "FLOCK" && where == file && process.find_first_not_of("0123456789") == std::string::npos) {
      return "process " + process;
    }
  }
  return "another process";
}

[[noreturn]] void refuse_in_use(const fs::path& directory, int descriptor) {
  const std::string who = holder(descriptor);
  ::close(descriptor);
  throw Error(Error::Category::file, "result-in-use",
              fmt::format("'{}' is in use: {} writes into it", directory.string(), who), {},
              "wait until it has ended, or choose another directory with --out");
}

bool is_open_file(int descriptor, const fs::path& path) {
  struct stat open {
  }, there{};
  return ::fstat(descriptor, &open) == 0 && ::stat(path.c_str(), &there) == 0 && open.st_ino == there.st_ino &&
         open.st_dev == there.st_dev;
}

/// Whether the lock is held now; `guarded`: whether there are locks at all.
bool lock(int descriptor, bool& guarded) {
  int result = 0;
  do {
    result = ::flock(descriptor, LOCK_EX | LOCK_NB);
  } while (result != 0 && errno == EINTR);
  guarded = result == 0;
  return result == 0 || errno != EWOULDBLOCK;
}

/// The same within half a second: a process that was killed, and those that end with it, let go a moment later.
bool lock_soon(int descriptor, bool& guarded) {
  constexpr int tries = 50;
  for (int i = 0; i < tries; ++i) {
    if (lock(descriptor, guarded)) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return lock(descriptor, guarded);
}

}  // namespace

Owner::Owner(const fs::path& directory) {
  const fs::path log = directory / "run.log";
  for (;;) {
    descriptor_ = ::open(log.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor_ < 0) {
      throw Error(Error::Category::file, "cannot-write",
                  fmt::format("cannot write '{}': {}", log.string(), std::strerror(errno)));
    }
    if (!lock_soon(descriptor_, guarded_)) refuse_in_use(directory, std::exchange(descriptor_, -1));
    // Between opening and locking the file may have been removed: then the lock is one of a file without a name.
    if (is_open_file(descriptor_, log)) return;
    ::close(std::exchange(descriptor_, -1));
  }
}

Owner::~Owner() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool Owner::holds(const fs::path& directory) const { return is_open_file(descriptor_, directory / "run.log"); }

void require_no_owner(const fs::path& directory) {
  const fs::path log = directory / "run.log";
  int descriptor = ::open(log.c_str(), O_RDWR | O_CLOEXEC);
  if (descriptor < 0) descriptor = ::open(log.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;
  bool guarded = false;
  if (!lock_soon(descriptor, guarded)) refuse_in_use(directory, descriptor);
  ::close(descriptor);
}

}  // namespace freeplay
