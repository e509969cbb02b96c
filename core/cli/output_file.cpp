#include "cli/output_file.h"

#include "base/whole_file.h"
#include "cli/terminal.h"

namespace freeplay {

void write_output(const std::string& path, const std::string& text) {
  if (path.empty()) {
    print_data(text);
  } else {
    write_whole_file(path, text);
  }
}

}  // namespace freeplay
