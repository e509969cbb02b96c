// Owner: a process that writes a result keeps others away from it.
#pragma once

#include <filesystem>
#include <utility>

namespace freeplay {

/// Holds the lock of a result directory, which is one on its run.log, as long as it lives.
class Owner {
 public:
  /// Makes run.log where there is none and leaves the text of one that is there. Throws Error{file} "result-in-use"
  /// where another process holds the lock, "cannot-write".
  explicit Owner(const std::filesystem::path& directory);
  ~Owner();
  Owner(Owner&& other) noexcept
      : descriptor_(std::exchange(other.descriptor_, -1)), guarded_(std::exchange(other.guarded_, false)) {}
  Owner& operator=(Owner&&) = delete;

  /// False on a file system without locks: nothing keeps others away.
  bool guarded() const { return guarded_; }
  /// Whether the lock is still that of the directory: it was neither removed nor replaced.
  bool holds(const std::filesystem::path& directory) const;

 private:
  int descriptor_ = -1;
  bool guarded_ = false;
};

/// Throws Error{file} "result-in-use" where a process writes into the directory. Changes nothing.
void require_no_owner(const std::filesystem::path& directory);

}  // namespace freeplay
