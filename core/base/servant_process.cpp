#include "base/servant_process.h"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"

namespace freeplay {
namespace {

constexpr int look_every = 200;  // [ms]

struct Head {
  std::uint64_t kind = 0, bytes = 0;
};

// Of a process that has not been collected [s].
double processor_seconds(pid_t process) {
  clockid_t clock{};
  timespec time{};
  if (::clock_getcpuclockid(process, &clock) != 0 || ::clock_gettime(clock, &time) != 0) return 0.0;
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

bool send_all(int socket, const void* from, std::size_t bytes) {
  for (const char* next = static_cast<const char*>(from); bytes > 0;) {
    const ssize_t sent = ::send(socket, next, bytes, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    next += sent;
    bytes -= static_cast<std::size_t>(sent);
  }
  return true;
}

bool receive_all(int socket, void* to, std::size_t bytes) {
  for (char* next = static_cast<char*>(to); bytes > 0;) {
    const ssize_t received = ::recv(socket, next, bytes, 0);
    if (received < 0 && errno == EINTR) continue;
    if (received <= 0) return false;
    next += received;
    bytes -= static_cast<std::size_t>(received);
  }
  return true;
}

}  // namespace

ServantProcess::ServantProcess(const std::function<Serve()>& begin, double longest_answer)
    : longest_answer_(longest_answer) {
  int ends[2] = {-1, -1};
  const int parent = ::getpid();
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) == 0) process_ = ::fork();
  if (process_ == 0) live(begin, parent, ends[1]);
  const int reason = errno;
  socket_ = ends[0];
  if (ends[1] >= 0) ::close(ends[1]);
  if (process_ > 0) return;
  if (socket_ >= 0) ::close(socket_);
  throw Error(Error::Category::file, "no-process", std::string("cannot start a process: ") + std::strerror(reason));
}

ServantProcess::~ServantProcess() {
  if (gone_.empty()) {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  ::close(socket_);
}

void ServantProcess::live(const std::function<Serve()>& begin, int parent, int end) const {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) _exit(1);
  // Interrupts are for the program; what a crash does is the system's business, and says nothing.
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) std::signal(number, SIG_IGN);
  for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP}) std::signal(number, SIG_DFL);
  const rlimit none{0, 0};
  ::setrlimit(RLIMIT_CORE, &none);
  const int nothing = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  ::dup2(nothing, STDOUT_FILENO);
  ::dup2(nothing, STDERR_FILENO);
  const Serve serve = begin();
  const Send send = [end](std::uint64_t kind, std::string_view body) {
    const Head head{kind, body.size()};
    if (!send_all(end, &head, sizeof head) || !send_all(end, body.data(), body.size())) _exit(1);
  };
  std::string question;
  for (std::uint64_t bytes = 0; receive_all(end, &bytes, sizeof bytes);) {
    question.resize(bytes);
    if (!receive_all(end, question.data(), question.size())) break;
    serve(question, send);
  }
  _exit(0);
}

void ServantProcess::give_up(const char* why) {
  gone_ = why;
  ::kill(process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
  throw ServantGone(gone_);
}

/// Comes back when there are bytes or the process has ended; not while it works in vain.
void ServantProcess::receive(void* to, std::size_t bytes) {
  if (bytes == 0) return;
  const double began = processor_seconds(process_);
  pollfd there{socket_, POLLIN, 0};
  while (::poll(&there, 1, look_every) <= 0) {
    if (processor_seconds(process_) - began > longest_answer_) give_up("does not come to an end");
  }
  if (!receive_all(socket_, to, bytes)) give_up("crashes");
}

ServantProcess::Answer ServantProcess::ask(std::string_view question) {
  if (!gone_.empty()) throw ServantGone(gone_);
  const std::uint64_t bytes = question.size();
  if (!send_all(socket_, &bytes, sizeof bytes) || !send_all(socket_, question.data(), question.size())) {
    give_up("crashes");
  }
  Head head;
  receive(&head, sizeof head);
  body_.resize((head.bytes + sizeof(double) - 1) / sizeof(double));
  receive(body_.data(), head.bytes);
  return {head.kind, body_, head.bytes};
}

}  // namespace freeplay
