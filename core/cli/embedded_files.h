// EmbeddedFile: a file of the source tree that the program carries with it.
#pragma once

#include <span>
#include <string_view>

namespace freeplay {

struct EmbeddedFile {
  std::string_view path;  ///< in the source tree: "mechanisms/four-bar.yaml", "plugins/template/joint.cpp"
  std::string_view text;
};

/// In order of path; the definition is generated from embedded_files.cpp.in.
std::span<const EmbeddedFile> embedded_files();

}  // namespace freeplay
