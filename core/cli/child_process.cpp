#include "cli/child_process.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <new>
#include <thread>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/address_sanitizer.h"
#include "base/error.h"
#include "base/whole_text.h"
#include "cli/interrupt.h"

namespace freeplay {
namespace {

constexpr rlim_t most_memory = rlim_t{4} << 30, most_output = rlim_t{16} << 20;
// A call that takes this long does not belong into a time loop, however busy the machine [s].
constexpr double longest_call = 1.0;
constexpr double recently = 5.0;     // [s]
constexpr double busy_factor = 5.0;  // by the clock, of the time that a child may take on a busy machine

// Of a child that has not been collected [s].
double processor_time(int process) {
  clockid_t clock{};
  timespec time{};
  if (::clock_getcpuclockid(process, &clock) != 0 || ::clock_gettime(clock, &time) != 0) return 0.0;
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

[[noreturn]] void no_process(const char* what) {
  throw Error(Error::Category::file, "no-process", std::string(what) + ": " + std::strerror(errno));
}

void limit(int resource, rlim_t most) {
  rlimit both{};
  if (getrlimit(static_cast<__rlimit_resource>(resource), &both) != 0) return;
  both.rlim_cur = std::min(both.rlim_cur, most);
  both.rlim_max = std::min(both.rlim_max, most);
  setrlimit(static_cast<__rlimit_resource>(resource), &both);
}

void set_limits() {
  // The sanitizer reserves terabytes of addresses that it never uses.
  if (!FREEPLAY_ADDRESS_SANITIZER) limit(RLIMIT_AS, most_memory);
  limit(RLIMIT_FSIZE, most_output);
  limit(RLIMIT_CORE, 0);
}

/// What a crash does is the system's business again, not ours and not that of a sanitizer.
void set_signals() {
  for (const int number : {SIGINT, SIGTERM, SIGPIPE, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP}) {
    std::signal(number, SIG_DFL);
  }
}

}  // namespace

struct ChildProcess::Shared {
  CallNote note;
  std::atomic<std::uint32_t> finished{0};
};

ChildProcess::ChildProcess(const Work& work) {
  void* page = ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  report_ = ::memfd_create("report", MFD_CLOEXEC);
  printed_ = ::memfd_create("printed", MFD_CLOEXEC);
  if (page == MAP_FAILED || report_ < 0 || printed_ < 0) no_process("cannot make shared memory");
  shared_ = new (page) Shared;
  unchanged_since_ = now();
  // What is buffered would be printed twice.
  std::fflush(nullptr);
  const int parent = ::getpid();
  process_ = ::fork();
  if (process_ < 0) no_process("cannot start a process");
  if (process_ == 0) live(work, parent);
  ::setpgid(process_, process_);  // the child says so too; whoever comes first
}

ChildProcess::~ChildProcess() {
  if (!ended_ && process_ > 0) {
    kill_group();
    ::waitpid(process_, nullptr, 0);
  }
  ::close(report_);
  ::close(printed_);
  ::munmap(shared_, sizeof(Shared));
}

void ChildProcess::live(const Work& work, int parent) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) _exit(1);
  set_signals();
  const int nothing = ::open("/dev/null", O_RDONLY);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(printed_, STDOUT_FILENO);
  ::dup2(printed_, STDERR_FILENO);
  set_limits();
  Leave leave = Leave::at_once;
  try {
    leave = work([this](std::string_view line) { write_all(report_, std::string(line) + "\n"); }, shared_->note);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    std::fflush(nullptr);
    _exit(1);
  }
  shared_->finished = 1;
  std::fflush(nullptr);
  if (leave == Leave::at_once) _exit(0);
  std::exit(0);
}

bool ChildProcess::look() {
  if (ended_) return true;
  const std::uint64_t calls = shared_->note.calls.load(std::memory_order_relaxed);
  if (calls != calls_seen_) {
    calls_seen_ = calls;
    unchanged_since_ = now();
  }
  siginfo_t info{};
  if (::waitid(P_PID, static_cast<id_t>(process_), &info, WEXITED | WNOHANG | WNOWAIT) != 0 || info.si_pid == 0) {
    return false;
  }
  const bool finished = shared_->finished != 0;
  end_.finished_first = finished;
  end_.code = info.si_status;
  if (info.si_code != CLD_EXITED) {
    end_.how = ChildEnd::How::crashed;
  } else {
    end_.how = finished ? ChildEnd::How::finished : ChildEnd::How::exited;
  }
  collect();
  return true;
}

void ChildProcess::give_up(double long_call) {
  const bool inside = shared_->note.inside.load(std::memory_order_acquire) != 0;
  end_.finished_first = shared_->finished != 0;
  end_.how = inside && now() - unchanged_since_ >= long_call ? ChildEnd::How::stuck : ChildEnd::How::late;
  collect();
}

void ChildProcess::kill_group() {
  ::kill(-process_, SIGKILL);
  ::kill(process_, SIGKILL);
}

void ChildProcess::collect() {
  kill_group();  // before the process is reaped: its number still stands for it
  ::waitpid(process_, nullptr, 0);
  ended_ = true;
  end_.report = read_all(report_);
  end_.printed = read_all(printed_);
}

bool ChildProcess::goes_on(double seconds) const {
  return now() - unchanged_since_ < recently && processor_time(process_) < seconds;
}

void ChildProcess::wait(const std::vector<std::unique_ptr<ChildProcess>>& children, double seconds) {
  const std::atomic<int>& interrupts = watch_interrupts();
  const double started = now();
  for (;;) {
    bool all = true;
    for (const auto& child : children) all = child->look() && all;
    if (all) return;
    if (interrupts > 0) {
      for (const auto& child : children) {
        if (!child->ended_) child->give_up(longest_call);
      }
      std::fflush(nullptr);
      _exit(130);
    }
    const double spent = now() - started;
    for (const auto& child : children) {
      if (spent < seconds || child->ended_ || (spent < busy_factor * seconds && child->goes_on(seconds))) continue;
      child->give_up(std::min(longest_call, 0.5 * seconds));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

const CallNote& ChildProcess::note() const { return shared_->note; }

}  // namespace freeplay
