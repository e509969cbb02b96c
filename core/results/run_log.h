// RunLog: run.log, messages with time stamps.
#pragma once

#include <filesystem>
#include <string_view>

#include "base/growing_file.h"

namespace freeplay {

/// Lines `2024-05-17T09:30:00.125Z note: text`, times in UTC. A message that spans lines becomes several.
class RunLog {
 public:
  /// Throws Error{file}.
  explicit RunLog(const std::filesystem::path& path, GrowingFile::Begin begin = GrowingFile::Begin::empty)
      : file_(path, begin) {}

  /// `kind`: note, warning or error.
  void write(std::string_view kind, std::string_view message);
  /// Throws Error{file} if anything could not be written.
  void close() { file_.close(); }

 private:
  GrowingFile file_;
};

}  // namespace freeplay
