#include "base/whole_file.h"

#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "base/error.h"
#include "base/growing_file.h"

namespace freeplay {
namespace {

void require(const std::error_code& error, const char* what, const std::filesystem::path& path) {
  if (!error) return;
  throw Error(Error::Category::file, "cannot-write",
              fmt::format("cannot {} '{}': {}", what, path.string(), error.message()));
}

}  // namespace

std::filesystem::path part_of(const std::filesystem::path& path) {
  return path.parent_path() / fmt::format(".{}.part", path.filename().string());
}

void sync_folder_of(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const bool good = descriptor >= 0 && (::fsync(descriptor) == 0 || errno == EINVAL);  // some cannot
  const std::error_code error(good ? 0 : errno, std::system_category());
  if (descriptor >= 0) ::close(descriptor);
  require(error, "write", path);
}

void write_whole_file(const std::filesystem::path& given, std::string_view text, bool safe) {
  std::error_code error, ignored;
  const std::filesystem::file_status status = std::filesystem::status(given, ignored);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    // A terminal, a pipe: there is nothing to put in its place.
    GrowingFile file(given);
    file.line() += text;
    return file.close();
  }
  // Of a link, the file that it names is replaced.
  const bool link = std::filesystem::is_symlink(std::filesystem::symlink_status(given, ignored));
  const std::filesystem::path path = link ? std::filesystem::weakly_canonical(given, error) : given;
  require(error, "find", given);
  const std::filesystem::path temporary = part_of(path);
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), error);
  require(error, "make the directory", path.parent_path());
  try {
    GrowingFile file(temporary);
    file.line() += text;
    if (safe) file.sync();
    file.close();
  } catch (const Error&) {
    std::filesystem::remove(temporary, error);
    throw;
  }
  std::filesystem::rename(temporary, path, error);
  if (error) {
    std::filesystem::remove(temporary, ignored);
  }
  require(error, "write", path);
  if (safe) sync_folder_of(path);
}

}  // namespace freeplay
