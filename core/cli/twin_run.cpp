#include "cli/twin_run.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string_view>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/caught_error.h"
#include "base/error.h"
#include "base/whole_text.h"
#include "cli/interrupt.h"

namespace freeplay {
namespace {

constexpr std::size_t numbers_at_once = 8192;
constexpr int look_again = 50;                  // for an interrupt [ms]
constexpr double same_instant_of_twins = 1e-9;  // of the interval

[[noreturn]] void no_twin(const char* what) {
  throw Error(Error::Category::file, "no-process", fmt::format("{}: {}", what, std::strerror(errno)));
}

/// The first error among messages, without what stands before its words.
std::string first_error(const std::string& messages) {
  constexpr std::string_view mark = "error: ";
  const std::size_t found = messages.find(mark);
  if (found == std::string::npos) return {};
  const std::size_t from = found + mark.size();
  return messages.substr(from, messages.find('\n', from) - from);
}

}  // namespace

TwinRows::TwinRows(int pipe, const Model& model, const Channels& channels)
    : pipe_(pipe),
      numbers_(model, channels),
      waiting_(std::max<std::size_t>(1, numbers_at_once / numbers_.size()) * numbers_.size()) {}

void TwinRows::row(std::span<const double> values) {
  numbers_.pick(values, std::span(waiting_).subspan(filled_, numbers_.size()));
  filled_ += numbers_.size();
  if (filled_ == waiting_.size()) send();
}

void TwinRows::send() {
  if (pipe_ >= 0 && !write_all(pipe_, {reinterpret_cast<const char*>(waiting_.data()), filled_ * sizeof(double)})) {
    pipe_ = -1;  // the other run has ended
  }
  filled_ = 0;
}

/// The other side: reads the twin's rows as its own come.
class TwinRun::Comparing final : public Sink {
 public:
  Comparing(int pipe, const Model& model, const Channels& channels)
      : pipe_(pipe),
        same_(same_instant_of_twins * model.settings.interval),
        numbers_(model, channels),
        comparison_(model),
        mine_(numbers_.size()),
        read_(std::max<std::size_t>(1, numbers_at_once / numbers_.size()) * numbers_.size()) {}

  void row(std::span<const double> values) override {
    numbers_.pick(values, mine_);
    // One of the two may have rows that the other has not.
    while (fill() && read_[next_] < mine_.front() - same_) next_ += mine_.size();
    if (!fill() || read_[next_] > mine_.front() + same_) return;
    comparison_.add(mine_, std::span<const double>(read_).subspan(next_, mine_.size()));
    next_ += mine_.size();
  }
  void event(const EventRecord&) override {}
  bool ok() const override { return true; }
  Json json() const { return comparison_.json(); }

 private:
  /// Whether there is a row of the twin; waits for it.
  bool fill() {
    const std::size_t width = mine_.size() * sizeof(double);
    if (next_ * sizeof(double) + width <= bytes_) return true;
    if (next_ * sizeof(double) == bytes_) next_ = bytes_ = 0;
    char* const bytes = reinterpret_cast<char*>(read_.data());
    const std::atomic<int>& interrupts = watch_interrupts();
    while (open_ && next_ * sizeof(double) + width > bytes_) {
      if (interrupts != 0) return false;
      pollfd ready{pipe_, POLLIN, 0};
      if (::poll(&ready, 1, look_again) <= 0) continue;
      const ssize_t got = ::read(pipe_, bytes + bytes_, read_.size() * sizeof(double) - bytes_);
      if (got < 0 && (errno == EINTR || errno == EAGAIN)) continue;
      if (got <= 0) open_ = false;
      if (got > 0) bytes_ += static_cast<std::size_t>(got);
    }
    return next_ * sizeof(double) + width <= bytes_;
  }

  int pipe_;
  double same_;
  TwinNumbers numbers_;
  TwinComparison comparison_;
  std::vector<double> mine_, read_;
  std::size_t next_ = 0, bytes_ = 0;  // of read_: numbers that were used, bytes that are there
  bool open_ = true;
};

TwinRun::TwinRun(const std::function<int(int pipe)>& work) {
  int gate[2], pipe[2];
  messages_ = ::memfd_create("twin", MFD_CLOEXEC);
  if (messages_ < 0 || ::pipe2(gate, O_CLOEXEC) != 0) no_twin("cannot make a pipe");
  if (::pipe2(pipe, O_CLOEXEC) != 0) no_twin("cannot make a pipe");
  std::fflush(nullptr);  // what is buffered would be printed twice
  const int parent = ::getpid();
  gate_ = gate[1];
  pipe_ = pipe[0];
  process_ = ::fork();
  if (process_ < 0) no_twin("cannot start a process");
  if (process_ == 0) live(work, gate[0], pipe[1], parent);
  ::close(gate[0]);
  ::close(pipe[1]);
}

TwinRun::~TwinRun() {
  if (process_ >= 0) {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  for (const int file : {gate_, pipe_, messages_}) {
    if (file >= 0) ::close(file);
  }
}

void TwinRun::live(const std::function<int(int pipe)>& work, int gate, int pipe, int parent) const {
  ::setpgid(0, 0);  // Ctrl-C is for the parent, which passes it on
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) _exit(1);
  ::close(gate_);
  ::close(pipe_);
  const int nothing = ::open("/dev/null", O_RDWR);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(nothing, STDOUT_FILENO);
  ::dup2(messages_, STDERR_FILENO);
  char go = 0;
  while (::read(gate, &go, 1) < 0 && errno == EINTR) {
  }
  if (go == 0) _exit(1);
  int exit_code = 1;
  try {
    exit_code = work(pipe);
  } catch (const std::exception& exception) {
    const Error error = error_of(exception);
    write_all(STDERR_FILENO, fmt::format("error: {} [{}]\n", error.message(), error.id()));
    exit_code = error.exit_code();
  }
  std::fflush(nullptr);
  _exit(exit_code);
}

Sink& TwinRun::start(const Model& model, const Channels& channels) {
  comparing_ = std::make_unique<Comparing>(pipe_, model, channels);
  write_all(gate_, "!");
  return *comparing_;
}

Json TwinRun::finish(std::string& trouble) {
  // Rows that are not read any more do not hold the twin up.
  ::close(pipe_);
  pipe_ = -1;
  const std::atomic<int>& interrupts = watch_interrupts();
  int status = 0;
  bool passed_on = false;
  while (::waitpid(process_, &status, WNOHANG) == 0) {
    if (interrupts != 0 && !passed_on) ::kill(process_, SIGTERM);
    passed_on = interrupts != 0;
    ::poll(nullptr, 0, look_again / 10);
  }
  process_ = -1;
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return comparing_->json();
  if (interrupts != 0) return nullptr;
  trouble = first_error(read_all(messages_));
  if (trouble.empty() && WIFSIGNALED(status))
    trouble = fmt::format("its process ended with signal {}", WTERMSIG(status));
  if (trouble.empty()) trouble = fmt::format("it ended with exit code {}", WEXITSTATUS(status));
  return nullptr;
}

}  // namespace freeplay
