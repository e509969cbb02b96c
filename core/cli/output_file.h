// OutputFile: where a command that prints one thing puts it.
#pragma once

#include <string>

namespace freeplay {

/// Throws Error{file} "cannot-write" where a file that is no picture of this program would be replaced; `force` allows
/// it.
void require_no_other_file(const std::string& path, bool force);

/// Writes `text` to stdout, or to the file `path` if there is one: under a temporary name that is renamed when
/// complete. Throws Error{file}.
void write_output(const std::string& path, const std::string& text);

}  // namespace freeplay
