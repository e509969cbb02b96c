// StagedFile: a file that others write under a temporary name, and that is there complete or not at all.
#pragma once

#include <filesystem>

namespace freeplay {

class StagedFile {
 public:
  /// Makes the folder. Throws Error{file} "cannot-write" where a file is there already and `replace` does not allow to
  /// put another in its place.
  StagedFile(std::filesystem::path path, bool replace);
  /// Removes what was not committed.
  ~StagedFile();
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;

  /// Where to write.
  const std::filesystem::path& temporary() const { return temporary_; }
  /// Renames. Throws Error{file} "cannot-write".
  void commit();

 private:
  std::filesystem::path path_, temporary_;
  bool committed_ = false;
};

}  // namespace freeplay
