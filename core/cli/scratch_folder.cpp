#include "cli/scratch_folder.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "base/error.h"

namespace freeplay {

namespace fs = std::filesystem;

fs::path new_scratch_folder() {
  std::error_code error;
  fs::path folder = fs::temp_directory_path(error);
  std::string name = (folder / "freeplay-XXXXXX").string();
  if (error || ::mkdtemp(name.data()) == nullptr) {
    throw Error(Error::Category::file, "cannot-write",
                fmt::format("cannot make a folder in '{}': {}", folder.string(), std::strerror(errno)));
  }
  return name;
}

}  // namespace freeplay
