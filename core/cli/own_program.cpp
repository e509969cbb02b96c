#include "cli/own_program.h"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"
#include "base/whole_text.h"
#include "cli/interrupt.h"

namespace freeplay {
namespace {

constexpr int look_again_after = 5;  // [ms]

[[noreturn]] void no_own_program(const char* what) {
  throw Error(Error::Category::file, "no-process", std::string(what) + ": " + std::strerror(errno));
}

/// In the child. Nothing that allocates is called here but what the arguments need.
[[noreturn]] void become(std::vector<char*>& words, int printed, int messages, int parent) {
  ::setpgid(0, 0);  // Ctrl-C is for the parent, which passes it on
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != parent) _exit(1);
  const int nothing = ::open("/dev/null", O_RDONLY);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(printed, STDOUT_FILENO);
  if (messages >= 0) ::dup2(messages, STDERR_FILENO);
  ::execv("/proc/self/exe", words.data());
  _exit(127);
}

int exit_code_of(int status) { return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status); }

}  // namespace

ProgramEnd run_own_program(const std::vector<std::string>& words, bool own_stderr) {
  std::vector<std::string> kept{"freeplay"};
  kept.insert(kept.end(), words.begin(), words.end());
  std::vector<char*> pointers;
  for (std::string& word : kept) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const int printed = ::memfd_create("printed", MFD_CLOEXEC);
  const int messages = own_stderr ? -1 : ::memfd_create("messages", MFD_CLOEXEC);
  if (printed < 0 || (!own_stderr && messages < 0)) no_own_program("cannot make shared memory");
  std::fflush(nullptr);
  const std::atomic<int>& interrupts = watch_interrupts();
  const int parent = ::getpid();
  const int process = ::fork();
  if (process < 0) no_own_program("cannot start a process");
  if (process == 0) become(pointers, printed, messages, parent);
  int status = 0;
  bool passed_on = false;
  while (::waitpid(process, &status, WNOHANG) == 0) {
    if (interrupts != 0 && !passed_on) {
      ::kill(process, SIGTERM);
      passed_on = true;
    }
    ::poll(nullptr, 0, look_again_after);
  }
  ProgramEnd end{.exit_code = exit_code_of(status), .printed = read_all(printed), .messages = {}};
  ::close(printed);
  if (messages >= 0) end.messages = read_all(messages);
  if (messages >= 0) ::close(messages);
  return end;
}

}  // namespace freeplay
