// Harness: what the fuzz targets share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/diagnostics.h"
#include "component/registry.h"
#include "format/document.h"

namespace freeplay::fuzz {

/// Ends the program, with the reason on stderr, if something does not hold that must hold for every input.
void require(bool holds, const char* what);

/// The built-in types, read once.
const Registry& builtin_types();

/// A file in memory whose content is replaced for each input; nothing is written to a disk.
class MemoryFile {
 public:
  MemoryFile();
  void write(std::string_view text) const;
  /// By which this process can open it.
  const std::string& path() const { return path_; }

 private:
  int descriptor_;
  std::string path_;
};

/// Reads and checks `text` as `freeplay validate --no-assemble` does, prints the messages into a string and requires
/// that there is a model or an error, and that each message of `file_name` points into the text.
void check_model(std::string text, const std::string& file_name);

/// check_model() of a robot file in `text`, given as a model of that name and, as a file in memory, named by a side-car
/// that asks for one of the ways to read it.
void check_robot(const std::string& text, const std::string& file_name);

/// Requires that the messages are fit to be printed and point into `text`.
void check_messages(const Diagnostics& diagnostics, const std::string& file_name, std::string_view text);

}  // namespace freeplay::fuzz
