// Commands: the words that the program knows. Which of the two tables is linked decides (CMakeLists.txt).
#pragma once

#include <span>
#include <string_view>

#include "cli/options.h"

namespace freeplay {

struct CommandEntry {
  std::string_view name;
  Command (*add)(CLI::App&, CommonOptions&);
};

/// In the order of the help text.
std::span<const CommandEntry> all_commands();

}  // namespace freeplay
