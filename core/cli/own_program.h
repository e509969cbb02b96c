// OwnProgram: this program with another command line, in a process of its own.
#pragma once

#include <string>
#include <vector>

namespace freeplay {

struct ProgramEnd {
  int exit_code = 0;     ///< 128 + N where signal N ended it
  std::string printed;   ///< what came to its stdout
  std::string messages;  ///< to its stderr, unless that is ours
};

/// Runs it and waits. `own_stderr`: its messages and its progress line go where ours go. The first interrupt is passed
/// on to it, a second one ends it at once. It dies with this program. Throws Error{file} "no-process".
ProgramEnd run_own_program(const std::vector<std::string>& words, bool own_stderr);

}  // namespace freeplay
