// OutputFile: where a command that prints one thing puts it.
#pragma once

#include <string>

namespace freeplay {

/// Writes `text` to stdout, or to the file `path` if there is one: under a temporary name that is renamed when
/// complete. Throws Error{file}.
void write_output(const std::string& path, const std::string& text);

}  // namespace freeplay
