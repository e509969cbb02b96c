#include "workers/worker_process.h"

#include <atomic>
#include <cerrno>
#include <cfenv>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <exception>
#include <new>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"
#include "base/whole_text.h"
#include "workers/outcome_bytes.h"

namespace freeplay {

struct WorkerNote {
  std::atomic<std::uint64_t> point{0};  ///< plus 1; 0 between two
  std::atomic<std::int64_t> began{0};   ///< [ns]
};

namespace {

[[noreturn]] void fail_to_start(const char* what) {
  throw Error(Error::Category::file, "no-process", fmt::format("{}: {}", what, std::strerror(errno)));
}

std::int64_t now() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

double processor_seconds() {
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// In a worker: the point, with what it took. What its run throws is a mistake of this program, and costs the point.
StudyOutcome run_point(StudyWork& work, std::uint64_t point, const std::string& state, WorkerNote& note) {
  std::fesetenv(FE_DFL_ENV);  // a plugin may have changed it
  const std::int64_t began = now();
  const double cpu = processor_seconds();
  note.began = began;
  note.point = point + 1;
  StudyOutcome outcome;
  try {
    outcome = work.run(point, state);
  } catch (const std::exception& exception) {
    outcome = StudyOutcome{.exit_code = 1, .error = "internal", .message = exception.what()};
  }
  outcome.wall = 1e-9 * static_cast<double>(now() - began);
  outcome.cpu = processor_seconds() - cpu;
  return outcome;
}

}  // namespace

WorkerNotes::WorkerNotes(std::size_t count) : count_(count) {
  void* page = ::mmap(nullptr, count * sizeof(WorkerNote), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (page == MAP_FAILED) fail_to_start("cannot make shared memory");
  notes_ = static_cast<WorkerNote*>(page);
  for (std::size_t i = 0; i < count; ++i) new (notes_ + i) WorkerNote;
}

WorkerNotes::~WorkerNotes() { ::munmap(notes_, count_ * sizeof(WorkerNote)); }

WorkerNote& WorkerNotes::operator[](std::size_t i) { return notes_[i]; }

WorkerProcess::~WorkerProcess() {
  if (runs()) {
    kill();
    ::waitpid(process_, nullptr, 0);
  }
  close_pipes();
}

void WorkerProcess::close_pipes() {
  for (int* pipe : {&to_, &from_}) {
    if (*pipe >= 0) ::close(std::exchange(*pipe, -1));
  }
}

void WorkerProcess::start(StudyWork& work, bool one_point, const std::vector<WorkerProcess*>& others) {
  int tasks[2], results[2];
  // A socket, because what is sent to a worker that has just died must not raise SIGPIPE here.
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, tasks) != 0) fail_to_start("cannot make a socket");
  if (::pipe2(results, O_CLOEXEC) != 0) {
    ::close(tasks[0]);
    ::close(tasks[1]);
    fail_to_start("cannot make a pipe");
  }
  work_ = &work;
  note_.point = 0;
  sending_.clear();
  received_.clear();
  to_ = tasks[1];
  from_ = results[0];
  std::fflush(nullptr);  // what is buffered would be printed twice
  const int parent = ::getpid();
  process_ = ::fork();
  if (process_ == 0) {
    for (WorkerProcess* other : others) other->close_pipes();
    close_pipes();
    live(work, one_point, parent, tasks[0], results[1]);
  }
  ::close(tasks[0]);
  ::close(results[1]);
  if (process_ < 0) {
    close_pipes();
    fail_to_start("cannot start a process");
  }
  ::fcntl(to_, F_SETFL, O_NONBLOCK);
  ::fcntl(from_, F_SETFL, O_NONBLOCK);
}

void WorkerProcess::live(StudyWork& work, bool one_point, int parent, int tasks, int results) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) _exit(1);
  for (const int number : {SIGTERM, SIGHUP, SIGPIPE, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP}) {
    std::signal(number, SIG_DFL);
  }
  std::signal(SIGINT, SIG_IGN);  // of a terminal it is for the parent, which ends its workers
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  const int nothing = ::open("/dev/null", O_RDWR);
  for (const int file : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nothing, file);
  std::string arrived, answer;
  std::vector<char> piece(65536);
  for (;;) {
    std::string_view rest = arrived, message;
    while (take_message(rest, message)) {
      StudyTask task = task_of(message);
      for (; task.first < task.end; ++task.first) {
        const std::uint64_t point = work.unit_point(task.unit, task.first);
        StudyOutcome outcome = run_point(work, point, task.state, note_);
        answer.clear();
        append_message(answer, point, outcome);
        if (!write_all(results, answer)) _exit(1);
        note_.point = 0;
        if (one_point) _exit(0);
        task.state = std::move(outcome.state);
      }
    }
    arrived.erase(0, arrived.size() - rest.size());
    const ssize_t count = ::read(tasks, piece.data(), piece.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) _exit(0);
    arrived.append(piece.data(), static_cast<std::size_t>(count));
  }
}

void WorkerProcess::give(StudyTask task) {
  append_message(sending_, task);
  tasks_.push_back(std::move(task));
  send();
}

void WorkerProcess::send() {
  while (!sending_.empty()) {
    const ssize_t written = ::send(to_, sending_.data(), sending_.size(), MSG_NOSIGNAL);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      if (errno != EAGAIN) sending_.clear();  // it has ended, which receive() finds
      return;
    }
    sending_.erase(0, static_cast<std::size_t>(written));
  }
}

bool WorkerProcess::receive(const WorkerPool::Take& take) {
  char piece[65536];
  ssize_t count = 0;
  while ((count = ::read(from_, piece, sizeof piece)) > 0 || (count < 0 && errno == EINTR)) {
    if (count > 0) received_.append(piece, static_cast<std::size_t>(count));
    if (count < static_cast<ssize_t>(sizeof piece)) break;
  }
  const bool ended = count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR);
  take_in(take);
  return !ended;
}

void WorkerProcess::take_in(const WorkerPool::Take& take) {
  std::string_view rest = received_, message;
  while (!tasks_.empty() && take_message(rest, message)) {
    std::uint64_t point = 0;
    const StudyOutcome outcome = outcome_of(message, point);
    StudyTask& task = tasks_.front();
    task.state = outcome.state;
    if (++task.first == task.end) tasks_.pop_front();
    take(point, outcome);
  }
  received_.erase(0, received_.size() - rest.size());
}

double WorkerProcess::at_work() const {
  return note_.point == 0 ? 0.0 : 1e-9 * static_cast<double>(now() - note_.began);
}

bool WorkerProcess::in_hand(std::uint64_t& point) const {
  point = note_.point - 1;
  return note_.point != 0;
}

void WorkerProcess::kill() const { ::kill(process_, SIGKILL); }

int WorkerProcess::end(const WorkerPool::Take& take) {
  int status = 0;
  kill();  // changes nothing where it ends already
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  while (receive(take)) {
  }
  close_pipes();
  return status;
}

}  // namespace freeplay
