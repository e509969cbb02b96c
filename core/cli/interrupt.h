// Interrupt: Ctrl-C, SIGTERM and other signals.
#pragma once

#include <atomic>

namespace freeplay {

/// An interrupt ends the program with 130; a closed pipe or a file over the size limit is a failed write and does not.
void handle_signals();

/// From here on the first interrupt only sets the flag, which the caller watches; a second one ends at once.
const std::atomic<int>& watch_interrupts();

}  // namespace freeplay
