#include "cli/output_file.h"

#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "base/error.h"
#include "base/whole_file.h"
#include "cli/terminal.h"
#include "results/made_text.h"

namespace freeplay {

void require_no_other_file(const std::string& path, bool force) {
  std::error_code ignored;
  // An empty file holds nothing, and terminals and pipes are written to.
  if (path.empty() || force || !std::filesystem::is_regular_file(path, ignored)) return;
  if (std::filesystem::file_size(path, ignored) == 0 || is_own_picture(path)) return;
  throw Error(Error::Category::file, "cannot-write",
              fmt::format("cannot write '{}': it is there already, and no picture of this program", path), {},
              "replace it with --force, or choose another name");
}

void write_output(const std::string& path, const std::string& text) {
  if (path.empty()) {
    print_data(text);
  } else {
    write_whole_file(path, text);
  }
}

}  // namespace freeplay
