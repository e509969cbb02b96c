#include "io/whole_file.h"

#include <system_error>

#include <fmt/format.h>

#include "base/error.h"
#include "io/growing_file.h"

namespace freeplay {
namespace {

void require(const std::error_code& error, const char* what, const std::filesystem::path& path) {
  if (!error) return;
  throw Error(Error::Category::file, "cannot-write",
              fmt::format("cannot {} '{}': {}", what, path.string(), error.message()));
}

}  // namespace

void write_whole_file(const std::filesystem::path& path, std::string_view text) {
  const std::filesystem::path temporary = path.parent_path() / fmt::format(".{}.part", path.filename().string());
  std::error_code error;
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), error);
  require(error, "make the directory", path.parent_path());
  try {
    GrowingFile file(temporary);
    file.line() += text;
    file.close();
  } catch (const Error&) {
    std::filesystem::remove(temporary, error);
    throw;
  }
  std::filesystem::rename(temporary, path, error);
  if (error) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
  }
  require(error, "write", path);
}

}  // namespace freeplay
