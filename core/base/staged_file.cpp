#include "base/staged_file.h"

#include <system_error>

#include <fmt/format.h>

#include "base/error.h"
#include "base/whole_file.h"

namespace freeplay {
namespace {

[[noreturn]] void cannot_write(const std::filesystem::path& path, const std::string& reason,
                               const std::string& hint = {}) {
  throw Error(Error::Category::file, "cannot-write", fmt::format("cannot write '{}': {}", path.string(), reason), {},
              hint);
}

}  // namespace

StagedFile::StagedFile(std::filesystem::path path, bool replace) : path_(std::move(path)), temporary_(part_of(path_)) {
  std::error_code error;
  const auto status = std::filesystem::symlink_status(path_, error);
  if (std::filesystem::exists(status)) {
    if (std::filesystem::is_directory(path_, error)) cannot_write(path_, "it is a directory");
    if (!replace) cannot_write(path_, "it is there already", "replace it with --force, or choose another name");
  }
  if (path_.has_parent_path()) std::filesystem::create_directories(path_.parent_path(), error);
  if (path_.has_parent_path() && error) cannot_write(path_, error.message());
}

StagedFile::~StagedFile() {
  std::error_code ignored;
  if (!committed_) std::filesystem::remove(temporary_, ignored);
}

void StagedFile::commit() {
  std::error_code error;
  std::filesystem::rename(temporary_, path_, error);
  if (error) cannot_write(path_, error.message());
  committed_ = true;
}

}  // namespace freeplay
