// Interrupt: Ctrl-C, SIGTERM and closed pipes.
#pragma once

#include <atomic>

namespace freeplay {

/// A closed pipe ends the program quietly with 0, an interrupt with 130; a file over the size limit does not end it.
void handle_signals();

/// From here on the first interrupt only sets the flag, which the caller watches; a second one ends at once.
const std::atomic<int>& watch_interrupts();

}  // namespace freeplay
