#include "cli/interrupt.h"

#include <csignal>
#include <string_view>

#include <unistd.h>

namespace freeplay {
namespace {

std::atomic<int> watched = 0, interrupts = 0;
static_assert(std::atomic<int>::is_always_lock_free);

void on_interrupt(int) {
  if (watched != 0 && interrupts.fetch_add(1) == 0) return;
  if (watched != 0) {
    constexpr std::string_view last_words = "freeplay: interrupted at once, the result directory is unfinished\n";
    [[maybe_unused]] const auto unheard = write(STDERR_FILENO, last_words.data(), last_words.size());
  }
  _exit(130);
}

}  // namespace

void handle_signals() {
  std::signal(SIGPIPE, SIG_IGN);  // a closed pipe is a failed write, which terminal.h does not report
  std::signal(SIGXFSZ, SIG_IGN);  // a file over the size limit is a failed write, which is reported
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  std::signal(SIGHUP, on_interrupt);
}

const std::atomic<int>& watch_interrupts() {
  watched = 1;
  return interrupts;
}

}  // namespace freeplay
